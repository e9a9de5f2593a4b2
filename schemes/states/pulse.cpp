// SPDX-License-Identifier: MIT
#include "schemes/states/pulse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "schemes/states/parameters.hpp"

namespace delf::initial {

Pulse::Pulse(const StateBuild& build, const PulseFrame& frame)
    : frame_(frame),
      circle_(build.lattice.is_circle()),
      length_(build.lattice.length()),
      theory_(build.request.theory) {
  if (!circle_) frame_.winding = 0;
}

void Pulse::at(double t, double x, std::span<FieldPoint> out) const {
  // ξ = x − x₀ − vt,   n = ⌊(ξ + L/2)/L⌋,   s = ξ − nL
  const double xi = x - frame_.position - frame_.speed * t;
  const double n = circle_ ? std::floor((xi + length_ / 2) / length_) : 0.0;
  out[0] = pulse(t, xi - n * length_);
  out[0].phi += 2 * std::numbers::pi * frame_.winding * n;
}

std::string Pulse::description() const {
  std::string line = formula();
  if (circle_) {
    // how far the tail is from the vacuum, modulo 2π, where the circle closes
    const double tail = std::abs(std::remainder(pulse(0, length_ / 2).phi - vacuum(), 2 * std::numbers::pi));
    if (tail > 1e-8) line += "; off by " + text(tail) + " at the seam";
  }
  if (!exact()) line += "; not an exact solution of " + theory_ + " here";
  else if (std::isfinite(frame_.exact_until))
    line += "; exact until t = " + text(frame_.exact_until) + (circle_ ? ", at the seam" : ", at the wall");
  return line;
}

double reach(double C, double rate) { return std::max(0.0, std::log(C / 1e-2) / rate); }

double clear_until(const Lattice& lattice, double position, double speed, double reach) {
  constexpr double forever = std::numeric_limits<double>::infinity();
  const double L = lattice.length();
  if (lattice.is_circle()) return 2 * reach <= L ? forever : 0.0;
  if (position < reach || L - position < reach) return 0;
  if (speed == 0) return forever;
  return speed > 0 ? (L - reach - position) / speed : (position - reach) / -speed;
}

}  // namespace delf::initial
