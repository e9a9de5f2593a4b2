// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

namespace delf::bench {

/// −(N(a) − N(b))/(a − b) for N = cos: sin((a+b)/2) · sinc((a−b)/2), which loses nothing when a ≈ b. Below ¼ sinc is
/// its series, of which x¹²/13! = 1e-17 is left out: the differences of rows one or two steps apart are hardly ever
/// larger, and so the second sine is hardly ever taken.
inline double quotient(double a, double b) {
  const double x = 0.5 * (a - b), s = x * x;
  const double sinc = std::abs(x) < 0.25
                          ? 1 + s * (-1. / 6 + s * (1. / 120 + s * (-1. / 5040 + s * (1. / 362880 - s / 39916800))))
                          : std::sin(x) / x;
  return std::sin(0.5 * (a + b)) * sinc;
}

}  // namespace delf::bench
