// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

void time_threads(const Request& request) {
  const double tolerance = request.tolerances_or({6e-8}).front();
  fmt::print("One thread against two; ns per site and step, wall clock\n\n");
  const Table table({{"scheme", 20}, {"N", 8}, {"one", 8}, {"two", 8}, {"ratio", 24}});
  for (const std::string& scheme : request.schemes_or({"triangle-vertex", "triangle", "rectangle-symmetric"}))
    for (const int sites : request.sites_or({1'000'000})) {
      Collision one{scheme, suited_sites(scheme, sites), tolerance}, two = one;
      two.threads = 2;
      const Pairing times = pair(engine_side(one), engine_side(two), request.repeats);
      table.row({scheme, fmt::to_string(one.sites), number(times.a / one.sites), number(times.b / one.sites),
                 in_words(times.ratio)});
    }
}

}  // namespace delf::bench
