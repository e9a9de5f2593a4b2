// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

namespace {

// What is said of a scheme in the end: how far apart its costs are, small circles (which do not fill the lanes) and
// rows far beyond every cache set aside.
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

/// What a step costs that sites do not: where the line of least squares through short rows meets N = 0. It says nothing
/// where the shortest of them take more iterations than the others.
double fixed_cost(const std::string& scheme, double tolerance, int repeats) {
  double n = 0, t = 0, nn = 0, nt = 0;
  constexpr std::array rows{63, 127, 191, 255, 383};
  for (const int sites : rows) {
    const Measured m = measured(scheme, sites, tolerance, repeats);
    n += m.sites, t += m.times.least;
    nn += static_cast<double>(m.sites) * m.sites, nt += m.sites * m.times.least;
  }
  const double slope = (rows.size() * nt - n * t) / (rows.size() * nn - n * n);
  return (t - slope * n) / rows.size();
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
    if (request.sites.empty()) table.row({"ns a step, N → 0", number(fixed_cost(scheme, tolerance, request.repeats)), ""});
    fmt::print("\n");
  }
}

}  // namespace delf::bench
