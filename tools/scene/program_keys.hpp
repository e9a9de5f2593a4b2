// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/parameter.hpp"

namespace delf {

// The keys that the program itself declares; theories, methods and states declare their own in the same way.

/// [theory] [lattice] [scheme] [initial] [boundary] [run] [output]: the keys of a scene.
std::vector<Parameter> scene_keys();
/// [verify] [sweep] [convergence] [stability] [workprecision] [reproduce]: the keys of commands.
std::vector<Parameter> command_keys();

/// The name that stands among the choices of a key for any formula.
inline constexpr auto formula_choice = "formula";
/// The choices of a key that is a switch; true, yes and 1, false, no and 0 are taken too.
inline const std::vector<std::string> on_or_off{"on", "off"};

/// Holds in place of a fallback where each state has a value of its own.
inline constexpr auto states_own = "the state's own";

}  // namespace delf
