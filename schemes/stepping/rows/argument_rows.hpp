// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "schemes/stepping/rows/ring_slots.hpp"
#include "schemes/stepping/rows/row_increment.hpp"
#include "schemes/families/row_kernel.hpp"

namespace delf {

class LatticeSystem;

/// What the nonlinear part looks at, if that is one argument, of neighbours that follow each other in the unknown row and
/// in the one before it:
///
///     m(i) = u_{n+1}(i) + what is known,      u_r(i) = Σ_p weights[p] y_r(i + p),      p = 0 … parts − 1.
///
/// Known is known_weight · y(i + known_site) in the row below the unknown one, or u_n again with the weight 1. What looks
/// at a pair of values at one site is served by the same rows: u is then y_{n+1}, and known is y, known_row rows below.
struct Mixture {
  int parts = 0;
  double weights[RowLook::most_parts] = {};
  bool is_known_alike = false;
  int known_site = 0;
  double known_weight = 0;
  int known_row = 1;  ///< below the unknown one

  /// Of one field on a circle; nothing where what is looked at is more, or not seen by a kernel of its own.
  static std::optional<Mixture> of(const LatticeSystem&);

 private:
  static std::optional<Mixture> of_pair(const RowKernel&);
};

/// Extrapolates a row from those before it, the newest first; not its halos.
void put_extrapolated(const RowLayout&, const double* const* past, int past_rows, double* to);

/// The newest rows u_r. A step extrapolates these instead of y: it reads as many past rows, but has no candidate for y to
/// write, to read at several sites and to compare the new row with.
class ArgumentRows {
 public:
  static constexpr int highest_order = 11;  ///< of a polynomial; `most_order` is no more
  ArgumentRows(const RowLayout&, const Mixture&, int most_order);

  const Mixture& mixture() const { return mixture_; }
  /// Of all rows of arguments: x of each slot's site, if the family is placed, and the steps.
  void put(const double* positions, double time_step, double space_step) {
    row_.positions = positions, row_.time_step = time_step, row_.space_step = space_step;
  }
  /// RowKernel::near_below()
  void set_near_below(double bound) { near_below_ = bound; }
  /// What comes of them is read so many packs across the ends of arcs.
  void set_read(int before, int after) { row_.read_before = before, row_.read_after = after; }
  /// The step from row n; what follows is about it.
  void begin(std::int64_t n) {
    slots_.at(n + 1);
    newest_first_ = all_.data() + (ring_.rows() - 1 - slots_.slot());
    n_ = n;
    row_.unknown = newest_first_[0], row_.past = newest_first_ + 1;
  }
  /// u_{n+1−back}: 0 is the one that is looked for. The oldest one lies where that will.
  double* row(int back) { return newest_first_[back]; }
  /// u_{n+1} as it stands and what is known, with the row y of known_row, for anchors at time t. No bound is known.
  const ArgumentRow& argument(const double* y, double t) {
    row_.t = t;
    row_.known = mixture_.is_known_alike ? row_.past[0] : y + static_cast<std::ptrdiff_t>(mixture_.known_site) * lanes;
    row_.past_rows = 0;
    row_.near = false;
    return row_;
  }
  /// No |y| of the rows that argument() is made of is above this.
  void set_largest(double y) { row_.near = y <= near_below_; }
  /// Lets u_{n+1} of argument() be extrapolated by a polynomial of this order, or the highest that there are rows for, from
  /// `order` + 1 rows. No |y| of these is above `largest`. From more rows than loops take, which only tolerances near
  /// rounding ask for, this is done at once; and where arguments may be too large to be near.
  void extrapolate(int order, double largest) {
    order = std::clamp(order, 1, static_cast<int>(std::min<std::int64_t>(n_, most_order_)));
    set_largest(largest * growth_[static_cast<std::size_t>(order)]);
    if (!row_.near || order + 1 > ArgumentRow::most_past_rows) return put_extrapolated(order + 1);
    row_.past_rows = order + 1;
  }
  /// u_{n+1} of the row itself, whose halos are filled; returns the largest change.
  double find(const double* y, const PackRange&);
  std::size_t bytes() const { return ring_.bytes(); }

 private:
  void put_extrapolated(int past_rows);

  const RowLayout* layout_;
  Mixture mixture_;
  RowBuffer ring_;
  RingSlots slots_;
  std::vector<double*> all_;  ///< the ring's rows from the last to the first, twice: any slot's, and those before it
  double* const* newest_first_ = nullptr;
  std::int64_t n_ = 0;
  int most_order_;
  ArgumentRow row_{};
  std::vector<double> growth_;  ///< Σ |coefficients|, by order
  double near_below_ = -1;
};

}  // namespace delf
