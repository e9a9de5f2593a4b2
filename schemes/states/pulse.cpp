// SPDX-License-Identifier: MIT
#include "schemes/states/pulse.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "schemes/states/parameters.hpp"

namespace delf::initial {

Pulse::Pulse(const Lattice& lattice, const StateRequest& request, const PulseFrame& frame)
    : frame_(frame), circle_(lattice.is_circle()), length_(lattice.length()), theory_(request.theory) {
  if (!circle_) frame_.winding = 0;
}

FieldPoint Pulse::on(const Lattice& lattice, double t, int site) const {
  const double L = lattice.length();
  // ξ = x − x₀ − vt,   n = ⌊(ξ + L/2)/L⌋,   s = ξ − nL
  const double xi = lattice.position(site) - frame_.position - frame_.speed * t;
  const double n = lattice.is_circle() ? std::floor((xi + L / 2) / L) : 0.0;
  FieldPoint point = at(t, xi - n * L);
  point.phi += 2 * std::numbers::pi * frame_.winding * n;
  return point;
}

void Pulse::values(double t, const Lattice& lattice, std::span<double> out) const {
  for (int i = 0; i < lattice.sites(); ++i) out[static_cast<std::size_t>(i)] = on(lattice, t, i).phi;
}

void Pulse::velocities(double t, const Lattice& lattice, std::span<double> out) const {
  for (int i = 0; i < lattice.sites(); ++i) out[static_cast<std::size_t>(i)] = on(lattice, t, i).phi_t;
}

std::string Pulse::description() const {
  std::string line = formula();
  if (circle_) {
    // how far the tail is from the vacuum 2πℤ where the circle closes
    const double tail = std::abs(std::remainder(at(0, length_ / 2).phi, 2 * std::numbers::pi));
    if (tail > 1e-8) line += "; off by " + text(tail) + " at the seam";
  }
  if (!exact())
    line += "; not an exact solution of " + theory_ + " here";
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
