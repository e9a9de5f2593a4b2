// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "jets/simd/pack.hpp"
#include "lattice/index.hpp"

namespace delf::bench {

/// A band of `half` diagonals on either side, known when it is compiled; LU with partial pivoting in place. Columns lie
/// at absolute places modulo a pack.
template <int half>
class PackedBand {
 public:
  explicit PackedBand(int n)
      : n_(n), rows_(at(n * (width / lanes) + 1), Pack(0.0)), inverse_(at(n)), lower_(at(n * half)), pivot_(at(n)) {
    for (int i = 0; i < n; ++i) base_.push_back(i * width - (i + before - half) / lanes * lanes + before);
  }
  int place(int i, int j) const { return base_[i] + j; }
  int beyond() const { return n_ * width; }  ///< a place that nobody reads
  double* numbers() { return reinterpret_cast<double*>(rows_.data()); }
  void set_zero() { std::ranges::fill(rows_, Pack(0.0)); }

  [[gnu::noinline]] bool factor() {
    double* const a = numbers();
    for (int k = 0; k < n_; ++k) {
      const int last = std::min(n_ - 1, k + half), last_column = std::min(n_ - 1, k + 2 * half);
      // Magnitudes as integers whose last four bits are the row: the largest is found without a branch.
      std::uint64_t best = 0;
      for (int i = k; i <= last; ++i)
        best = std::max(best, (std::bit_cast<std::uint64_t>(a[place(i, k)]) << 1 >> 1 & ~std::uint64_t{15}) |
                                  static_cast<std::uint64_t>(15 - (i - k)));
      const int p = pivot_[k] = k + 15 - static_cast<int>(best & 15);
      const int first = k / lanes * lanes, blocks = (last_column - first) / lanes + 1;
      Pack *const row = rows_.data() + place(k, first) / lanes, *const other = rows_.data() + place(p, first) / lanes;
      const double pivot = a[place(p, k)];
      if (!(std::abs(pivot) > 0 && std::abs(pivot) < 1e300)) return false;
      inverse_[k] = 1 / pivot;
      Pack r[most];
      for (int b = 0; b < most; ++b)
        if (b < 2 || b < blocks) r[b] = other[b], other[b] = row[b], row[b] = r[b];
      double* const l = lower_.data() + at(k * half);
      for (int i = k + 1; i <= last; ++i) {
        Pack* const to = rows_.data() + place(i, first) / lanes;
        const double by = l[i - k - 1] = a[place(i, k)] * inverse_[k];
        for (int b = 0; b < most; ++b)
          if (b < 2 || b < blocks) to[b] -= by * r[b];
      }
    }
    return true;
  }
  [[gnu::noinline]] void solve(double* x) const {
    const double* const a = reinterpret_cast<const double*>(rows_.data());
    for (int k = 0; k < n_; ++k) {
      const double* const l = lower_.data() + at(k * half);
      const double pivot = x[pivot_[k]];
      x[pivot_[k]] = x[k], x[k] = pivot;
      if (k + half < n_)
        for (int i = 0; i < half; ++i) x[k + 1 + i] -= l[i] * pivot;
      else
        for (int i = k + 1; i < n_; ++i) x[i] -= l[i - k - 1] * pivot;
    }
    for (int k = n_ - 1; k >= 0; --k) {
      const double* const u = a + place(k, k);
      double s = x[k];
      if (k + 2 * half < n_)
        for (int j = 2 * half; j > 0; --j) s -= u[j] * x[k + j];  // the newest last
      else
        for (int j = n_ - 1 - k; j > 0; --j) s -= u[j] * x[k + j];
      x[k] = s * inverse_[k];
    }
  }

 private:
  static constexpr int before = (half + lanes - 1) / lanes * lanes;
  static constexpr int width = (lanes + 3 * half + lanes - 1) / lanes * lanes;
  static constexpr int most = (lanes - 1 + 2 * half) / lanes + 1;  ///< packs of a row that a pivot's row changes
  static_assert(half < 16);

  int n_;
  std::vector<Pack> rows_;
  std::vector<double> inverse_, lower_;  ///< 1/U_kk; the multipliers of the rows below k
  std::vector<int> base_, pivot_;
};

}  // namespace delf::bench
