// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "tools/bench/by_hand/leapfrog_by_hand.hpp"
#include "tools/bench/commands.hpp"
#include "tools/bench/machine_limits.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/table.hpp"
#include "tools/bench/textbook/textbook_autovectorised.hpp"

namespace delf::bench {

namespace {

struct AutovectorisedLeapfrog {
  double squared_ratio, squared_step;
  std::vector<double> newest = {}, older = {};

  void start(const std::vector<double>& row0, const std::vector<double>& row1) { older = row0, newest = row1; }
  void step() {
    autovectorised_step(newest.data(), older.data(), static_cast<int>(newest.size()), squared_ratio, squared_step);
    newest.swap(older);
  }
};

// The explicit scheme, compared with the loop written by hand.
void compare_loops(const std::vector<int>& all_sites, int repeats) {
  fmt::print("leapfrog, ns per site and step, over the least loop written by hand:\n\n");
  const Table table({{"loop", 20}, {"N", 8}, {"by hand", 8}, {"this", 8}, {"ratio", 24}});
  for (const int sites : all_sites) {
    const Collision collision{"triangle-vertex", sites};
    const double h = collision.time_step(), k = collision.space_step();
    const Side by_hand = side_of(std::make_shared<LeapfrogByHand>(collision.lattice(), h), collision);
    const auto row = [&](const char* name, const Side& side) {
      const Pairing times = pair(side, by_hand, repeats);
      table.row({name, fmt::to_string(sites), number(times.b / sites), number(times.a / sites), in_words(times.ratio)});
    };
    row("engine", engine_side(collision));
    row("auto-vectorised",
        side_of(std::make_shared<AutovectorisedLeapfrog>(AutovectorisedLeapfrog{h * h / (k * k), h * h}), collision));
    row("textbook", textbook_side(collision));
  }
  fmt::print("\n");
}

/// The sines that a site takes in one evaluation of the nonlinear part; half as many where there is a brick to every
/// second site. A quotient's sinc is counted as its series, without a sine.
double sines_of(const std::string& scheme) { return scheme == "hexagon" ? 0.5 : 1; }

void compare_with_floor(const Request& request, const std::vector<int>& all_sites, double sine) {
  const double tolerance = request.tolerances_or({6e-8}).front();
  fmt::print(
      "the engine over a floor: iterations × sines × {} ns, and y and its increment read and written once; h = k/8,\n"
      "tolerance {:.0e}; ns per site and step\n\n",
      number(sine), tolerance);
  const Table table({{"scheme", 20},
                     {"N", 8},
                     {"iterations", 10},
                     {"sines", 6},
                     {"traffic", 8},
                     {"floor", 8},
                     {"engine", 8},
                     {"ratio", 24}});
  for (const int sites : all_sites) {
    const double traffic = time_traffic(sites, request.repeats);
    for (const std::string& scheme : request.schemes_or(textbook_schemes())) {
      const Collision collision{scheme, suited_sites(scheme, sites), tolerance};
      const auto simulation = engine(collision);
      Spread times = alone(side_of(simulation, collision), request.repeats);
      const int iterations = std::max(1, simulation->iterations());
      const double sines = iterations * sines_of(scheme), floor = sines * sine + traffic;
      const double engine_ns = times.median / collision.sites;
      for (double* t : {&times.median, &times.least, &times.most}) *t /= collision.sites * floor;
      table.row({scheme, fmt::to_string(collision.sites), fmt::to_string(iterations), fmt::format("{:g}", sines),
                 number(traffic), number(floor), number(engine_ns), in_words(times)});
    }
  }
}

}  // namespace

void time_limit(const Request& request) {
  const auto sites = request.sites_or({255, 4095, 1'000'000});
  const Sines sines = time_sines(request.repeats);
  fmt::print("a sine, of 4096 values in cache: packs {} ns, library {} ns, auto-vectorised {} ns\n",
             number(sines.packs), number(sines.library), number(sines.autovectorised));
  for (const int N : sites) {
    const double ns = time_traffic(N, request.repeats);
    fmt::print("memory, two rows of {} read and written: {} ns per site, {:.0f} GB/s\n", N, number(ns), 32 / ns);
  }
  fmt::print("\n");
  compare_loops(sites, request.repeats);
  compare_with_floor(request, sites, sines.packs);
}

}  // namespace delf::bench
