// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// A mass on a spring, of frequency m: Klein–Gordon at one point of space.
///
/// ℓ = ½q_t² − ½m²q²                                       q_tt + m²q = 0
struct HarmonicOscillator {
  double mass = 1;

  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t) - (0.5 * mass * mass) * (j.phi * j.phi); }

  /// (−½m²a² + ½m²b²)/(a − b)
  template <class T>
  T difference_quotient(const T& a, const T& b) const {
    return (-0.5 * mass * mass) * (a + b);
  }
};

}  // namespace delf
