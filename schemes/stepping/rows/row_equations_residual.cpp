// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/stepping/rows/row_equations_step.hpp"

namespace delf {

/// max |E| / max Σ |terms|
double RowEquations::residual(std::int64_t n, double largest) {
  n_ = n;
  in_place_ = false;
  double sum = 0, size = 0;
  const auto take = [&](const LargestTerms& terms, double scale) {
    sum = larger_or_nan(scale * max_or_nan(terms.sum), sum);
    size = larger_or_nan(scale * max_or_nan(terms.absolute), size);
  };
  if (is_one_loop()) {
    LargestTerms terms[RowKernel::most_components];
    measure_loop(terms);
    for (int a = 0; a < d_; ++a) take(terms[a], 1 / std::abs(solver_[0]->right_side_scale(a)));
  } else if (on_the_way_) {
    find_rows();
    take(outputs_[0].kernel->measure_division(division(argument_on_the_way(with_turn(largest)), nullptr), increment(0)),
         1);  // in whatever unit: there is nothing else
  } else {
    LargestTerms terms;
    measure_sums(terms, with_turn(largest));
    take(terms, 1);
  }
  if (!std::isfinite(size)) return std::numeric_limits<double>::quiet_NaN();
  return size != 0 ? sum / size : 0;
}

/// A step goes on from the outputs of its last iterate: what is found of the accepted row goes elsewhere, or a run would
/// depend on when it was looked at.
void RowEquations::make_room_for_residual() {
  if (residual_rows() == 0) return;
  scratch_ = RowBuffer(layout_, residual_rows());
  const auto put = [this](StepRows& rows) {
    int next = equations_.exceptional.empty() ? 0 : 2 * d_;
    for (const Outputs& o : outputs_)
      for (int r = 0; r < o.measured_rows(); ++r, ++next)
        rows.bases[static_cast<std::size_t>(o.measured_base + r)] = scratch_.row(next);
  };
  put(own_);
  std::ranges::for_each(places_, put);
}

void RowEquations::measure_sums(LargestTerms& all, double largest) {
  if (!scratch_.rows()) make_room_for_residual();
  find_rows();
  if (measured_reach_ > 0 && !increment(0).v_has_halo) {  // of one component
    layout_.fill_halo(base(v_new_base_), measured_reach_, measured_reach_);
    if (residual_row_ != n_ - 1) layout_.fill_halo(base(v_base_), measured_reach_, measured_reach_);
  }
  residual_row_ = n_;
  for (const Outputs& o : outputs_)
    for (int age = o.oldest_measured(); age <= o.newest; ++age)
      evaluate(o, age, &base(o.measured_index(age, 0)), At::row, where_read(o), largest);

  const auto measure = [&](int a, const auto& consume) {
    return measured_[first_sum(a)].measure(layout_, layout_.all(), consume);
  };
  for (int a = 0; a < d_; ++a) {
    if (equations_.exceptional.empty()) {
      all = measure(a, all);
      continue;
    }
    // Sites near walls have their own sums, in the place of the bulk's.
    double *const E = scratch_.row(a), *const size = scratch_.row(d_ + a);
    measure(a, [E, size](std::ptrdiff_t to, Pack sum, Pack absolute) {
      sum.store(E + to);
      absolute.store(size + to);
    });
    for (const SiteEquation& special : equations_.exceptional) {
      if (special.component != a) continue;
      double absolute = 0;
      const double value = value_at(special, true, &absolute);
      for (int slot : layout_.slots_of(special.site)) E[slot] = value, size[slot] = absolute;
    }
    for (int v = 0; v < layout_.packs(); ++v) all(0, Pack::load(E + layout_.at(v)), Pack::load(size + layout_.at(v)));
  }
}

/// Near walls E and Σ|terms|; and outputs.
int RowEquations::residual_rows() const {
  int rows = equations_.exceptional.empty() ? 0 : 2 * d_;
  for (const Outputs& o : outputs_)
    if (!is_one_loop() && !on_the_way_) rows += o.measured_rows();
  return rows;
}

}  // namespace delf
