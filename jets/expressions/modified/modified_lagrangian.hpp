// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/graph.hpp"
#include "jets/expressions/print.hpp"
#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The Lagrangian density whose exact solutions a scheme computes, as a series in h and k:
///
///     ℓ̃ = ℓ + h² ℓ₂₀ + hk ℓ₁₁ + k² ℓ₀₂ + …        a function of φ, φ_t and their derivatives in x
///
/// Rows of the scheme are rows of a smooth solution of ℓ̃, up to what is beyond the order. There is one such density of first
/// order in time, up to divergences: that of a step's action as a generating function. With D = d/dt along the solutions,
///
///     ℓ̃ = hD/2 / sinh(hD/2) L,    L = Σ_q w_q ℓ(j_q)  about the middle of a step and of the stencil
///
/// where φ_tt and higher derivatives are replaced by what they are on solutions. This is the modified Lagrangian of
/// M. Vermeeren, Numer. Math. 137 (2017) 1001, whose meshed Lagrangian is the series of hD/2 / sinh(hD/2); sums over sites are
/// integrals over x to all orders, so that space has no such factor. R. McLachlan and C. Offen, J. Geom. Mech. 14 (2022) 447,
/// expand the actions of fields, keeping all derivatives in t; M. Oliver and S. Vasylkevych, arXiv:2403.17585, change the
/// field too. Here φ stays what the lattice holds.
///
/// Nodes inside a cell and the rows between sub-steps are eliminated: their difference from the smooth field is a series
/// that solves their own equations. Sites of a brick wall are of two kinds, φ ± ψ: φ is their mean, and ψ is eliminated.
class ModifiedLagrangian {
 public:
  static constexpr int highest_order = 6;

  /// Throws BadInput for what has no such Lagrangian, or whose terms are not found here, and expressions::TooLarge.
  ModifiedLagrangian(const SymbolicDensity&, const StencilTable&, int order);
  ~ModifiedLagrangian();
  ModifiedLagrangian(ModifiedLagrangian&&) noexcept;

  /// The terms with h^in_h k^in_k, divided by these powers, as `numerator`/`denominator`.
  struct Part {
    int in_h, in_k;
    double denominator;
    std::string numerator;
  };
  std::vector<Part> parts(expressions::Notation) const;

  /// ψ of the field's sites in a brick wall, φ + ψ where time + space is even and φ − ψ elsewhere, to the order that ℓ̃ needs.
  /// Nothing for other stencils.
  std::vector<Part> between_kinds(int field, expressions::Notation) const;

  /// Energy φ_t δℓ̃/δφ_t − ℓ̃ and momentum −φ_x δℓ̃/δφ_t, densities whose integrals over x are constant where ℓ̃ depends on
  /// neither t nor x, in the middle between two rows y₀ and y₁: functions of their mean in the place of φ, and of
  /// (y₁ − y₀)/h in that of φ_t.
  struct OfRows {
    struct Input {
      int field, in_t, in_x;  ///< ∂ₓⁿ of the mean, in_t = 0, or of the difference over h, in_t = 1
    };
    std::vector<Input> inputs;  ///< variables 0, 1, … of the graph; then x, and t
    expressions::Graph graph;
    int energy, momentum;
  };
  OfRows of_rows(double h, double k);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace delf
