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
  return lattice_.left() == Wall::fixed ? boost::math::sin_pi(turns) : boost::math::cos_pi(turns);
}

int Modes::most() const {
  if (lattice_.is_circle()) return lattice_.sites() / 2;
  const bool both_fixed = lattice_.left() == Wall::fixed && lattice_.right() == Wall::fixed;
  return both_fixed ? lattice_.sites() - 2 : lattice_.sites() - 1;
}

int Modes::least() const {
  if (lattice_.is_circle()) return -most();
  return lattice_.left() == Wall::natural && lattice_.right() == Wall::natural ? 0 : 1;
}

int Modes::read(const StateRequest& request, int fallback) const {
  const std::string key = "initial.wavenumber";
  const double n = finite(key, request.wavenumber, fallback);
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

double squared_mass(const StateRequest& request) {
  const double m = finite("theory.mass", request.mass, 1);
  if (request.theory == "wave") return 0;
  if (request.theory != "double-sine-gordon") return m * m;
  // N = m²(cos φ − 1) + (λ/2)(cos 2φ − 1),   −N″(0) = m² + 2λ
  const double l = finite("theory.lambda", request.lambda, 1), squared = m * m + 2 * l;
  if (squared < 0)
    throw BadInput("theory.lambda",
                   "theory.lambda = " + text(l) + ": waves around phi = 0 grow; choose lambda >= " + text(-m * m / 2));
  return squared;
}

bool is_linear(const StateRequest& request) { return request.theory == "wave" || request.theory == "klein-gordon"; }

double wave_amplitude(const StateRequest& request) {
  return finite("initial.amplitude", request.amplitude, is_linear(request) ? 1.0 : 0.1);
}

}  // namespace delf::initial
