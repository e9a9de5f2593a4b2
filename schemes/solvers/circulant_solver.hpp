// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <vector>

#include "schemes/solvers/linear_solver.hpp"

namespace delf {

/// The symmetric circulant  a S⁻ + b + a S⁺ = c (1 − q S⁻)(1 − q S⁺)  on a circle: two first-order recurrences,
///
///     u_i = r_i/c + q u_{i−1},        x_i = u_i + q x_{i+1}.
///
/// All lanes run at once, each over its own arc of sites, from nothing. What really enters an arc is found from the ends
/// of the arcs alone, after the forward recurrence and for both of them, so that the backward one can correct and
/// finish a site in one go.
class CirculantSolver final : public LinearSolver {
 public:
  CirculantSolver(const RowLayout&, double centre, double side);
  void solve(const double* const* rhs, double* const* w) const override;
  RowChange advance(const RowLayout&, int, const RowSum* const* right_sides, const RowIncrement* rows,
                    double* const* w) const override;
  double right_side_scale(int) const override { return scale_; }
  bool needs_work_rows() const override { return false; }

  std::unique_ptr<RowStream> stream(const RowLayout&, const RowSum&, const RowIncrement&) const override;
  std::size_t bytes() const override { return forward_.size() * sizeof(double) + backward_.bytes(); }
  std::string name() const override { return "two recurrences (symmetric circulant of width 1)"; }

 private:
  class Stream;
  using Matrix = std::array<Pack, lanes>;  ///< by columns

  /// u = the recurrence from nothing in w, and what enters the arcs.
  struct Entering {
    Pack u, x;  ///< u at the site before each arc, x at the site after it
  };
  Entering entering(const double* u, Pack sums) const;
  Pack entering_far(Pack sums, Pack entering_u) const;
  Pack sum_of_first(const double* u) const;
  Entering forward(const RowSum& right_side, double* u) const;
  /// The first Sink::packs_unseen go to sink.unseen().
  template <class Sink>
  void backward(const Entering&, const double* u, Sink&) const;
  void build_closure();

  const RowLayout* layout_;
  double q_, scale_;
  int near_;                     ///< packs from an arc's end that feel what enters there
  std::vector<double> forward_;  ///< q¹, q², …: what enters an arc at its packs
  RowBuffer backward_;           ///< q^(v−j): what pack v adds to x at the site of the arc that the arc before needs
  int gap_[lanes];               ///< the site before arc l has this index in arc l−1
  std::ptrdiff_t ends_[lanes];   ///< and stands here in a row
  /// What enters an arc is no longer felt in the next one: each then takes it from the arc beside it alone.
  bool are_far_apart_ = false;
  static constexpr int sums_at_once = 4;
  Matrix u_from_ends_, x_from_ends_, x_from_sums_;
  Pack x_from_u_;  ///< K_l
};

}  // namespace delf
