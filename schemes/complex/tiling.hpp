// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "schemes/complex/stencil_list.hpp"

namespace delf {

/// How the stencils of a list fill spacetime. Where they tile around a site, an affine field has no equation left there:
///
///     Σ_Δ w_Δ ∂φ_t/∂y_i = 0,    Σ_Δ w_Δ ∂φ_x/∂y_i = 0        (∫ ∇ψ_i = 0 inside)
///
/// whatever the shapes. A stencil that is missing, in excess, or stands for a wrong share of its area breaks this, and the
/// action is that of another density there. At a straight wall the second sum is what is natural there.
struct Tiling {
  double area = 0;  ///< Σ share × cell: what all stencils stand for
  std::optional<MeshFault> fault = {};
  std::vector<std::string> gaps = {};  ///< sites with an equation in whose surroundings a part is covered by no stencil
  /// The outlines as cells of the plane, x before t, if each stencil stands for its own outline and no other shares it.
  std::optional<Mesh> cells = {};
};
/// Of a list without other faults (see find_fault()). Sites of motion, site and gradient are passed over: these know no area.
Tiling tiling_of(const StencilList&);

}  // namespace delf
