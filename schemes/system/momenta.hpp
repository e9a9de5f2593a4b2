// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/system/assembly.hpp"
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
/// The same row after row: what the stencils of a side read is listed once. Brick walls have rows of two parities.
class HalfEquations {
 public:
  HalfEquations(const LatticeSystem&, Side, double monodromy, int parity = 0);
  std::vector<double> operator()(const Window&, std::int64_t row, std::vector<double>* absolute = nullptr) const;

 private:
  Side side_;
  int reach_;  ///< rows
  Assembly assembly_;
};
/// The rows with low parts, which are zero if they had none: derivatives in time are then differences of values, and lose
/// no digits in a short step.
Window with_low_parts(Window);
/// Throws that BadInput.
void require_lagrangian(const LatticeSystem&);

}  // namespace delf
