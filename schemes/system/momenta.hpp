// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The stencils that end at a row, or those that start there.
enum class Side { below, above };

/// The momenta at a row, of every component and site, [i·C + c]: the half of the field equation (5.2) that lies on one
/// side of it. On a solution both sides give the same: this is the discrete Legendre transform.
///
///     p = Σ_{Δ below} ∂L/∂y = −Σ_{Δ above} ∂L/∂y
///
/// A stencil that lies in the row alone, such as a constraint at its sites, belongs to neither side; one that reads nodes
/// inside the cell above the row, or joins them to it, lies above it. The window holds the rows on that side that the
/// stencils reach. Throws BadInput for a scheme without a Lagrangian.
std::vector<double> momenta(const LatticeSystem&, const Window&, std::int64_t row, Side);
/// The half sums of the equations of any scheme, with a Lagrangian or without one.
std::vector<double> half_equations(const LatticeSystem&, const Window&, std::int64_t row, Side,
                                   std::vector<double>* absolute = nullptr);
/// Throws that BadInput.
void require_lagrangian(const LatticeSystem&);

}  // namespace delf
