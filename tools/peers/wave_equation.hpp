// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string_view>

namespace delf::peers {

/// φ_tt = φ_xx − V′(φ) on a circle of length L; φ(x + L) = φ(x) + monodromy.
struct WaveEquation {
  enum class Potential {
    none,         ///< V = 0
    quadratic,    ///< V = ½m²φ²
    sine_gordon,  ///< V = m²(1 − cos φ)
    phi4,         ///< V = ¼λ(φ² − 1)²
  };
  Potential potential = Potential::none;
  double mass = 1, lambda = 1;
  double length = 1, monodromy = 0;
  int sites = 0;

  /// Throws std::invalid_argument for a length that is not positive, fewer than `least_sites`, or a monodromy under which
  /// V′ does not return: any but 0 for a polynomial, any but whole turns 2πn for sine-Gordon.
  void check(int least_sites) const;
};

/// The equation that scenes name as a theory: wave, klein-gordon, sine-gordon, phi4; nothing for another.
std::optional<WaveEquation> wave_equation(std::string_view theory, double mass, double lambda, double length,
                                          double monodromy, int sites);

}  // namespace delf::peers
