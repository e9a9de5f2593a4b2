// SPDX-License-Identifier: MIT
#include "tools/peers/wave_equation.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace delf::peers {

void WaveEquation::check(int least_sites) const {
  if (!(length > 0)) throw std::invalid_argument("a circle needs a positive length");
  if (sites < least_sites)
    throw std::invalid_argument("this integrator needs at least " + std::to_string(least_sites) + " sites");
  const bool polynomial = potential == Potential::quadratic || potential == Potential::phi4;
  if (polynomial && turn != 0) throw std::invalid_argument("a field with a polynomial potential cannot turn");
  const double turns = turn / (2 * std::numbers::pi);
  if (potential == Potential::sine_gordon && !(std::abs(turns - std::round(turns)) < 1e-9))
    throw std::invalid_argument("a sine-Gordon field turns by multiples of 2 pi");
}

std::optional<WaveEquation> wave_equation(std::string_view theory, double mass, double lambda, double length,
                                          double turn, int sites) {
  using enum WaveEquation::Potential;
  if (theory == "wave") return WaveEquation{none, mass, lambda, length, turn, sites};
  if (theory == "klein-gordon") return WaveEquation{quadratic, mass, lambda, length, turn, sites};
  if (theory == "sine-gordon") return WaveEquation{sine_gordon, mass, lambda, length, turn, sites};
  if (theory == "phi4") return WaveEquation{phi4, mass, lambda, length, turn, sites};
  return std::nullopt;
}

}  // namespace delf::peers
