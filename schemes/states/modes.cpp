// SPDX-License-Identifier: MIT
#include "schemes/states/modes.hpp"

#include <boost/math/special_functions/cos_pi.hpp>
#include <boost/math/special_functions/sin_pi.hpp>
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {

Modes::Modes(const Lattice& lattice) : lattice_(lattice) {}

double Modes::half_waves(double n) const {
  if (lattice_.is_circle()) return 2 * n;
  return lattice_.left() == lattice_.right() ? n : n - 0.5;
}

double Modes::wavenumber(double n) const { return half_waves(n) * std::numbers::pi / lattice_.length(); }

double Modes::standing(double n, double x) const {
  const double turns = half_waves(n) * (x / lattice_.length());
  return lattice_.left() != Wall::natural ? boost::math::sin_pi(turns) : boost::math::cos_pi(turns);
}

double Modes::standing_slope(double n, double x) const {
  const double turns = half_waves(n) * (x / lattice_.length());
  return wavenumber(n) * (lattice_.left() != Wall::natural ? boost::math::cos_pi(turns) : -boost::math::sin_pi(turns));
}

int Modes::most() const {
  if (lattice_.is_circle()) return lattice_.sites() / 2;
  const bool both_fixed = lattice_.left() != Wall::natural && lattice_.right() != Wall::natural;
  return both_fixed ? lattice_.sites() - 2 : lattice_.sites() - 1;
}

int Modes::least() const {
  if (lattice_.is_circle()) return -most();
  return lattice_.left() == Wall::natural && lattice_.right() == Wall::natural ? 0 : 1;
}

int Modes::read(const StateBuild& build, int otherwise) const {
  const std::string key = "initial.wavenumber";
  const double n = build.number(key, otherwise);
  if (n != std::round(n))
    throw BadInput(key, key + " = " + text(n) + ": it counts the waves that fit on the lattice; choose an integer");
  if (std::abs(n) > most())
    throw BadInput(key, key + " = " + text(n) + ": " + std::to_string(lattice_.sites()) + " sites resolve at most " +
                            std::to_string(most()) + "; raise lattice.sites");
  if (n < least())
    throw BadInput(key, key + " = " + text(n) + ": the walls allow the modes " + std::to_string(least()) + ", " +
                            std::to_string(least() + 1) + ", ...; choose one of them");
  return static_cast<int>(n);
}

double squared_mass(const StateBuild& build) {
  const double m = build.mass();
  if (build.request.theory == "wave") return 0;
  if (build.request.theory != "double-sine-gordon") return m * m;
  // N = m²(cos φ − 1) + (λ/2)(cos 2φ − 1),   −N″(0) = m² + 2λ
  const double l = build.lambda(), squared = m * m + 2 * l;
  if (squared < 0)
    throw BadInput("theory.lambda",
                   "theory.lambda = " + text(l) + ": waves around phi = 0 grow; choose lambda >= " + text(-m * m / 2));
  return squared;
}

Parameter wave_amplitude_parameter() {
  Parameter p = amplitude_parameter(1);
  p.otherwise = "1 if the theory is linear, else 0.1";
  return p;
}

double wave_amplitude(const StateBuild& build) { return build.number("initial.amplitude", build.exact ? 1.0 : 0.1); }

Parameter packet_wavenumber_parameter() {
  Parameter p = wavenumber_parameter(8);
  p.otherwise = "8, or as many as the sites resolve";
  return p;
}

}  // namespace delf::initial
