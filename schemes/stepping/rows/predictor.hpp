// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/solvers/row_layout.hpp"
#include "schemes/stepping/rows/row_equations.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

/// The predictor of source terms of the unknown row: the polynomial of order p through those of the last p rows,
///
///     g_{n+1} ≈ Σ_{j=1}^{p} (−1)^{j+1} C(p, j) g_{n+1−j},
///
/// whose error was ∇^p g_n a step ago. The order is chosen anew from time to time by what the rows show.
class Predictor {
 public:
  /// The most rows worth keeping for predictions of the `wanted` order at most: few where rows outgrow the cache.
  static int rows_for(int wanted, int sites);

  Predictor(const RowEquations&, const RowLayout&, int most_rows);

  int order() const { return order_; }
  void restart() { order_ = 1, next_choice_ = 0; }
  void visit(SavedState& state) { state("predictor order", order_), state("predictor choice", next_choice_); }
  bool is_due(std::int64_t n) const { return n >= next_choice_; }
  /// When source terms of so many rows are there, number 1 of each ring the newest. `gain`: what a change of 1 in a
  /// source row changes y by; an iteration makes the last change less by `contraction`; changes up to `allowed` are
  /// accepted.
  void choose(const RowTable&, std::int64_t n, int rows_there, const std::vector<double>& gains, double contraction,
              double allowed, double time_step);

 private:
  const RowEquations& equations_;
  const RowLayout& layout_;
  int most_, order_ = 1;
  std::int64_t next_choice_ = 0;
};

}  // namespace delf
