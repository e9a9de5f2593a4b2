// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "schemes/stepping/flush_denormals.hpp"
#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

namespace {

/// A simulation whose monitors are evaluated after every step, or could be.
template <class Look>
Side watched(const Collision& collision, Look look) {
  const auto simulation = engine(collision);
  Side side = side_of(simulation, collision);
  side.advance = [simulation, look](long steps) {
    const FlushDenormals for_all_steps;  // as in `delf run`
    for (long n = 0; n < steps; ++n) {
      simulation->step(true);
      look(*simulation);
    }
  };
  return side;
}

}  // namespace

void time_monitors(const Request& request) {
  const double tolerance = request.tolerances_or({6e-8}).front();
  fmt::print("A step(true) with monitors(), or residual(), or both after it, over the step alone\n\n");
  const Table table({{"scheme", 20}, {"N", 8}, {"step, ns", 9}, {"monitors", 24}, {"residual", 24}, {"both", 24}});
  for (const std::string& scheme : request.schemes_or(textbook_schemes()))
    for (const int sites : request.sites_or({255, 4095})) {
      const Collision collision{scheme, suited_sites(scheme, sites), tolerance};
      const Side step = watched(collision, [](const Simulation&) {});
      volatile double seen = 0;  // so that the compiler removes no monitor
      const auto against = [&](auto look) { return pair(watched(collision, look), step, request.repeats); };
      const Pairing monitors = against([&](const Simulation& s) { seen = s.monitors().energy; });
      const Pairing residual = against([&](const Simulation& s) { seen = s.residual(); });
      const Pairing both = against([&](const Simulation& s) { seen = s.monitors().energy + s.residual(); });
      table.row({scheme, fmt::to_string(collision.sites), number(both.b / collision.sites), in_words(monitors.ratio),
                 in_words(residual.ratio), in_words(both.ratio)});
    }
}

}  // namespace delf::bench
