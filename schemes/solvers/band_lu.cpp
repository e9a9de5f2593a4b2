// SPDX-License-Identifier: MIT
#include "schemes/solvers/band_lu.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The largest multiple of a pack's width that is not above i ≥ 0.
int whole_packs(int i) { return i / lanes * lanes; }

// One by one: packs would wait for what was just stored at places that differ from theirs.
/// x −= by l
[[gnu::optimize("no-tree-vectorize")]] void subtract(const double* l, double by, double* x, int count) {
  for (int i = 0; i < count; ++i) x[i] -= l[i] * by;
}

/// sum − u_count x_count − … − u_1 x_1
[[gnu::optimize("no-tree-vectorize")]] double subtracted(double sum, const double* u, const double* x, int count) {
  for (int j = count; j > 0; --j) sum -= u[j] * x[j];
  return sum;
}

Pack unaligned(const double* p) {
  Pack a;
  std::memcpy(&a, p, sizeof a);
  return a;
}

}  // namespace

BandLU::BandLU(int n, int lower, int upper) : n_(n), lower_(lower), upper_(std::min(n - 1, lower + upper)) {
  // Row i holds the columns from the first of the pack of column i − lower on.
  const int before = whole_packs(lower + lanes - 1);
  const int width = whole_packs(lower_ + upper_ + 2 * lanes - 1);
  rows_.assign(at(n * (width / lanes)), Pack(0.0));
  for (int i = 0; i < n; ++i) base_.push_back(i * width - whole_packs(i + before - lower) + before);
  pivot_.resize(at(n)), inverse_.resize(at(n)), multipliers_.resize(at(n * lower));
}

void BandLU::set_zero() { std::ranges::fill(rows_, Pack(0.0)); }

bool BandLU::factor() {
  double* const a = numbers();
  for (int k = 0; k < n_; ++k) {
    const int last = std::min(n_ - 1, k + lower_), last_column = std::min(n_ - 1, k + upper_);
    int best = k;
    for (int i = k + 1; i <= last; ++i)
      if (std::abs(a[place(i, k)]) > std::abs(a[place(best, k)])) best = i;
    pivot_[at(k)] = best;
    const double pivot = a[place(best, k)];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    inverse_[at(k)] = 1 / pivot;
    const int first = whole_packs(k), packs = (last_column - first) / lanes + 1;
    Pack* const row = rows_.data() + place(k, first) / lanes;
    if (best != k) std::swap_ranges(row, row + packs, rows_.data() + place(best, first) / lanes);
    for (int i = k + 1; i <= last; ++i) {
      const double by = multipliers_[at(k * lower_ + i - k - 1)] = a[place(i, k)] * inverse_[at(k)];
      Pack* const to = rows_.data() + place(i, first) / lanes;
      for (int p = 0; p < packs; ++p) to[p] -= Pack(by) * row[p];
    }
  }
  return true;
}

void BandLU::solve(double* x) const {
  for (int k = 0; k < n_; ++k) {
    std::swap(x[k], x[pivot_[at(k)]]);
    subtract(multipliers_.data() + at(k * lower_), x[k], x + k + 1, std::min(lower_, n_ - 1 - k));
  }
  // Terms of numbers known long ago by packs, those just found one by one and the newest last: a row waits for that alone.
  const int recent = upper_ < 2 * lanes ? upper_ : lanes + upper_ % lanes;
  for (int k = n_ - 1; k >= 0; --k) {
    const double* const u = numbers() + place(k, k);
    const int count = std::min(upper_, n_ - 1 - k);
    int j = count;
    double sum_of_row = x[k];
    if (count == upper_ && recent < upper_) {
      Pack old(0.0);
      for (; j > recent; j -= lanes) old += unaligned(u + j - lanes + 1) * unaligned(x + k + j - lanes + 1);
      sum_of_row -= sum(old);
    }
    x[k] = subtracted(sum_of_row, u, x + k, j) * inverse_[at(k)];
  }
}

std::size_t BandLU::bytes() const {
  return rows_.size() * sizeof(Pack) + (base_.size() + pivot_.size()) * sizeof(int) +
         (multipliers_.size() + inverse_.size()) * sizeof(double);
}

}  // namespace delf
