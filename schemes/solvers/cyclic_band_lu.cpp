// SPDX-License-Identifier: MIT
#include "schemes/solvers/cyclic_band_lu.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"

namespace delf {

Bandwidth bandwidth(const Lattice& lattice, int size, const std::vector<MatrixEntry>& entries) {
  Bandwidth band;
  for (const auto& e : entries) {
    int offset = e.column - e.row;
    if (lattice.is_circle() && offset > size / 2) offset -= size;
    if (lattice.is_circle() && offset < -(size / 2)) offset += size;
    band.lower = std::max(band.lower, -offset);
    band.upper = std::max(band.upper, offset);
  }
  return band;
}

std::optional<CyclicBandLU> CyclicBandLU::factor(int size, Bandwidth width, bool cyclic,
                                                 const std::vector<MatrixEntry>& entries) {
  const auto [lower, upper] = width;
  if (size <= 2 * (lower + upper) + 2) return std::nullopt;
  CyclicBandLU f;
  f.lower_ = lower;
  f.upper_ = upper;
  f.border_ = cyclic ? std::max(lower, upper) : 0;
  f.plain_ = size - f.border_;
  const int n = f.plain_, m = f.border_, w = lower + 1 + upper;
  std::vector<double> band(delf::at(n) * delf::at(w), 0.0);
  const auto at = [&](int i, int j) -> double& { return band[delf::at(i) * delf::at(w) + delf::at(j - i + lower)]; };
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, m), H = Eigen::MatrixXd::Zero(m, m);
  // G is not zero in its first and its last columns only.
  for (int c = 0; c < std::min(m, n); ++c) f.border_columns_.push_back(c);
  for (int c = std::max(m, n - m); c < n; ++c) f.border_columns_.push_back(c);
  f.border_rows_ = Eigen::MatrixXd::Zero(m, static_cast<Eigen::Index>(f.border_columns_.size()));
  double largest = 0;
  for (const auto& e : entries) {
    largest = std::max(largest, std::abs(e.value));
    if (e.row < n && e.column < n) {
      at(e.row, e.column) += e.value;
    } else if (e.row < n) {
      F(e.row, e.column - n) += e.value;
    } else if (e.column >= n) {
      H(e.row - n, e.column - n) += e.value;
    } else {
      const auto where = std::ranges::find(f.border_columns_, e.column) - f.border_columns_.begin();
      f.border_rows_(e.row - n, where) += e.value;
    }
  }
  for (int p = 0; p < n; ++p) {
    const double pivot = at(p, p);
    if (!(std::abs(pivot) > 1e-10 * largest)) return std::nullopt;
    for (int i = p + 1; i <= std::min(n - 1, p + lower); ++i) {
      const double multiplier = at(i, p) / pivot;
      at(i, p) = multiplier;
      for (int j = p + 1; j <= std::min(n - 1, p + upper); ++j) at(i, j) -= multiplier * at(p, j);
    }
  }
  for (int i = 0; i < n; ++i) {
    f.pivot_.push_back(1 / at(i, i));
    for (int s = -lower; s < 0; ++s) f.lower_band_.push_back(i + s >= 0 ? at(i, i + s) : 0.0);
    for (int s = 1; s <= upper; ++s) f.upper_band_.push_back(i + s < n ? at(i, i + s) : 0.0);
  }
  f.Z_ = F;
  for (int c = 0; c < m; ++c) f.solve_band(f.Z_.col(c).data());
  for (std::size_t c = 0; c < f.border_columns_.size(); ++c)
    H -= f.border_rows_.col(static_cast<Eigen::Index>(c)) * f.Z_.row(f.border_columns_[c]);
  if (m > 0) {
    f.schur_.compute(H);
    if (!(f.schur_.rcond() > 1e-14)) return std::nullopt;
  }
  return f;
}

void CyclicBandLU::solve_band(double* x) const {
  const int n = plain_;
  for (int i = 0; i < n; ++i) {
    const double* l = lower_band_.data() + static_cast<std::ptrdiff_t>(i) * lower_;
    double sum = x[i];
    for (int s = std::max(0, lower_ - i); s < lower_; ++s) sum -= l[s] * x[i - lower_ + s];
    x[i] = sum;
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* u = upper_band_.data() + static_cast<std::ptrdiff_t>(i) * upper_;
    double sum = x[i];
    for (int s = 0; s < std::min(upper_, n - 1 - i); ++s) sum -= u[s] * x[i + 1 + s];
    x[i] = sum * pivot_[i];
  }
}

void CyclicBandLU::solve(std::vector<double>& x) const {
  solve_band(x.data());
  if (border_ == 0) return;
  Eigen::Map<Eigen::VectorXd> plain(x.data(), plain_), border(x.data() + plain_, border_);
  for (std::size_t c = 0; c < border_columns_.size(); ++c)
    border -= border_rows_.col(static_cast<Eigen::Index>(c)) * plain[border_columns_[c]];
  border = schur_.solve(border.eval());
  plain.noalias() -= Z_ * border;
}

}  // namespace delf
