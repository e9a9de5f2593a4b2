// SPDX-License-Identifier: MIT
#include "schemes/states/parameters.hpp"

#include <cmath>
#include <cstdio>

#include "lattice/error.hpp"

namespace delf::initial {

Parameter position_parameter() {
  return {"initial.position", 0.0, "x0: centre of the pulse, or of the pair", "length", {}, {}, "L/2"};
}
Parameter speed_parameter(double fallback) { return {"initial.speed", fallback, "v, |v| < 1", "length/time"}; }
Parameter separation_parameter() {
  return {"initial.separation", 0.0, "d: distance between the two pulses of a pair", "length"};
}
Parameter frequency_parameter() {
  return {"initial.frequency", 0.0, "omega: frequency of a breather", "1/time", {}, {}, "0.6 m"};
}
Parameter wavenumber_parameter(int fallback) {
  return {"initial.wavenumber", static_cast<double>(fallback), "n: how many waves go into L"};
}
Parameter amplitude_parameter(double fallback) {
  return {"initial.amplitude", fallback, "A: size of a wave, or of the noise"};
}
Parameter epsilon_parameter() { return {"initial.epsilon", 1e-6, "1 - the modulus of the elliptic functions"}; }
Parameter width_parameter() {
  return {"initial.width", 0.0, "w: width of a pulse", "length", {0, Limits{}.high, true}, {}, "L/20"};
}

std::string text(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.10g", x);
  return buffer;
}

double subluminal(const StateBuild& build, const std::string& what) {
  const double v = build.number("initial.speed");
  if (!(std::abs(v) < 1))
    throw BadInput("initial.speed",
                   "initial.speed = " + text(v) + ": a " + what + " must be slower than light; choose |speed| < 1");
  return v;
}

double centre(const StateBuild& build) {
  const double L = build.lattice.length(), x0 = build.number("initial.position", L / 2);
  if (!build.lattice.is_circle() || (x0 >= 0 && x0 < L)) return x0;
  const double once = std::fmod(x0, L);  // the same place of the circle
  return once < 0 ? once + L : once;
}

double pulse_mass(const StateBuild& build) {
  const double m = build.mass();
  if (!(m > 0))
    throw BadInput("theory.mass", "theory.mass = " + text(m) + ": the state " + build.request.name +
                                      " has the width 1/mass; choose a finite mass > 0");
  return m;
}

double lorentz_factor(double v) { return 1 / std::sqrt((1 - v) * (1 + v)); }

}  // namespace delf::initial
