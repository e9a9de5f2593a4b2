// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

namespace {

// The summary of a scheme: the range of its costs, without small circles (which do not fill the lanes) and rows far
// beyond every cache.
constexpr int least_compared = 255, most_compared = 1'000'000;

struct Measured {
  Spread times;  ///< ns for each step
  int sites, iterations;
};
Measured measured(const std::string& scheme, int sites, double tolerance, int repeats) {
  const Collision collision{scheme, suited_sites(scheme, sites), tolerance};
  const auto simulation = engine(collision);
  const Spread times = alone(side_of(simulation, collision), repeats);
  return {times, collision.sites, simulation->iterations()};
}

/// The fixed overhead of a step: where the line of least squares through rows of 127, 191, 255 and 319 sites meets
/// N = 0. They hold two, three, four and five standing waves, with the steps in space and time of the collision at
/// N = 255, so that a site costs the same in all of them: shorter rows of the collision itself take a predictor from
/// more rows, or a second iteration.
double fixed_cost(const std::string& scheme, double tolerance, int repeats) {
  const Collision at_255{scheme, 255, tolerance};
  constexpr long steps = 30'000;  // the first of them, which take more iterations, are few against these
  constexpr std::array waves{2, 3, 4, 5};
  double n = 0, t = 0, nn = 0, nt = 0;
  for (const int m : waves) {
    const int sites = scheme == "hexagon" ? 64 * m : 64 * m - 1;
    Problem problem = at_255.problem();
    problem.lattice = Lattice::circle(sites, sites * at_255.space_step());
    std::vector<double> row(sites);
    for (int i = 0; i < sites; ++i) row[i] = std::cos(2 * std::numbers::pi * m * i / sites);
    const Side side = side_of(std::make_shared<Simulation>(problem), std::vector{row, row});
    const double least = alone(side, 16 * repeats, steps).least;
    n += sites, t += least;
    nn += static_cast<double>(sites) * sites, nt += sites * least;
  }
  const double slope = (waves.size() * nt - n * t) / (waves.size() * nn - n * n);
  return (t - slope * n) / waves.size();
}

}  // namespace

void time_sizes(const Request& request) {
  const double tolerance = request.tolerances_or({6e-8}).front();
  fmt::print("The engine: ns per site and step, h = k/8, tolerance {}\n\n", tolerance);
  for (const std::string& scheme : request.schemes_or(textbook_schemes())) {
    const Table table({{scheme, 20}, {"ns", 24}, {"iterations", 10}});
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const int sites : request.sites_or({100, 255, 1000, 4095, 10000, 65536, 100'000, 1'000'000, 10'000'000})) {
      auto [times, found, iterations] = measured(scheme, sites, tolerance, request.repeats);
      for (double* t : {&times.median, &times.least, &times.most}) *t /= found;
      table.row({fmt::to_string(found), in_words(times), fmt::to_string(iterations)});
      if (sites < least_compared || sites > most_compared) continue;
      least = std::min(least, times.median);
      most = std::max(most, times.median);
    }
    if (most > 0)
      table.row({fmt::format("most/least, {} … {}", least_compared, most_compared), number(most / least), ""});
    table.row({"ns a step, N → 0", number(fixed_cost(scheme, tolerance, request.repeats)), ""});
    fmt::print("\n");
  }
}

}  // namespace delf::bench
