// SPDX-License-Identifier: MIT
#pragma once
#include <complex>
#include <string>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/stability/symbol.hpp"

namespace delf {

/// A spurious wave that grows like a power of time although its amplification factor is 1: a multiple root on the
/// unit circle with fewer independent modes than its multiplicity.
struct Ghost {
  double theta;            ///< of y_ij = zʲ e^{iθi}
  std::complex<double> z;  ///< on the unit circle
  int multiplicity, modes;
  bool everywhere = false;  ///< one of its kind at every wave number
  std::string
      words;  ///< "theta = pi (even N only), z = -1: double root with one mode, (-1)^(i+j) (a + b j), grows linearly"
};

struct StabilityVerdict {
  bool stable;  ///< no root lies outside the unit circle, for any wave number
  /// max |z|, 1 for roots on the circle to round-off; infinite: a step has no solution.
  double amplification;
  double worst_theta;  ///< where that is, 0 … π
  std::vector<Ghost> ghosts;
  bool drift = false;  ///< y = a + b j solves the equations, as it does those of the massless field: no ghost

  /// Nothing grows, not even linearly.
  bool bounded() const { return stable && ghosts.empty(); }
};

/// von Neumann's analysis of a scheme about a constant state, over all wave numbers: `wave_numbers` of them between 0
/// and π, both included, and between them wherever two roots on the circle come nearest to one another, since
/// a pair of roots leaves the circle there. Walls, and the wave numbers of a circle of N sites, play no part. Throws as
/// Symbol. Where four and more roots meet at one point of the circle, rounding separates them by more than its square
/// root, and a stable scheme may be called unstable: for example the massless element (4, 4) with Gauss, where h = k
/// to nine digits.
StabilityVerdict linear_stability(const Symbol&, int wave_numbers = 201);
StabilityVerdict linear_stability(const LatticeSystem&, double constant = 0, int wave_numbers = 201);

}  // namespace delf
