// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

namespace {

// What is said of a scheme in the end: how far apart its costs are, small circles (which do not fill the lanes) and
// rows far beyond every cache set aside.
constexpr int least_compared = 255, most_compared = 1'000'000;

}  // namespace

void time_sizes(const Request& request) {
  const double tolerance = request.tolerances_or({6e-8}).front();
  fmt::print("The engine: ns per site and step, h = k/8, tolerance {}\n\n", tolerance);
  for (const std::string& scheme : request.schemes_or(textbook_schemes())) {
    const Table table({{scheme, 20}, {"ns", 24}, {"iterations", 10}});
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const int sites : request.sites_or({100, 255, 1000, 4095, 10000, 65536, 100'000, 1'000'000, 10'000'000})) {
      const Collision collision{scheme, suited_sites(scheme, sites), tolerance};
      const auto simulation = engine(collision);
      Spread times = alone(side_of(simulation, collision), request.repeats);
      for (double* t : {&times.median, &times.least, &times.most}) *t /= collision.sites;
      table.row({fmt::to_string(collision.sites), in_words(times), fmt::to_string(simulation->iterations())});
      if (sites < least_compared || sites > most_compared) continue;
      least = std::min(least, times.median);
      most = std::max(most, times.median);
    }
    if (most > 0)
      table.row({fmt::format("most/least, {} … {}", least_compared, most_compared), number(most / least), ""});
    fmt::print("\n");
  }
}

}  // namespace delf::bench
