// SPDX-License-Identifier: MIT
#pragma once
#include "jets/simd/pack_math.hpp"
#include "tools/peers/wave_equation.hpp"

namespace delf::peers {

// −V′(φ) = strength · shape(φ): the strength is multiplied into what a loop multiplies with anyway. slope is shape′.

struct NoForce {
  static constexpr Pack shape(Pack) { return 0.0; }
  static constexpr Pack slope(Pack) { return 0.0; }
  static double strength(const WaveEquation&) { return 0; }
};
/// −m²φ
struct LinearForce {
  static Pack shape(Pack phi) { return phi; }
  static Pack slope(Pack) { return 1.0; }
  static double strength(const WaveEquation& e) { return -e.mass * e.mass; }
};
/// −m² sin φ
struct SineForce {
  static Pack shape(Pack phi) { return sin(phi); }
  static Pack slope(Pack phi) { return cos(phi); }
  static double strength(const WaveEquation& e) { return -e.mass * e.mass; }
};
/// −λ(φ³ − φ)
struct DoubleWellForce {
  static Pack shape(Pack phi) { return phi * (phi * phi - 1.0); }
  static Pack slope(Pack phi) { return 3.0 * phi * phi - 1.0; }
  static double strength(const WaveEquation& e) { return -e.lambda; }
};

/// use(force) with the one of the types above that the equation has.
auto with_force(const WaveEquation& equation, const auto& use) {
  switch (equation.potential) {
    case WaveEquation::Potential::quadratic:
      return use(LinearForce{});
    case WaveEquation::Potential::sine_gordon:
      return use(SineForce{});
    case WaveEquation::Potential::phi4:
      return use(DoubleWellForce{});
    case WaveEquation::Potential::none:
      break;
  }
  return use(NoForce{});
}

}  // namespace delf::peers
