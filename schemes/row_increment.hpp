// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/row_layout.hpp"

namespace delf {

/// What of the difference between a new row and the one that it was expected to be is looked at:
/// Σ_p weights[p] (y − expected)(i + p), p = 0 … parts − 1.
struct RowLook {
  static constexpr int most_parts = 3;
  const double* expected = nullptr;
  int parts = 0;  ///< 0: nothing is
  double weights[most_parts] = {};
};

/// One component of the new row, made from w pack by pack:  v = v_before + w,  y = y_before + v.
struct RowIncrement {
  const double *v_before, *y_before;
  double *v, *y;
  RowLook look = {};
};

/// The larger of two; a NaN stays one.
inline double larger_or_nan(double a, double b) { return a > b || a != a ? a : b; }

/// The largest |y| of a new row, and the largest |look|. The last parts − 1 packs look beyond the end, which is not
/// there yet: these are left out.
struct RowChange {
  Pack largest = 0.0, change = 0.0;  ///< over each lane's sites

  void take(const RowChange& other) {
    largest = max_or_nan(other.largest, largest);
    change = max_or_nan(other.change, change);
  }
};

enum class Order { ascending, descending };

/// A pass over all packs of a RowIncrement, one after the other; what it measures stays in registers. The first
/// `parts` − 1 of them have nothing to be looked at with: after these, begin_looking().
template <int parts, Order order>
class IncrementPass {
 public:
  explicit IncrementPass(const RowIncrement& rows)
      : v_before_(rows.v_before), y_before_(rows.y_before), expected_(rows.look.expected), v_(rows.v), y_(rows.y) {
    for (int p = 0; p < parts; ++p) weights_[p] = rows.look.weights[order == Order::ascending ? p : parts - 1 - p];
    for (Pack& d : differences_) d = Pack(0.0);
  }
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) {
    const Pack v = Pack::load(v_before_ + at) + w;
    const Pack y = Pack::load(y_before_ + at) + v;
    largest_ = max_or_nan(abs(y), largest_);
    if constexpr (parts > 0) {
      for (int p = 0; p + 1 < parts; ++p) differences_[p] = differences_[p + 1];
      differences_[parts - 1] = y - Pack::load(expected_ + at);
      Pack look = weights_[0] * differences_[0];
      for (int p = 1; p < parts; ++p) look += weights_[p] * differences_[p];
      change_ = max_or_nan(abs(look), change_);
    }
    v.store(v_ + at);
    y.store(y_ + at);
  }
  void begin_looking() { change_ = Pack(0.0); }
  RowChange result() const { return {largest_, change_}; }

 private:
  static constexpr int held = parts > 0 ? parts : 1;
  const double *v_before_, *y_before_, *expected_;
  double *v_, *y_;
  double weights_[held];
  Pack largest_ = 0.0, change_ = 0.0;
  Pack differences_[held];  ///< y − expected of the last packs
};

/// `run` with the IncrementPass that the rows ask for. Inlined, as passes are: what they carry stays in registers.
template <Order order, class Run>
[[gnu::always_inline]] inline RowChange with_increment_pass(const RowIncrement& rows, Run run) {
  switch (rows.look.parts) {
    case 0:
      return run(IncrementPass<0, order>(rows), 0);
    case 1:
      return run(IncrementPass<1, order>(rows), 0);
    case 2:
      return run(IncrementPass<2, order>(rows), 1);
    default:
      return run(IncrementPass<3, order>(rows), 2);
  }
}

}  // namespace delf
