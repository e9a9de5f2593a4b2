// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "lattice/lattice.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf::initial {

/// The map from initial.wavenumber n to a wave that the lattice allows. A circle has q = 2πn/L; an interval has the
/// standing modes of its walls (fixed: a node; natural: a crest):
///
///     fixed–fixed      sin nπx/L          natural–natural    cos nπx/L
///     fixed–natural    sin (n−½)πx/L      natural–fixed      cos (n−½)πx/L
///
class Modes {
 public:
  explicit Modes(const Lattice&);
  /// q_n
  double wavenumber(double n) const;
  /// The standing mode n at x; intervals only.
  double standing(double n, double x) const;
  double standing_slope(double n, double x) const;
  /// The largest |n| that the sites resolve: two of them to a wavelength.
  int most() const;
  /// The least n: 1 where a wall is fixed, else 0.
  int least() const;
  /// initial.wavenumber as an integer that fits; `otherwise` if it is not given. Throws BadInput.
  int read(const StateBuild&, int otherwise = 1) const;

 private:
  double half_waves(double n) const;
  const Lattice lattice_;
};

/// m² in ω² = q² + m² for small waves around φ = 0: −N″(0). Throws BadInput if it is negative.
double squared_mass(const StateBuild&);

// The parameters of plane-wave and wave-packet, which are exact in linear theories.
Parameter wave_amplitude_parameter();
/// initial.amplitude; 1 in a linear theory and 0.1 in others if not given.
double wave_amplitude(const StateBuild&);
/// n of a packet: 8, or as many as the sites resolve.
Parameter packet_wavenumber_parameter();

}  // namespace delf::initial
