// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/row_layout.hpp"

namespace delf {

/// One component of the new row, made from w pack by pack:  v = v_before + w,  y = y_before + v.
struct RowIncrement {
  const double *v_before, *y_before;
  double *v, *y;
};

/// A pass over the packs of a RowIncrement; the largest |y| stays in a register.
class IncrementPass {
 public:
  explicit IncrementPass(const RowIncrement &rows) : rows_(rows) {}
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) {
    const Pack v = Pack::load(rows_.v_before + at) + w;
    const Pack y = Pack::load(rows_.y_before + at) + v;
    largest_ = max_or_nan(abs(y), largest_);
    v.store(rows_.v + at);
    y.store(rows_.y + at);
  }
  double largest() const { return max_or_nan(largest_); }

 private:
  RowIncrement rows_;
  Pack largest_ = 0.0;
};

/// The larger of two; a NaN stays one.
inline double larger_or_nan(double a, double b) { return a > b || a != a ? a : b; }

}  // namespace delf
