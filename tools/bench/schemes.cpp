// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {

namespace {

/// The engine, which reports the mean number of iterations of its last steps.
Side counting_side(const Collision& collision, double& mean) {
  const auto simulation = engine(collision);
  Side side = side_of(simulation, collision);
  side.advance = [simulation, &mean](long steps) {
    long iterations = 0;
    const FlushDenormals for_all_steps;  // as in `delf run`
    for (long n = 0; n < steps; ++n) {
      simulation->step(false);
      iterations += simulation->iterations();
    }
    mean = static_cast<double>(iterations) / static_cast<double>(steps);
  };
  return side;
}

/// The textbook, which reports the same.
Side counting_textbook_side(const Collision& collision, double& mean) {
  const std::shared_ptr<Textbook> textbook = collision.textbook();
  Side side = side_of(textbook, collision);
  side.advance = [textbook, advance = side.advance, &mean](long steps) {
    const long before = textbook->iterations();
    advance(steps);
    mean = static_cast<double>(textbook->iterations() - before) / static_cast<double>(steps);
  };
  return side;
}

}  // namespace

void time_schemes(const Request& request) {
  fmt::print(
      "The collision, h = k/8; ns per site and step; ratio: textbook/engine, the median of paired repetitions\n\n");
  const Table table(
      {{"scheme", 20}, {"N", 8}, {"tolerance", 9}, {"textbook", 9}, {"engine", 8}, {"ratio", 24}, {"iterations: textbook", 20}, {"engine", 8}});
  for (const std::string& scheme : request.schemes_or(textbook_schemes()))
    for (const int sites : request.sites_or({255, 4095})) {
      for (const double tolerance : request.tolerances_or({6e-8, 1e-13})) {
        const Collision collision{scheme, suited_sites(scheme, sites), tolerance};
        double iterations = 0, of_textbook = 0;
        const Pairing times = pair(counting_textbook_side(collision, of_textbook), counting_side(collision, iterations),
                                   request.repeats);
        const double N = collision.sites;
        const bool iterates = iterations > 0;
        table.row({scheme, fmt::to_string(collision.sites), iterates ? fmt::format("{:.0e}", tolerance) : "-",
                   number(times.a / N), number(times.b / N), in_words(times.ratio),
                   iterates ? number(of_textbook) : "explicit", iterates ? number(iterations) : ""});
        if (!iterates) break;  // no tolerance to vary
      }
    }
}

}  // namespace delf::bench
