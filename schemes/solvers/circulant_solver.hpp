// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <string>
#include <vector>

#include "jets/simd/pack.hpp"
#include "schemes/solvers/linear_solver.hpp"

namespace delf {

/// Solves a x_{i−1} + b x_i + a x_{i+1} = r_i on a circle, |b| > 2|a|, by factoring the circulant:
///
///     T = c (1 − q S⁻)(1 − q S⁺),   a = −cq,  b = c(1 + q²),  |q| < 1
///     u_i = r_i/c + q u_{i−1},      x_i = u_i + q x_{i+1}
///
/// Every lane runs both recurrences along its own arc, starting from nothing. What enters an arc from the one before it
/// then adds q^(i+1) U to u_i, and the sums of these corrections close round the circle: they are found from the ends of
/// all arcs. Where arcs are long against the decay of q^i, strips are solved one after the other: the first recurrence
/// starts `near` packs before the strips, the second one `near` packs beyond each of them.
class CirculantSolver final : public LinearSolver {
 public:
  CirculantSolver(const RowLayout&, double centre, double side);
  void solve(double* const* w) const override;
  std::unique_ptr<Sweeps> sweeps(int, PackRange arc) const override;
  double right_side_scale(int) const override { return scale_; }
  std::size_t bytes() const override { return forward_.size() * sizeof(double) + backward_.bytes(); }
  std::string name() const override { return "two recurrences (symmetric circulant of width 1)"; }

 private:
  class WholeRow;
  class ByStrips;
  using Matrix = std::array<Pack, lanes>;  ///< by columns

  /// u at the site before each arc, x at the site after it.
  struct Entering {
    Pack u, x;
  };
  Entering entering(const double* u, Pack sums) const;
  void build_closure();
  Pack run_forward(const RowSum*, const double* const* rows, double* u, int first, int last, Pack u_before) const;
  template <class Sink>
  Pack run_backward(const double* u, int first, int last, Pack x_after, Pack entering_u, Sink& sink) const;
  Pack sum_of_first(const double* u) const;

  const RowLayout* layout_;
  double q_, scale_;
  int near_;                     ///< packs from an arc's end that feel what enters there
  std::vector<double> forward_;  ///< q¹, q², …: what enters an arc at its packs
  RowBuffer backward_;           ///< q^(v−j): what pack v adds to x at the site of the arc that the arc before needs
  int gap_[lanes];               ///< the site before arc l has this index in arc l−1
  std::ptrdiff_t ends_[lanes];   ///< and stands here in a row
  Matrix u_from_ends_, x_from_ends_, x_from_sums_;
};

}  // namespace delf
