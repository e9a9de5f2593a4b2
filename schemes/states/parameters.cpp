// SPDX-License-Identifier: MIT
#include "schemes/states/parameters.hpp"

#include <cmath>
#include <cstdio>

#include "lattice/error.hpp"

namespace delf::initial {

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.10g", x);
  return buffer;
}

double finite(const std::string& key, const std::optional<double>& given, double fallback) {
  const double x = given.value_or(fallback);
  if (!std::isfinite(x)) throw BadInput(key, key + " = " + text(x) + ": not a finite number; choose a finite one");
  return x;
}

double positive(const std::string& key, const std::optional<double>& given, double fallback) {
  const double x = finite(key, given, fallback);
  if (!(x > 0)) throw BadInput(key, key + " = " + text(x) + ": must be positive; choose " + key + " > 0");
  return x;
}

double subluminal(const StateRequest& request, double fallback, const std::string& what) {
  const double v = finite("initial.speed", request.speed, fallback);
  if (!(std::abs(v) < 1))
    throw BadInput("initial.speed",
                   "initial.speed = " + text(v) + ": a " + what + " must be slower than light; choose |speed| < 1");
  return v;
}

double centre(const StateRequest& request, const Lattice& lattice) {
  return finite("initial.position", request.position, lattice.length() / 2);
}

double pulse_mass(const StateRequest& request) {
  if (!(request.mass > 0) || !std::isfinite(request.mass))
    throw BadInput("theory.mass", "theory.mass = " + text(request.mass) + ": the state " + request.name +
                                      " has the width 1/mass; choose a finite mass > 0");
  return request.mass;
}

double lorentz_factor(double v) { return 1 / std::sqrt((1 - v) * (1 + v)); }

}  // namespace delf::initial
