// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

namespace delf::initial {

// e^{−M} cosh x and e^{−M} sinh x for M ≥ |x|: quotients of hyperbolic functions without overflow.

inline double scaled_cosh(double x, double M) {
  return 0.5 * std::exp(std::abs(x) - M) * (1 + std::exp(-2 * std::abs(x)));
}
inline double scaled_sinh(double x, double M) {
  return std::copysign(0.5 * std::exp(std::abs(x) - M) * -std::expm1(-2 * std::abs(x)), x);
}

}  // namespace delf::initial
