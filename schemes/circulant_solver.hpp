// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/linear_solver.hpp"

namespace delf {

/// The symmetric circulant  a S⁻ + b + a S⁺ = c (1 − q S⁻)(1 − q S⁺)  on a circle: two first-order recurrences. All lanes
/// run at once, each over its own arc of sites; what enters an arc from the one before it is found afterwards, from
/// the ends of the arcs alone.
class CirculantSolver final : public LinearSolver {
 public:
  CirculantSolver(const RowLayout&, double centre, double side);
  void solve(const double* const* rhs, double* const* w) const override;
  std::size_t bytes() const override { return powers_.size() * sizeof(double); }
  std::string name() const override { return "two recurrences (symmetric circulant of width 1)"; }

 private:
  const RowLayout* layout_;
  double q_, scale_;
  std::vector<double> powers_;  ///< q¹, q², … as far as they matter
  int gap_[lanes];              ///< the site before arc l has this index in arc l−1
  double entering_[lanes];      ///< q^(gap+1): how much of what enters arc l−1 leaves it
  double closing_;              ///< 1/(1 − Π entering)
};

}  // namespace delf
