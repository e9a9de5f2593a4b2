// SPDX-License-Identifier: MIT
#include "schemes/solvers/band_lu.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "jets/simd/pack_gather.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// The largest multiple of a pack's width that is not above i ≥ 0.
int whole_packs(int i) { return i / lanes * lanes; }

// Loops of a length known when they are compiled, for the widths that are common; 0 stands for any.

/// x −= by l
template <int known>
[[gnu::always_inline]] inline void subtract(const double* l, double by, double* x, int count) {
  for (int i = 0; i < (known ? known : count); ++i) x[i] -= l[i] * by;
}

/// x_k+1 … x_k+lower −= x_k times their multipliers, for all k.
template <int known>
void eliminate(int n, int any_lower, const int* pivot, const double* multipliers, double* x) {
  const int lower = known ? known : any_lower;
  int k = 0;
  for (; k < n - lower; ++k, multipliers += lower) {
    const double by = x[pivot[k]];
    x[pivot[k]] = x[k], x[k] = by;
    subtract<known>(multipliers, by, x + k + 1, lower);
  }
  for (; k < n; ++k, multipliers += lower) {
    std::swap(x[k], x[pivot[k]]);
    subtract<0>(multipliers, x[k], x + k + 1, n - 1 - k);
  }
}
using Eliminate = void (*)(int, int, const int*, const double*, double*);

template <int... lower>
constexpr std::array<Eliminate, sizeof...(lower)> eliminations(std::integer_sequence<int, lower...>) {
  return {eliminate<lower>...};
}
constexpr auto common = eliminations(std::make_integer_sequence<int, 24>{});

}  // namespace

BandLU::BandLU(int n, int lower, int upper) : n_(n), lower_(lower), upper_(std::min(n - 1, lower + upper)) {
  // Row i holds the columns from the first of the pack of column i − lower on.
  const int before = whole_packs(lower + lanes - 1);
  const int width = whole_packs(lower_ + upper_ + 2 * lanes - 1);
  rows_.assign(n * (width / lanes), Pack(0.0));
  for (int i = 0; i < n; ++i) base_.push_back(i * width - whole_packs(i + before - lower) + before);
  pivot_.resize(n), inverse_.resize(n), multipliers_.resize(n * lower);
}

void BandLU::set_zero() { std::ranges::fill(rows_, Pack(0.0)); }

bool BandLU::factor() {
  double* const a = numbers();
  for (int k = 0; k < n_; ++k) {
    const int last = std::min(n_ - 1, k + lower_), last_column = std::min(n_ - 1, k + upper_);
    int best = k;
    for (int i = k + 1; i <= last; ++i)
      if (std::abs(a[place(i, k)]) > std::abs(a[place(best, k)])) best = i;
    pivot_[k] = best;
    const double pivot = a[place(best, k)];
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) return false;
    inverse_[k] = 1 / pivot;
    const int first = whole_packs(k), packs = (last_column - first) / lanes + 1;
    Pack* const row = rows_.data() + place(k, first) / lanes;
    if (best != k) std::swap_ranges(row, row + packs, rows_.data() + place(best, first) / lanes);
    for (int i = k + 1; i <= last; ++i) {
      const double by = multipliers_[k * lower_ + i - k - 1] = a[place(i, k)] * inverse_[k];
      Pack* const to = rows_.data() + place(i, first) / lanes;
      for (int p = 0; p < packs; ++p) to[p] -= Pack(by) * row[p];
    }
  }
  return true;
}

/// x_k = (x_k − Σ_{j>0} u_j x_{k+j})/u_0. The numbers found last are needed last and kept out of memory: a row waits for
/// those before it by three products.
void BandLU::solve(double* x) const {
  const bool is_common = at(lower_) < common.size();
  (is_common ? common[lower_] : eliminate<0>)(n_, lower_, pivot_.data(), multipliers_.data(), x);
  double x1 = 0, x2 = 0, x3 = 0;  // x_{k+1}, …
  for (int k = n_ - 1; k >= 0; --k) {
    const double* const u = numbers() + place(k, k);
    const int count = std::min(upper_, n_ - 1 - k);
    Pack old(0.0);
    int j = count;
    for (; j >= 3 + lanes; j -= lanes) old += load_unaligned(u + j - lanes + 1) * load_unaligned(x + k + j - lanes + 1);
    double s = x[k] - sum(old);
    for (; j > 3; --j) s -= u[j] * x[k + j];
    if (count > 2) s -= u[3] * x3;
    if (count > 1) s -= u[2] * x2;
    if (count > 0) s -= u[1] * x1;
    x3 = x2, x2 = x1, x1 = x[k] = s * inverse_[k];
  }
}

std::size_t BandLU::bytes() const {
  return rows_.size() * sizeof(Pack) + (base_.size() + pivot_.size()) * sizeof(int) +
         (multipliers_.size() + inverse_.size()) * sizeof(double);
}

}  // namespace delf
