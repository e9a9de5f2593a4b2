// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/schemes/states/state_requests.hpp"

namespace delf::testing {

// Central differences of order 8 at the distances 0 … 4.
inline constexpr double second[]{-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
inline constexpr double first[]{0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};

// The larger magnitude; NaN if either is.
inline double larger(double worst, double error) {
  return std::abs(error) > worst || std::isnan(error) ? std::abs(error) : worst;
}

// max |velocities() − φ_t by differences of values()| over the lattice; sign = −1 plants an error.
inline double velocity_defect(const State& state, const Lattice& lattice, double t, double dt, double sign = 1) {
  std::vector<double> difference(lattice.sites() * state.components());
  for (int m = 1; m <= 4; ++m) {
    const auto later = values(state, t + m * dt, lattice), earlier = values(state, t - m * dt, lattice);
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] += first[m] * (later[i] - earlier[i]) / dt;
  }
  const auto v = velocities(state, t, lattice);
  double worst = 0;
  for (std::size_t i = 0; i < v.size(); ++i) worst = larger(worst, sign * v[i] - difference[i]);
  return worst;
}

}  // namespace delf::testing
