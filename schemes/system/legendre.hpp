// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"

namespace delf {

/// The Legendre transform of a density at one point of space (φ_x = 0), for any density, regular in q̇.
///
/// The velocities of given momenta: ∂ℓ/∂q̇(q, q̇) = p, solved by Newton's method from q̇ = 0. Nothing where ∂²ℓ/∂q̇∂q̇ is
/// singular, or it does not converge.
std::optional<std::vector<double>> velocity_of(const BatchDensity&, std::span<const double> q,
                                               std::span<const double> p, double t = 0);
/// q̇·∂ℓ/∂q̇ − ℓ(q, q̇)
double energy_of(const BatchDensity&, std::span<const double> q, std::span<const double> velocity, double t = 0);
/// H(q, p) = p·q̇ − ℓ(q, q̇) with these velocities; not a number where there are none.
double hamiltonian(const BatchDensity&, std::span<const double> q, std::span<const double> p, double t = 0);

}  // namespace delf
