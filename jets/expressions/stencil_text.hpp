// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The name of lattice.stencil where a scene gives the stencil itself.
inline constexpr const char* stencil_as_text = "text";

/// A stencil as text: its sites as (time, space), and the jets at its points, one after the other, separated by |:
///
///     (0,0) (1,0) (1,1)
///     1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1
///
/// A point is its weight, and a weight of each site for φ, φ_t and φ_x (and φ_tt, φ_tx, φ_xx), as with h = k = 1. Weights
/// are formulas of numbers. Throws BadInput for the key with what cannot be read, or is not consistent: weights of φ that do
/// not sum to 1, a φ_t that does not find the slope of t.
StencilTable stencil_of(const std::string& sites, const std::string& points, const std::string& sites_key,
                        const std::string& points_key);

/// Its sites alone: for a Lagrangian on their values, which has no jet.
std::vector<Site> stencil_sites(const std::string& sites, const std::string& key);

/// The order in h and k at which the equations of a table are those of the theory, where these are linear: of the lowest
/// power of (τ, ξ) in which conj(m_a) m_b and conj(σ_a) σ_b differ, σ = (1, iτ, iξ) and m what the table makes of
/// exp i(τt + ξx), beyond that of σ itself: of densities without products of φ and its derivatives. No more than ten.
int order_of_consistency(const StencilTable&);

}  // namespace delf
