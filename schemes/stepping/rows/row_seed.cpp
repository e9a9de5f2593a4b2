// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_seed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "schemes/stepping/rows/extrapolation.hpp"

namespace delf {
namespace {

// Looks are rare where steps in place, which keep no past rows, have to pause for them.
constexpr int steps_between_looks = 128, where_rows_are_long = 256;
constexpr int highest_order = ArgumentRows::highest_order;
// A seed of order p misses (1 − e^{−iωh})^{p+1} of a wave e^{iωt}. What an accepted iteration leaves of that is in
// phase with the wave's velocity, and damps it or feeds it step after step. Over 5000 collisions (N = 255, h = k/8,
// tolerance 6e-8) the energy 161.9 rose by 0.6, 0.0032 and 0.0010 with p = 2, 3 and 4; with 4 that is as much as the
// exact root's energy varies by.
constexpr int lowest_order = 4;
// Lower orders serve where steps are so small that what all steps of a unit of time leave together is less than this
// part of tolerance · span: with p = 3 and 4 it was some 0.3 and 0.02 there. At N = 4095 that is order 2, and energies err
// as with a tolerance of 1e-13.
constexpr double left_in_unit_time = 0.05;
// Of outputs order 3 serves too: (iωh)⁴ is in phase with the field itself, and an iteration makes less of it. With the same
// collisions the energy rose by 0.0009 with orders 3 and 4, by 0.03 where lower ones were allowed.
static_assert(RowSeed::highest_order_of_outputs == 4);
// What an iteration costs, in rows read: an evaluation of the density and two passes over several rows.
constexpr double rows_per_iteration = 24;

}  // namespace

bool RowSeed::fits_cache(int sites) { return sites <= 1 << 15; }

int RowSeed::rows_for(int seed_order, int sites) {
  return std::clamp(seed_order - 1, 1, fits_cache(sites) ? highest_order : 3);
}

RowSeed::RowSeed(SectionRows& rows, double time_step, int most_order, const std::vector<Argument>& looks,
                 ArgumentRows* arguments)
    : rows_(rows),
      y_slots_(rows.rows_held()),
      v_slots_(rows.increments_held()),
      time_step_(time_step),
      most_order_(most_order),
      period_(fits_cache(rows.sites()) ? steps_between_looks : where_rows_are_long),
      looks_(looks),
      bases_(static_cast<std::size_t>(most_order) + 1),
      arguments_(arguments) {
  for (int order = 0; order <= most_order; ++order) {
    RowSum sum;
    sum.add(0, 0, 1);
    for (int m = 1; m <= order; ++m) sum.add(m, 0, extrapolation_weight(order, m));
    sum.bind(summed_);
    sums_.push_back(std::move(sum));
  }
}

void RowSeed::find(std::int64_t n, int order, double* const* candidate, const PackRange& packs) {
  order = static_cast<int>(std::min<std::int64_t>({order, n, most_order_}));
  const RowLayout& layout = rows_.layout();
  RowSum& sum = sums_[static_cast<std::size_t>(order)];
  y_slots_.at(rows_.place(n));
  v_slots_.at(rows_.place(n));
  for (int a = 0; a < rows_.components(); ++a) {
    bases_[0] = rows_.y_at(y_slots_(0), a);
    int slot = v_slots_(0);
    for (int m = 1; m <= order; ++m, slot = v_slots_.before(slot))
      bases_[static_cast<std::size_t>(m)] = rows_.v_at(slot, a);
    double* const to = candidate[a];
    sum.pass(
        layout, packs, [to](std::ptrdiff_t at, Pack y) __attribute__((always_inline)) { y.store(to + at); });
  }
}

void RowSeed::find_span() {
  const RowLayout& layout = rows_.layout();
  span_ = 0;
  for (int a = 0; a < rows_.components(); ++a) {
    const double* const y = rows_.y_at(y_slots_(0), a);
    const double some = y[layout.slot(0)];
    Pack above(0.0), below(0.0);
    for (int v = 0; v < layout.packs(); ++v) {
      const Pack difference = Pack::load(y + layout.at(v)) - some;
      above = max_or_nan(difference, above);
      below = max_or_nan(-difference, below);
    }
    span_ = std::max(span_, max_or_nan(above) + max_or_nan(below));
  }
}

/// The backward differences ∇^p v_n are what a seed of order p would have missed of v_n. `load(m, pack)` is what is looked
/// at of v_{n−m}.
template <int most>
void RowSeed::measure(const auto& load, double* errors) {
  std::array<Pack, most + 1> worst;
  worst.fill(Pack(0.0));
  for (int pack = 0; pack < rows_.layout().packs(); ++pack) {
    std::array<Pack, most + 1> difference;
    [&]<int... m>(std::integer_sequence<int, m...>) __attribute__((always_inline)) {
      ((difference[m] = load(m, pack)), ...);
    }
    (std::make_integer_sequence<int, most + 1>{});
    for (int p = 1; p <= most; ++p) {
      for (int m = 0; m <= most - p; ++m) difference[m] = difference[m] - difference[m + 1];
      worst[p] = max_or_nan(abs(difference[0]), worst[p]);
    }
  }
  for (int p = 1; p <= most; ++p) errors[p] = std::max(errors[p], max_or_nan(worst[p]));
}

template <int most>
void RowSeed::measure(double* errors) {
  const RowLayout& layout = rows_.layout();
  if (arguments_) {
    std::array<const double*, most + 2> rows;
    for (int m = 0; m < most + 2; ++m) rows[m] = arguments_->row(m + 1);
    measure<most>(
        [&](int m, int pack) __attribute__((always_inline)) {
          return Pack::load(rows[m] + layout.at(pack)) - Pack::load(rows[m + 1] + layout.at(pack));
        },
        errors);
    return;
  }
  for (int a = 0; a < rows_.components(); ++a) {
    std::array<const double*, most + 1> v;
    for (int m = 0; m <= most; ++m) v[m] = rows_.v_at(v_slots_(m), a);
    for (const Argument& look : looks_)
      measure<most>(
          [&](int m, int pack) __attribute__((always_inline)) {
            Pack sum(0.0);
            for (const Argument::Part& part : look.parts)
              sum += part.weight * Pack::load(v[m] + layout.at(pack + part.vertex.space));
            return sum;
          },
          errors);
  }
}

void RowSeed::look(std::int64_t n, double tolerance, double contraction, double weight) {
  looked_at_ = n;
  y_slots_.at(rows_.place(n));
  v_slots_.at(rows_.place(n));
  find_span();
  const int most = static_cast<int>(std::min<std::int64_t>(most_order_, n - 1));
  order_ = std::max(1, most);
  order_of_outputs_ = 0;
  if (most < 1 || !(contraction < 0.5)) {
    order_ = most_order_;
    return;
  }
  double errors[highest_order + 1] = {};
  [&]<int... m>(std::integer_sequence<int, m...>) {
    ((most == m + 1 ? measure<m + 1>(errors) : void()), ...);
  }
  (std::make_integer_sequence<int, highest_order>{});
  double cheapest = std::numeric_limits<double>::infinity();
  // A seed goes astray twice as fast as it did where the field gets steeper.
  const auto first_change = [&](int p) { return 2 * errors[p]; };
  // Where rows are long, steps are so small that this takes longer than anyone steps.
  int lowest = most_order_ < lowest_order ? 1 : std::min(lowest_order, most);
  while (lowest > 1 &&
         contraction * first_change(lowest - 1) <= left_in_unit_time * time_step_ * tolerance * span_)
    --lowest;
  for (int p = lowest; p <= most; ++p) {
    double change = first_change(p);
    int iterations = 1;
    while (iterations < 9 && !(weight * change <= tolerance * span_)) change *= contraction, ++iterations;
    const double cost = p + rows_per_iteration * iterations;
    if (cost < cheapest) cheapest = cost, order_ = p;
  }
  if (weight * errors[order_] <= tolerance * span_) return;
  constexpr int highest = highest_order_of_outputs;
  order_of_outputs_ = std::min(most, errors[highest] < errors[highest - 1] ? highest : highest - 1);
}

}  // namespace delf
