// SPDX-License-Identifier: MIT
#include "tools/stability/stability_map.hpp"

#include <cmath>

#include "lattice/error.hpp"
#include "tools/report/interrupt.hpp"

namespace delf {

namespace {

// Masses from 0.1 to 10, evenly in the logarithm.
std::vector<double> masses(int count) {
  std::vector<double> all;
  for (int j = 0; j < count; ++j) all.push_back(std::pow(10, -1 + 2 * (j + 0.5) / count));
  return all;
}

}  // namespace

StabilityMap make_stability_map(const NamedScheme& scheme, double most, std::uint64_t seed) {
  constexpr int columns = 24, rows = 12, fine = 36, odd = 33, steps = 400, samples = 36;
  StabilityMap map;
  map.scheme = scheme.name;
  map.sites = closes_on({scheme.problem, 1}, odd) ? odd : odd - 1;
  for (int i = 0; i < columns; ++i) map.courants.push_back(most * (i + 0.5) / columns);
  map.mass_steps = masses(rows);
  for (const double mass : map.mass_steps)
    for (const double courant : map.courants)
      map.grows.push_back(
          Interrupt::asked()
              ? Growth::refused
              : observe_growth(LinearWaves{scheme.problem, mass}.on_circle(courant, map.sites), steps, seed).kind);
  for (const double mass : masses(fine)) {
    if (Interrupt::asked()) break;
    map.edge_masses.push_back(mass);
    auto& ends = map.edges.emplace_back();
    try {
      for (const CourantInterval& i : linear_theory({scheme.problem, mass}, most, samples).stable) {
        if (i.from > 0) ends.push_back(i.from);
        if (i.to < most * (1 - 1e-9)) ends.push_back(i.to);
      }
    } catch (const BadInput&) {  // reported with the limits
    }
  }
  return map;
}

DispersionCurve make_dispersion_curve(const NamedScheme& scheme) {
  const double k = scheme.problem.lattice.space_step();
  return {scheme.name, frequencies(scheme.problem, scheme.problem.time_step / k, mass_of(scheme.problem) * k, 129)};
}

}  // namespace delf
