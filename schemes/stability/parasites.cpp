// SPDX-License-Identifier: MIT
#include "schemes/stability/parasites.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace delf {
namespace {

// Roots near a corner lie as near to it as θ does; those of a double root as √θ.
int roots_near(const Symbol& symbol, double theta, double z) {
  constexpr double near = 1e-2;
  return static_cast<int>(
      std::ranges::count_if(symbol.roots(theta), [&](Symbol::Complex root) { return std::abs(root - z) < near; }));
}

}  // namespace

std::vector<Parasite> parasites(const Symbol& symbol) {
  constexpr double aside = 1e-5;  // at θ = 0 itself equations may say nothing: a constant is no field of potential KdV
  struct Corner {
    const char* wave;
    double theta, z;
  };
  std::vector<Parasite> found;
  for (const Corner& corner :
       {Corner{"(-1)^j", 0, -1}, Corner{"(-1)^i", std::numbers::pi, 1}, Corner{"(-1)^(i+j)", std::numbers::pi, -1}}) {
    const bool point = symbol.zone() == 0;
    if (symbol.brick() || (point && corner.theta > 0)) continue;
    const double theta = point ? 0 : corner.theta > 0 ? corner.theta - aside : aside;
    if (const int roots = roots_near(symbol, theta, corner.z); roots > 0) found.push_back({corner.wave, roots});
  }
  return found;
}

}  // namespace delf
