// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "jets/batch_density.hpp"
#include "schemes/state.hpp"

namespace delf {

/// The energy ∫ (φ_t ∂ℓ/∂φ_t − ℓ) dx of a state at time t; on a point the integrand. By the midpoint rule, whose error
/// falls exponentially for what is smooth on a circle or a pulse, in cells half as long as the `width` of a pulse;
/// nothing where that would take too many of them.
std::optional<double> exact_energy(const State&, const BatchDensity&, const Lattice&, double width, double t);

}  // namespace delf
