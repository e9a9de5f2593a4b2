// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "jets/batch_density.hpp"
#include "schemes/simulation.hpp"

namespace delf {

/// ℓ is linear in φ_t, with factors that are functions of φ and φ_x: φ at one time determines the motion.
bool is_of_first_order_in_time(const BatchDensity&);
/// Such is the density of the theory.
bool is_of_first_order_in_time(const Problem&);
/// Some field has a rate in ℓ, and linearly: no inertia, and no row −1 that its rate would give.
bool has_field_of_first_order(const BatchDensity&);
/// The method starts from row 0 alone, whatever the density, or can where the density is such a one.
bool may_start_from_values(const Problem&);

/// Starts from row 0 alone, of such a density: its momenta p = ∂ℓ/∂φ_t need no rate, and row 1 follows by the discrete
/// Legendre transform. Throws BadInput for other densities, and for a scheme that reaches over three rows. `monodromy` is
/// φ(x + L) − φ(x).
void start_from_values(Simulation&, std::span<const double> row0, double monodromy);
/// Starts from row 0 and the rates v there, which fields of first order need not have: row 1 follows from the momenta
///
///     p = ½(D₂L(y₀ − hv, y₀) − D₁L(y₀, y₀ + hv))
void start_from_rates(Simulation&, std::span<const double> row0, std::span<const double> v, double monodromy);

}  // namespace delf
