// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/space/mesh_space.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// True if ∂²ℓ/∂φ∂φ_x is not zero everywhere.
bool couples_gradient(const BatchDensity&);

/// A table of time on the sites and cells of a mesh, for a density T(φ_t) + V(φ, ∇φ) that is quadratic in ∇φ
/// (schemes/complex/space_tables.hpp):
///
///     S = Σ_i A_i Σ_q w_q h ℓ(φ, φ_t, 0)  +  Σ_K Σ_p |K| w_p Σ_q w_q h Σ_a [V(φ, ∂_aφ) − V(φ, 0)]
///
/// with the lumped masses A_i, and the points p of linear or bilinear cells. One family is of the sites, and one of the
/// cells of each number of corners; a gradient of two components is two points, whose φ_x are its components. The last
/// family is of what flows in at the boundary, if anything does.
std::vector<std::shared_ptr<const StencilFamily>> mesh_families(const StencilTable& time,
                                                                const std::shared_ptr<const BatchDensity>&,
                                                                const MeshSpace&, bool values_are_sources = false);

}  // namespace delf
