// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/stepping/rows/argument_rows.hpp"
#include "schemes/stepping/rows/ring_slots.hpp"
#include "schemes/families/row_kernel.hpp"
#include "schemes/stepping/rows/row_sum.hpp"
#include "schemes/stepping/rows/section_rows.hpp"

namespace delf {

/// The candidate that an implicit step starts from: the polynomial through the last rows, by their increments,
///
///     y_{n+1} ≈ y_n + Σ_{m=1}^{order} (−1)^{m+1} C(order, m) v_{n+1−m},
///
/// of the order that costs least: a row read costs little where rows are in the cache, an iteration spared is worth
/// many.
class RowSeed {
 public:
  /// Increments up to this many rows back are read; what matters of a candidate is what the nonlinear part looks at.
  /// Where steps extrapolate `arguments`, these are read in the place of increments.
  RowSeed(SectionRows&, double time_step, int most_order, const std::vector<Argument>& looks,
          ArgumentRows* arguments = nullptr);
  RowSeed(const RowSeed&) = delete;
  /// How many increments to hold for a seed from `seed_order` rows: fewer where rows outgrow the cache.
  static int rows_for(int seed_order, int sites);
  static bool fits_cache(int sites);  ///< some twenty rows do

  /// Forgets the order: rows have been set anew.
  void restart() { looked_at_ = -1; }
  int order() const { return order_; }
  /// If one iteration from it is not expected to be enough, the order that outputs are best extrapolated with, three or
  /// four; else 0.
  int order_of_outputs() const { return order_of_outputs_; }
  static constexpr int highest_order_of_outputs = 4;
  /// Whether neither the step from row n nor those that choose() will look back at from its next look read more than
  /// the newest increment.
  bool reads_one_increment(std::int64_t n) const {
    return order_ == 1 && looked_at_ >= 0 && n > most_order_ + 1 && n < looked_at_ + period_ - (most_order_ + 1);
  }
  /// Chooses the order for the step from row n, now and then (true), by how well each would have foretold the newest row:
  /// each change is `contraction` times the last, until `weight` times it is below tolerance · span().
  bool choose(std::int64_t n, double tolerance, double contraction, double weight) {
    const bool looks = looked_at_ < 0 || n >= looked_at_ + period_ || n <= most_order_ + 1;
    if (looks) look(n, tolerance, contraction, weight);
    return looks;
  }
  bool choose(std::int64_t n, double tolerance, double contraction) {
    return choose(n, tolerance, contraction, contraction);
  }
  /// max y − min y over all components when last looked at.
  double span() const { return span_; }
  /// Puts the candidate of this order, or the highest there are rows for, into d rows, halos too.
  void find(std::int64_t n, int order, double* const* candidate) {
    find(n, order, candidate, {-rows_.layout().halo(), rows_.layout().packs() + rows_.layout().halo()});
  }
  void find(std::int64_t n, int order, double* const* candidate, const PackRange&);

 private:
  void look(std::int64_t n, double tolerance, double contraction, double weight);
  void find_span();
  template <int most>
  void measure(double* errors);
  template <int most>
  void measure(const auto& load, double* errors);

  SectionRows& rows_;
  RingSlots y_slots_, v_slots_;
  double time_step_;
  int most_order_, order_ = 1, order_of_outputs_ = 0;
  int period_;  ///< steps from look to look
  std::int64_t looked_at_ = -1;
  double span_ = 0;
  std::vector<RowSum> sums_;  ///< by order
  std::vector<Argument> looks_;
  std::vector<const double*> bases_;
  const RowSum::Rows summed_{bases_.data()};
  ArgumentRows* arguments_;
};

}  // namespace delf
