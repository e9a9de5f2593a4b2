// SPDX-License-Identifier: MIT
#include "tools/peers/wave_equation.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace delf::peers {

void WaveEquation::check(int least_sites) const {
  if (!(length > 0)) throw std::invalid_argument("a circle needs a positive length");
  if (sites < least_sites)
    throw std::invalid_argument("this integrator needs at least " + std::to_string(least_sites) + " sites");
  const bool polynomial = potential == Potential::quadratic || potential == Potential::phi4;
  if (polynomial && monodromy != 0) throw std::invalid_argument("a field with a polynomial potential cannot wind");
  const double turns = monodromy / (2 * std::numbers::pi);
  if (potential == Potential::sine_gordon && !(std::abs(turns - std::round(turns)) < 1e-9))
    throw std::invalid_argument("a sine-Gordon field winds by multiples of 2 pi");
}

std::optional<WaveEquation> wave_equation(std::string_view theory, double mass, double lambda, double length,
                                          double monodromy, int sites) {
  using enum WaveEquation::Potential;
  static constexpr std::pair<std::string_view, WaveEquation::Potential> known[] = {
      {"wave", none}, {"klein-gordon", quadratic}, {"sine-gordon", sine_gordon}, {"phi4", phi4}};
  for (const auto& [name, potential] : known)
    if (theory == name) return WaveEquation{potential, mass, lambda, length, monodromy, sites};
  return std::nullopt;
}

}  // namespace delf::peers
