// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <string>

#include "schemes/states/state_registry.hpp"

namespace delf::initial {

/// The place of a pulse, its motion, and the time for which the lattice leaves it as it is.
struct PulseFrame {
  double position, speed;  ///< the centre is at position + speed·t
  int winding;             ///< on a circle: (φ(+∞) − φ(−∞))/2π
  double exact_until;      ///< 0: not a solution
};

/// A solution on the whole line that differs from the vacuum only around its centre. An interval cuts a piece out of
/// the line. A circle carries the nearest image, and counts the turns:
///
///     ξ = x − x₀ − vt,   n = ⌊(ξ + L/2)/L⌋,   s = ξ − nL ∈ [−L/2, L/2),   φ = pulse(t, s) + 2π·winding·n
///
class Pulse : public State {
 public:
  Pulse(const StateBuild&, const PulseFrame&);

  void at(double t, double x, std::span<FieldPoint> out) const final;
  bool exact() const final { return frame_.exact_until > 0; }
  double exact_until() const final { return frame_.exact_until; }
  int winding() const final { return frame_.winding; }
  std::string description() const final;

 protected:
  /// The pulse at time t, at the distance s from its moving centre; φ_t is taken at fixed x = x₀ + vt + s.
  virtual FieldPoint pulse(double t, double s) const = 0;
  /// The value that it tends to far away, modulo 2π.
  virtual double vacuum() const { return 0; }
  /// The formula and its parameters, for description().
  virtual std::string formula() const = 0;

 private:
  PulseFrame frame_;
  bool circle_;
  double length_;
  std::string theory_;
};

/// The distance at which a tail C·e^{−rate·s} has sunk to 1e-2, or 0 if it was never higher.
double reach(double C, double rate);

/// Until when a pulse of this reach, moving at one speed, stays clear of the walls; for ever on a circle that it fits.
double clear_until(const Lattice&, double position, double speed, double reach);

}  // namespace delf::initial
