// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "schemes/simulation.hpp"
#include "schemes/stability/symbol.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The constant field about which a scene's scheme is linearised: the vacuum that its theory names, or 0 if that solves
/// the field equation of a text; nothing if a constant field is unstable there, or ℓ depends on t or x.
std::optional<double> stable_vacuum(const Scene&, const Simulation&);
/// True if the constant field 0 solves the field equations, ∂ℓ/∂φᵃ = 0 there, of a density without t and x.
bool zero_is_a_solution(const BatchDensity&);
/// The symbol about it; nothing for a scheme that has none, or of more than twelve components, where it would take as
/// long as many a run.
std::optional<Symbol> symbol_of(const Scene&, const Simulation&);

}  // namespace delf
