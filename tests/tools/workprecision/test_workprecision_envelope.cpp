// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/compare/solution_error.hpp"
#include "tools/scene/lists.hpp"
#include "tools/workprecision/lower_envelope.hpp"
#include "tools/workprecision/resolution_search.hpp"
#include "tools/workprecision/timed_rounds.hpp"

using namespace delf;
using testing::Folder;

namespace {

WorkPrecisionRun run(const char* scheme, double error, double seconds, bool peer = false) {
  WorkPrecisionRun r;
  r.scheme = scheme, r.error_linf = error, r.seconds = seconds, r.peer = peer;
  return r;
}

std::vector<std::size_t> all_of(const std::vector<WorkPrecisionRun>& runs) {
  std::vector<std::size_t> all(runs.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> envelope_of(const std::vector<WorkPrecisionRun>& runs) {
  return lower_envelope(runs, all_of(runs));
}

// By the definition: no other run is at least as good in both and better in one.
bool is_envelope(const std::vector<WorkPrecisionRun>& runs, const std::vector<std::size_t>& front) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!std::isfinite(runs[i].error_linf) || !std::isfinite(runs[i].seconds)) continue;
    bool beaten = false;
    for (const WorkPrecisionRun& other : runs)
      beaten = beaten || (other.error_linf <= runs[i].error_linf && other.seconds <= runs[i].seconds &&
                          (other.error_linf < runs[i].error_linf || other.seconds < runs[i].seconds));
    if (beaten) continue;
    if (found == front.size() || front[found++] >= runs.size()) return false;
    if (std::find(front.begin(), front.end(), i) == front.end()) return false;
  }
  return found == front.size();
}

}  // namespace

TEST_CASE("the lower envelope has the runs that no other beats, from cheap to accurate") {
  std::vector<WorkPrecisionRun> runs{run("a", 1e-2, 1), run("a", 1e-3, 2),           run("b", 2e-2, 0.5),
                                     run("b", 5e-3, 4), run("c", std::nan(""), 0.1), run("c", 1e-3, 3)};
  const auto front = envelope_of(runs);
  CHECK(front == std::vector<std::size_t>{2, 0, 1});
  CHECK(is_envelope(runs, front));
  // planted mistakes are found
  CHECK_FALSE(is_envelope(runs, {2, 0}));
  CHECK_FALSE(is_envelope(runs, {2, 0, 1, 3}));
  CHECK_FALSE(is_envelope(runs, {2, 0, 5}));

  std::vector<WorkPrecisionRun> many;
  for (int i = 0; i < 200; ++i)
    many.push_back(run("x", std::abs(std::sin(12.9898 * i)) + 1e-9, std::abs(std::cos(78.233 * i * i)) + 1e-9));
  CHECK(is_envelope(many, envelope_of(many)));
  auto spoiled = envelope_of(many);
  spoiled[0] = spoiled[0] == 0 ? 1 : 0;
  CHECK_FALSE(is_envelope(many, spoiled));
}

TEST_CASE("schemes that are told of the solution, and processed peers, have columns of their own") {
  WorkPrecisionOutcome outcome;
  outcome.runs = {run("a", 1e-3, 4), run("suited", 1e-3, 2), run("p", 1e-3, 12, true), run("processed", 1e-3, 8, true)};
  outcome.runs[1].tuned = true, outcome.runs[3].processed = true;
  compare(outcome, {1e-2});
  const WorkPrecisionCost& cost = outcome.costs[0];
  CHECK(cost.engine == std::size_t{0});  // not the cheaper one that is told
  CHECK(cost.peer == std::size_t{2});
  CHECK(cost.tuned == std::size_t{1});
  CHECK(cost.processed_peer == std::size_t{3});
  CHECK(cost.ratio == 3);
  CHECK(cost.tuned_ratio == 6);
  CHECK(cost.processed_ratio == 2);
}

TEST_CASE("an accuracy costs what the cheapest run costs that reaches it, and nothing is interpolated") {
  WorkPrecisionOutcome outcome;
  outcome.runs = {run("a", 1e-2, 1), run("a", 1e-4, 4), run("b", 1e-3, 3), run("p", 1e-3, 30, true),
                  run("q", 5e-3, 6, true)};
  compare(outcome, {1e-2, 2e-3, 1e-5});
  REQUIRE(outcome.costs.size() == 3);
  CHECK(outcome.costs[0].engine == std::size_t{0});
  CHECK(outcome.costs[0].peer == std::size_t{4});
  CHECK(outcome.costs[0].ratio == 6);
  CHECK(outcome.costs[1].engine == std::size_t{2});  // not somewhere between the runs of a
  CHECK(outcome.costs[1].ratio == 10);
  CHECK_FALSE(outcome.costs[2].engine);
  CHECK_FALSE(outcome.costs[2].peer);
  CHECK(std::isnan(outcome.costs[2].ratio));
  REQUIRE(outcome.lines.size() == 4);
  CHECK(outcome.lines[0].front == std::vector<std::size_t>{0, 1});
  // engine and peers have an envelope each
  CHECK(outcome.runs[2].on_envelope);
  CHECK(outcome.runs[3].on_envelope);
  CHECK(outcome.runs[4].on_envelope);
}

TEST_CASE("the slope is that of the asymptotic runs, without the floor") {
  std::vector<WorkPrecisionRun> runs{run("a", 0.9, 0.1)};
  for (int i = 0; i < 6; ++i) runs.push_back(run("a", 0.1 * std::pow(4, -2 * i), std::pow(4, i)));
  CHECK(std::abs(slope_of(runs, all_of(runs)) + 2) < 1e-12);
  runs.push_back(run("a", 0.99 * runs.back().error_linf, 4 * runs.back().seconds));
  CHECK(std::abs(slope_of(runs, all_of(runs)) + 2) < 1e-12);
  CHECK(std::isnan(slope_of(runs, std::vector<std::size_t>{0})));
}

TEST_CASE("the observed order is that of N at one h/k, whatever else was tried") {
  std::vector<WorkPrecisionRun> runs;
  const auto add = [&](int sites, double courant, double error) {
    WorkPrecisionRun r = run("a", error, 1);
    r.sites = sites, r.space_step = 40.0 / sites, r.time_step = courant * r.space_step;
    r.steps = std::lround(8 / r.time_step);
    runs.push_back(r);
  };
  for (int N : {64, 128, 256, 512}) add(N, 0.5, 1e3 * std::pow(N, -4));
  add(256, 0.25, 1e-7), add(512, 0.125, 1e-9), add(512, 0.5, 1e3 * std::pow(512, -4));  // of other h/k, and twice
  CHECK(std::abs(order_of(runs, all_of(runs)) - 4) < 1e-12);
  add(1024, 0.5, 0.99 * 1e3 * std::pow(512, -4));  // its floor
  CHECK(std::abs(order_of(runs, all_of(runs)) - 4) < 1e-12);
  CHECK(std::isnan(order_of(runs, std::vector<std::size_t>{0, 4})));  // h/k differ: no order in N
  // on a point over steps
  runs.clear();
  for (int steps : {100, 200, 400}) {
    WorkPrecisionRun r = run("p", std::pow(steps, -2.0), 1);
    r.sites = 1, r.time_step = 8.0 / steps, r.steps = steps;
    runs.push_back(r);
  }
  CHECK(std::abs(order_of(runs, all_of(runs)) - 2) < 1e-12);
}

TEST_CASE("repeats are shared so that the longest runs have the fewest, and each has one") {
  CHECK(shared_repeats({1, 1, 1}, 5, 100) == std::vector<int>{5, 5, 5});
  const std::vector<double> costs{0.01, 0.1, 1, 10};
  const auto n = shared_repeats(costs, 5, 15);
  CHECK(n == std::vector<int>{5, 5, 4, 1});
  CHECK(shared_repeats(costs, 5, 0.1) == std::vector<int>{1, 1, 1, 1});
  CHECK(shared_repeats({}, 5, 1).empty());
}

TEST_CASE("an entry is there while it runs alone, whatever the grid") {
  static int alive = 0, most = 0, built = 0;
  struct Counted final : StartedEntry {
    std::int64_t row = 0;
    Counted() { ++built, most = std::max(most, ++alive); }
    ~Counted() override { --alive; }
    std::int64_t newest() const override { return row; }
    void advance(std::int64_t steps, const RunLimit&) override { row += steps; }
    void copy(std::span<double> out) const override { std::ranges::fill(out, 0.0); }
    double energy() const override { return 1; }
    double forces() const override { return 1; }
  };
  const Folder folder;
  const Scene scene = read_scene(folder.write("kink.ini",
                                              "[theory]\nname = sine-gordon\n[lattice]\nlength = 40\nsites = 64\n"
                                              "courant = 0.5\n[initial]\nstate = kink\n[run]\nuntil = 4\n"),
                                 {});
  const std::vector<WorkPrecisionEntry> entries(
      3, {.name = "counted", .start = [](const Resolution&) { return std::make_unique<Counted>(); }});
  WorkPrecisionRequest request;
  request.sites = {64, 96, 128}, request.courants = {0.25, 0.5}, request.until = 4;
  const auto none = [] {};
  const auto until = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const ComparedSolution solution = ComparedSolution::exact(scene, request.until);
  ResolutionSearch search(scene, request, entries, solution);
  search.run(until, none);
  CHECK(built == 18);
  std::vector<TriedRun> runs = search.worth_timing();
  REQUIRE(runs.size() == 18);
  CHECK(alive == 0);
  time_in_turn(runs, entries, std::vector<int>(18, 2), 1, StepClock(1), until, none);
  CHECK(built == 3 * 18);
  CHECK(runs.front().result.repeats == 2);
  CHECK(most == 1);
}

TEST_CASE("names are apart at commas outside parentheses") {
  CHECK(names_in("triangle, spacetime (2,2) gauss ,, hexagon") ==
        std::vector<std::string>{"triangle", "spacetime (2,2) gauss", "hexagon"});
  CHECK(names_in(" ").empty());
}

TEST_CASE("a row of a finer lattice is read off between its sites, around the circle and its winding") {
  constexpr double L = 10, monodromy = 2 * std::numbers::pi;
  const auto f = [&](double x) { return monodromy * x / L + std::sin(2 * std::numbers::pi * x / L); };
  const Lattice fine = Lattice::circle(200, L);
  std::vector<double> row;
  for (int i = 0; i < 200; ++i) row.push_back(f(fine.position(i)));
  const auto solution = ComparedSolution::reference(fine, 1, monodromy, row);
  for (const int sites : {7, 50, 64, 333}) {
    const Lattice lattice = Lattice::circle(sites, L);
    std::vector<double> there;
    for (int i = 0; i < sites; ++i) there.push_back(f(lattice.position(i)));
    CHECK(field_error(solution.at(lattice, 0), there, 1).linf < 1e-12);
  }
  // without the winding it is found out
  const auto wrong = ComparedSolution::reference(fine, 1, 0, row);
  const Lattice lattice = Lattice::circle(333, L);
  CHECK(field_error(wrong.at(lattice, 0), solution.at(lattice, 0), 1).linf > 1e-3);

  const Lattice walls = Lattice::interval(101, L), between = Lattice::interval(64, L);
  row.clear();
  std::vector<double> there;
  for (int i = 0; i < 101; ++i) row.push_back(f(walls.position(i)));
  for (int i = 0; i < 64; ++i) there.push_back(f(between.position(i)));
  CHECK(field_error(ComparedSolution::reference(walls, 1, 0, row).at(between, 0), there, 1).linf < 1e-10);
}

TEST_CASE("the centre of a kink is found anywhere on the circle, and a flat field has none") {
  const Lattice lattice = Lattice::circle(400, 40);
  const double monodromy = 2 * std::numbers::pi;
  for (const double x0 : {3.0, 20.0, 37.5, 39.9}) {
    std::vector<double> kink;
    for (int i = 0; i < 400; ++i) {
      const double s = lattice.position(i) - x0, n = std::floor((s + 20) / 40);
      kink.push_back(4 * std::atan(std::exp(s - 40 * n)) + monodromy * n);
    }
    CHECK(std::abs(separation(lattice, gradient_centre(lattice, kink, 1, monodromy), x0)) < 1e-6);
  }
  CHECK(std::isnan(gradient_centre(lattice, std::vector<double>(400, 1.0), 1, 0)));
  CHECK(std::abs(separation(lattice, 39.5, 0.5) + 1) < 1e-12);
}

TEST_CASE("errors are the largest, and the root of k times the sum of squares") {
  const std::vector<double> field{1, 2, 3}, solution{1, 1, 5};
  const FieldError error = field_error(field, solution, 0.5);
  CHECK(error.linf == 2);
  CHECK(std::abs(error.l2 - std::sqrt(0.5 * 5)) < 1e-15);
  CHECK(std::isnan(field_error(std::vector<double>{std::nan("")}, std::vector<double>{0}, 1).linf));
}
