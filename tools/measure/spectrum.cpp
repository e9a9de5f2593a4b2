// SPDX-License-Identifier: MIT
#include "tools/measure/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace delf {

double spectrum_peak(std::span<const double> values, bool periodic) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::size_t n = values.size();
  if (n < 8) return unknown;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  std::vector<double> windowed(n);
  for (std::size_t j = 0; j < n; ++j) {
    // Hann's window  w_j = sin²(πj/n)
    const double s = std::sin(std::numbers::pi * static_cast<double>(j) / static_cast<double>(n));
    windowed[j] = (values[j] - mean) * (periodic ? 1 : s * s);
  }
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double>().fwd(spectrum, windowed);
  const auto size = [&](std::size_t m) { return std::abs(spectrum[m]); };
  std::size_t peak = 1;
  for (std::size_t m = 1; 2 * m < n; ++m)
    if (size(m) > size(peak)) peak = m;
  if (!(size(peak) > 0)) return unknown;
  const auto m = static_cast<double>(peak);
  if (periodic || peak < 2 || 2 * (peak + 1) >= n) return m;
  const double a = std::log(size(peak - 1)), b = std::log(size(peak)), c = std::log(size(peak + 1));
  const double curvature = a - 2 * b + c;
  return curvature < 0 ? m + 0.5 * (a - c) / curvature : m;
}

}  // namespace delf
