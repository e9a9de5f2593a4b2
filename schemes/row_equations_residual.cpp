// SPDX-License-Identifier: MIT
#include "schemes/row_equations.hpp"

#include <algorithm>
#include <cmath>

namespace delf {

namespace {

struct LargestTerms {
  Pack sum = 0.0, absolute = 0.0;
  Pack total = 0.0;  ///< of the absolute values: a NaN goes by in a maximum, and stays in a sum
  [[gnu::always_inline]] void operator()(std::ptrdiff_t, Pack s, Pack a) {
    sum = detail::larger_magnitude(sum, s);
    absolute = detail::larger_magnitude(absolute, a);
    total += a;
  }
  /// max |E| / max Σ |terms|
  double ratio() const {
    const double size = max_or_nan(absolute + 0.0 * total);
    return size != 0 ? max_or_nan(sum) / size : 0;
  }
};

}  // namespace

double RowEquations::residual(std::int64_t n) {
  begin(n);
  for (int a = 0; a < d_; ++a) {
    bases_[static_cast<std::size_t>(y_base_ + a)] = rows_.y(n, a);
    for (int age = 0; age < ages_; ++age)
      bases_[static_cast<std::size_t>(v_base_ + age * d_ + a)] = rows_.v(n - age, a);
  }
  // A step goes on from the outputs of its last iterate: what is taken here from the accepted row goes elsewhere, or a
  // run would depend on when it was looked at. The oldest rows, which the next step writes over, are room where nothing
  // reads them: the increment unless there are seeds, y in one loop.
  if (!scratch_.rows() && residual_rows() > 0) scratch_ = RowBuffer(layout_, residual_rows());
  for (int a = 0; a < d_; ++a) {
    double* const w = has_spare_increment() ? rows_.v(n + 2 - rows_.increments_held(), a) : scratch_.row(a);
    double *const v_new = rows_.v(n + 1, a), *const v = rows_.v(n, a);
    if (!increments_have_halos_) layout_.fill_halo(v_new), layout_.fill_halo(v);
    for (std::size_t s = 0; s < layout_.doubles(); ++s) w[s] = v_new[s] - v[s];
    bases_[static_cast<std::size_t>(w_base_ + a)] = w;
  }
  const int first = scratch_rows_of_sums();
  int next = first - (is_one_loop() ? d_ : 0);
  for (const Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age) {
      if (!o.reads_unknown_row(age) && !is_one_loop()) continue;
      const int count = o.kernel->outputs();
      for (int c = 0; c < count; ++c, ++next) {
        slab_out_[static_cast<std::size_t>(c)] =
            next < first ? rows_.y(n + 2 - rows_.rows_held(), next - first + d_) : scratch_.row(next);
        output(o, age, c) = slab_out_[static_cast<std::size_t>(c)];
      }
      evaluate(o, age, slab_out_.data(), At::row, where_read(o));
    }

  bind(measured_);
  const auto measure = [&](int a, const auto& consume) {
    return measured_[first_sum(a)].measure(layout_, layout_.all(), consume);
  };
  LargestTerms all;
  for (int a = 0; a < d_; ++a) {
    if (equations_.exceptional.empty()) {
      all = measure(a, all);
      continue;
    }
    // Sites near walls have their own sums, in the place of the bulk's.
    const int of_w = has_spare_increment() ? 0 : d_;
    double *const E = scratch_.row(of_w + a), *const size = scratch_.row(of_w + d_ + a);
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
  return all.ratio();
}

/// w; near walls E and Σ|terms| too.
int RowEquations::scratch_rows_of_sums() const {
  return (has_spare_increment() ? 0 : d_) + (equations_.exceptional.empty() ? 0 : 2 * d_);
}

/// And outputs, the first of which stand where one loop has a y to spare.
int RowEquations::residual_rows() const {
  int rows = scratch_rows_of_sums() - (is_one_loop() ? d_ : 0);
  for (const Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      if (o.reads_unknown_row(age) || is_one_loop()) rows += o.kernel->outputs();
  return std::max(rows, 0);
}

}  // namespace delf
