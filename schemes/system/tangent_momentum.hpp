// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The momenta of a constrained body: p + μ ∂G/∂q with the μ for which its velocity keeps to G(q) = 0,
///
///     ∂G/∂q · q̇ = 0,    ∂ℓ/∂q̇(q, q̇) = p + μ ∂G/∂q
///
/// A discrete momentum is p up to such a term, the share of the constraint's force in the row itself. The constraint is a
/// family whose values are q and its multiplier. Gives p where there is no such velocity.
std::vector<double> tangent_momentum(const BatchDensity&, const StencilFamily& constraint, std::span<const double> q,
                                     std::vector<double> p, double t);

}  // namespace delf
