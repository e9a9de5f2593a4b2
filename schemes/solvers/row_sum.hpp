// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "jets/simd/pack.hpp"

namespace delf {

/// A weighted sum of rows in the lanes' layout, each shifted by some sites:
///
///     sum(i) = constant + Σ_t c_t row_t(i + s_t) + Σ_t c_t (row_t(i + s_t) − row_t(i))
///
/// Rows are named by their number in a table of pointers, so that a sum is made once and evaluated for any step.
class RowSum {
 public:
  void add(int row, int shift, double coefficient) {
    for (Term& t : plain_)
      if (t.row == row && t.by == static_cast<std::ptrdiff_t>(shift) * lanes) {
        t.coefficient += coefficient;
        return;
      }
    plain_.push_back(term(row, shift, coefficient));
  }
  /// When all terms are there: neighbours with the same coefficient are taken together.
  void pair_up() {
    std::erase_if(plain_, [](const Term& t) { return t.coefficient == 0; });
    for (std::size_t n = 0; n < plain_.size(); ++n)
      for (std::size_t m = n + 1; m < plain_.size(); ++m)
        if (plain_[n].row == plain_[m].row && plain_[n].coefficient == plain_[m].coefficient &&
            std::abs(plain_[n].by - plain_[m].by) == lanes) {
          pairs_.push_back({plain_[n].row, std::min(plain_[n].by, plain_[m].by), plain_[n].coefficient});
          plain_.erase(plain_.begin() + static_cast<std::ptrdiff_t>(m));
          plain_.erase(plain_.begin() + static_cast<std::ptrdiff_t>(n));
          --n;
          break;
        }
  }
  /// Differences to the left and right with the same coefficient are taken together.
  void add_difference(int row, int shift, double coefficient) {
    for (std::size_t n = 0; n < single_.size(); ++n)
      if (single_[n].row == row && single_[n].by == -shift * lanes && single_[n].coefficient == coefficient) {
        double_.push_back(term(row, std::abs(shift), coefficient));
        single_.erase(single_.begin() + static_cast<std::ptrdiff_t>(n));
        return;
      }
    single_.push_back(term(row, shift, coefficient));
  }
  void add_constant(double value) { constant_ += value; }
  void scale(double factor) {
    constant_ *= factor;
    for (auto* terms : {&plain_, &pairs_, &single_, &double_})
      for (Term& t : *terms) t.coefficient *= factor;
  }
  /// The row and shift, in doubles, that the sum is alone; null if it is more.
  struct OneRow {
    int row = -1;
    std::ptrdiff_t by = 0;
  };
  OneRow one_row() const {
    if (plain_.size() != 1 || plain_[0].coefficient != 1 || constant_ != 0 || !pairs_.empty() || !single_.empty() ||
        !double_.empty())
      return {};
    return {plain_[0].row, plain_[0].by};
  }

  /// sink(at, sum) for the packs at `from`, from + stride, … before `to`, in doubles from the rows' beginning, one after
  /// the other. Inlined with its sink.
  template <std::ptrdiff_t stride, class Sink>
  [[gnu::always_inline]] void pass(const double* const* rows, std::ptrdiff_t from, std::ptrdiff_t to, Sink& sink) const {
    constexpr std::ptrdiff_t packs = 8;  // whose sums stay in registers
    std::ptrdiff_t at = from;
    for (; at + (packs - 1) * stride < to; at += packs * stride) block<packs, stride>(rows, at, sink);
    for (; at < to; at += stride) block<1, stride>(rows, at, sink);
  }
  /// Into out + at.
  void evaluate(const double* const* rows, std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t stride,
                double* out) const;
  /// One pack after the other, from out on.
  void evaluate_dense(const double* const* rows, std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t stride,
                      double* out) const;
  /// The sum of plain terms in one slot.
  double at(const double* const* rows, std::ptrdiff_t slot) const {
    double sum = constant_;
    for (const Term& t : plain_) sum += t.coefficient * rows[t.row][slot + t.by];
    return sum;
  }
  /// Σ of the absolute values of the terms too: sink(at, sum, sum of sizes).
  template <class Sink>
  void measure(const double* const* rows, std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t stride,
               Sink sink) const {
    for (std::ptrdiff_t at = from; at < to; at += stride) {
      Pack total(constant_), size(std::abs(constant_));
      const auto take = [&](double c, Pack x) {
        total += c * x;
        size += std::abs(c) * abs(x);
      };
      for (const Term& t : plain_) take(t.coefficient, Pack::load(rows[t.row] + at + t.by));
      for (const Term& t : pairs_)
        for (const int next : {0, lanes}) take(t.coefficient, Pack::load(rows[t.row] + at + t.by + next));
      for (const Term& t : single_)
        take(t.coefficient, Pack::load(rows[t.row] + at + t.by) - Pack::load(rows[t.row] + at));
      for (const Term& t : double_)
        for (const std::ptrdiff_t by : {t.by, -t.by})
          take(t.coefficient, Pack::load(rows[t.row] + at + by) - Pack::load(rows[t.row] + at));
      sink(at, total, size);
    }
  }

 private:
  struct Term {
    int row;
    std::ptrdiff_t by;  ///< shift, in doubles
    double coefficient;
  };
  static Term term(int row, int shift, double c) { return {row, static_cast<std::ptrdiff_t>(shift) * lanes, c}; }

  template <int packs, std::ptrdiff_t stride, class Sink>
  [[gnu::always_inline]] void block(const double* const* rows, std::ptrdiff_t at, Sink& sink) const {
    Pack sums[packs];
    for (int p = 0; p < packs; ++p) sums[p] = Pack(constant_);
    for (const Term& t : double_) {
      const Pack c(t.coefficient);
      const double *const own = rows[t.row] + at, *const right = own + t.by, *const left = own - t.by;
      if (stride == lanes && t.by == lanes) {  // a difference to the right is one to the left for the next pack
        Pack y = Pack::load(own), to_left = y - Pack::load(left);
        for (int p = 0; p < packs; ++p) {
          const Pack next = Pack::load(right + p * stride), to_right = next - y;
          sums[p] += c * (to_right - to_left);
          y = next, to_left = to_right;
        }
        continue;
      }
      for (int p = 0; p < packs; ++p) {
        const Pack y = Pack::load(own + p * stride);
        sums[p] += c * ((Pack::load(right + p * stride) - y) - (y - Pack::load(left + p * stride)));
      }
    }
    for (const Term& t : pairs_) {
      const Pack c(t.coefficient);
      const double* const row = rows[t.row] + at + t.by;
      Pack y = Pack::load(row);
      for (int p = 0; p < packs; ++p) {
        const Pack next = Pack::load(row + p * stride + lanes);
        sums[p] += c * (y + next);
        y = stride == lanes ? next : Pack::load(row + (p + 1 < packs ? p + 1 : p) * stride);
      }
    }
    for (const Term& t : single_) {
      const Pack c(t.coefficient);
      const double *const own = rows[t.row] + at, *const beside = own + t.by;
      for (int p = 0; p < packs; ++p) sums[p] += c * (Pack::load(beside + p * stride) - Pack::load(own + p * stride));
    }
    for (const Term& t : plain_) {
      const Pack c(t.coefficient);
      const double* const row = rows[t.row] + at + t.by;
      for (int p = 0; p < packs; ++p) sums[p] += c * Pack::load(row + p * stride);
    }
    for (int p = 0; p < packs; ++p) sink(at + p * stride, sums[p]);
  }

  double constant_ = 0;
  std::vector<Term> plain_, pairs_;      ///< c row(i + s), and c (row(i + s) + row(i + s + 1))
  std::vector<Term> single_, double_;    ///< differences to one neighbour, and to both
};

}  // namespace delf
