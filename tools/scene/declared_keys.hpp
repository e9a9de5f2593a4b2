// SPDX-License-Identifier: MIT
#pragma once
#include <string_view>

#include "tools/scene/settings.hpp"

namespace delf {

/// Makes the choices that keys imply (theory.density a theory, initial.phi a state), and declares the keys that the scene's
/// theory and its fields bring with them: theory.m, initial.u, exact.u. Throws BadScene.
void declare_keys(Settings&);

/// A scene may declare a key of that name: whether it does is found when it is read.
bool may_be_declared(std::string_view key);

}  // namespace delf
