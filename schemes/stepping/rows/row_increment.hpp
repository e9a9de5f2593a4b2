// SPDX-License-Identifier: MIT
#pragma once
#include <limits>

#include "schemes/stepping/rows/row_layout.hpp"

namespace delf {

/// What of a new row is looked at, at neighbours that follow each other, and held against what was expected:
///
///     of the row         Σ_p weights[p] (y − expected)(i + p)
///     of an argument     u(i) − argument(i),      u(i) = Σ_p weights[p] y(i + p)
///
/// where u takes the place of what stood in `argument`. p = 0 … parts − 1.
struct RowLook {
  static constexpr int most_parts = 3;
  const double* expected = nullptr;
  int parts = 0;  ///< 0: nothing is
  double weights[most_parts] = {};
  double* argument = nullptr;  ///< if there is one
};

/// One component of the new row, made from w pack by pack:  v = v_before + w,  y = y_before + v.
struct RowIncrement {
  const double *v_before, *y_before;
  double *v, *y;
  RowLook look = {};
  double turn = 0;         ///< y is more by that for every time round the circle
  bool v_has_halo = true;  ///< or else who reads v across the ends of arcs fills it

  /// When all packs have been made: halos, overlaps, and `look_beyond`, which is given what finds pack j of y after the
  /// row from packs that `read` gives: those of the row itself where that can be.
  template <class Look>
  [[gnu::always_inline]] void close(const RowLayout& layout, const Look& look_beyond) const {
    if (layout.halos_come_first() && turn == 0) [[likely]] {
      look_beyond([&](const auto& read, int j) __attribute__((always_inline)) { return layout.after_last(read, j); });
      if (v_has_halo) layout.fill_halo(v);
      layout.fill_halo(y);
      layout.copy_overlaps(v, y);
    } else {
      close_slowly(layout);
      look_beyond([&](const auto&, int j) __attribute__((always_inline)) {
        return Pack::load(y + layout.at(layout.packs() + j));
      });
    }
  }

 private:
  [[gnu::noinline]] void close_slowly(const RowLayout& layout) const {
    layout.copy_overlaps(v, y);
    if (v_has_halo) layout.fill_halo(v);
    layout.fill_halo(y, turn);
  }
};

/// The larger of two; a NaN stays one.
inline double larger_or_nan(double a, double b) { return a > b || a != a ? a : b; }

/// The largest |y| of a new row, and the largest |look|.
struct RowChange {
  double largest = 0, change = 0;

  void take(const RowChange& other) {
    largest = larger_or_nan(other.largest, largest);
    change = larger_or_nan(other.change, change);
  }
};

enum class Order { ascending, descending };

/// What a pass has seen of the last `count` packs, the newest last. One member each: arrays would go through memory.
template <int count>
struct LastPacks {
  LastPacks<count - 1> older;
  Pack newest = 0.0;
  [[gnu::always_inline]] void take(Pack next) {
    older.take(newest);
    newest = next;
  }
  [[gnu::always_inline]] Pack oldest() const {
    if constexpr (count == 1) return newest;
    else return older.oldest();
  }
  /// As long as less has been seen, sums over all of them are NaN, which larger_magnitude() leaves out.
  void have_seen_nothing() {
    older.have_seen_nothing();
    newest = std::numeric_limits<double>::quiet_NaN();
  }
};
template <>
struct LastPacks<0> {
  [[gnu::always_inline]] void take(Pack) {}
  void have_seen_nothing() {}
};

/// Their weights: Σ_p weight_p · pack_p is added to a sum.
template <int count>
struct PackWeights {
  PackWeights<count - 1> older;
  double newest;
  /// In the order of the packs.
  explicit PackWeights(const double* weights, int by) : older(weights, by), newest(weights[(count - 1) * by]) {}
  [[gnu::always_inline]] Pack added(Pack sum, const LastPacks<count>& packs) const {
    return older.added(sum + newest * packs.newest, packs.older);
  }
};
template <>
struct PackWeights<0> {
  explicit PackWeights(const double*, int) {}
  [[gnu::always_inline]] Pack added(Pack sum, const LastPacks<0>&) const { return sum; }
};

/// `increment`: against y_before + v_before, from which the row differs by w.
enum class Look { row, argument, increment };

/// A pass over all packs of a RowIncrement, one after the other; what it measures stays in registers. The first
/// `parts` − 1 of them have nothing to be looked at with. Ascending passes leave them out by themselves: what they would
/// put into arguments is NaN, in packs of the halo, which no one reads. Descending ones would put it into arguments that
/// are still wanted: so many packs must be handed to unseen(). What was expected is finite: where a change is NaN, the
/// largest |y| shows it.
template <int parts, Order order, Look look>
class IncrementPass {
 public:
  static constexpr int packs_unseen = order == Order::descending && parts > 1 ? parts - 1 : 0;
  explicit IncrementPass(const RowIncrement& rows)
      : v_before_(rows.v_before),
        y_before_(rows.y_before),
        expected_(rows.look.expected),
        v_(rows.v),
        y_(rows.y),
        argument_(rows.look.argument),
        weights_(rows.look.weights + (order == Order::ascending || parts == 0 ? 0 : parts - 1),
                 order == Order::ascending ? 1 : -1) {
    seen_.have_seen_nothing();
  }
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) {
    unseen(at, w);
    if constexpr (look == Look::increment) {
      change_ = detail::larger_magnitude(change_, w);
    } else if constexpr (parts > 0) {
      look_at(weights_.added(Pack(0.0), seen_), at - (order == Order::ascending ? (parts - 1) * lanes : 0));
    }
  }
  /// What is looked at of y.
  [[gnu::always_inline]] Pack looked_at(std::ptrdiff_t at, Pack y) const {
    return look == Look::row ? y - Pack::load(expected_ + at) : y;
  }
  /// Returns y.
  [[gnu::always_inline]] Pack unseen(std::ptrdiff_t at, Pack w) {
    const Pack v = Pack::load(v_before_ + at) + w, y = Pack::load(y_before_ + at) + v;
    largest_ = detail::larger_magnitude(largest_, y);
    sum_ += y;
    if constexpr (parts > 0 && look != Look::increment) seen_.take(looked_at(at, y));
    v.store(v_ + at);
    y.store(y_ + at);
    return y;
  }
  /// When all packs have been handed over: closes the row, and looks beyond its end.
  [[gnu::always_inline]] RowChange closed(const RowLayout& layout, const RowIncrement& rows) {
    rows.close(layout, [&](const auto& after_last) __attribute__((always_inline)) {
      if constexpr (parts > 1 && look != Look::increment) {
        const std::ptrdiff_t begin = layout.at(0), end = layout.at(layout.packs());
        // What a descending pass has made last is still at hand.
        const auto read = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
          if constexpr (order == Order::descending && look == Look::argument) {
            if (at == begin) return seen_.newest;
            if (at == begin + lanes) return seen_.older.newest;
          }
          return Pack::load(y_ + at);
        };
        // The last packs, and those after them. A descending pass has only just made the first of these: it is added last.
        constexpr int newest = parts - 1;
        Pack beside[2 * (parts - 1)];
        for (int p = 0; p < parts - 1; ++p) {
          beside[p] = looked_at(end - (parts - 1 - p) * lanes, Pack::load(y_ + end - (parts - 1 - p) * lanes));
          beside[parts - 1 + p] = looked_at(end + p * lanes, after_last(read, p));
        }
        for (int i = 0; i < parts - 1; ++i) {
          Pack u(0.0);
          for (int p = 0; p < parts; ++p)
            if (i + p != newest) u += rows.look.weights[p] * beside[i + p];
          u += rows.look.weights[newest - i] * beside[newest];
          look_at(u, end - (parts - 1 - i) * lanes);
        }
      }
    });
    return result();
  }
  /// Without the packs that look beyond the last one handed over.
  RowChange result() const {
    const auto [largest, change] = both_largest_sizes(largest_ + 0.0 * sum_, change_);
    return {largest, change};
  }

 private:
  /// Takes in how far u is from what was expected of it; an argument gives way to it.
  [[gnu::always_inline]] void look_at(Pack u, std::ptrdiff_t at) {
    if constexpr (look == Look::row) {
      change_ = detail::larger_magnitude(change_, u);
    } else {
      change_ = detail::larger_magnitude(change_, u - Pack::load(argument_ + at));
      u.store(argument_ + at);
    }
  }

  const double *v_before_, *y_before_, *expected_;
  double *v_, *y_, *argument_;
  PackWeights<parts> weights_;
  Pack largest_ = 0.0, change_ = 0.0;
  Pack sum_ = 0.0;  ///< of y: a NaN goes by in a maximum, and stays in a sum
  LastPacks<parts> seen_;  ///< y, less what was expected of it where the row is looked at
};

/// `run` with the IncrementPass that the rows ask for. Inlined, as passes are: what they carry stays in registers.
template <Order order, class Run>
[[gnu::always_inline]] inline RowChange with_increment_pass(const RowIncrement& rows, Run run) {
  if (rows.look.argument) {
    switch (rows.look.parts) {
      case 1:
        return run(IncrementPass<1, order, Look::argument>(rows));
      case 2:
        return run(IncrementPass<2, order, Look::argument>(rows));
      default:
        return run(IncrementPass<3, order, Look::argument>(rows));
    }
  }
  switch (rows.look.parts) {
    case 0:
      return run(IncrementPass<0, order, Look::row>(rows));
    case 1:
      return run(IncrementPass<1, order, Look::row>(rows));
    case 2:
      return run(IncrementPass<2, order, Look::row>(rows));
    default:
      return run(IncrementPass<3, order, Look::row>(rows));
  }
}

}  // namespace delf
