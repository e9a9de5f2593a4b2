// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/evolution.hpp"
#include "schemes/field_theory.hpp"
#include "schemes/simulation.hpp"
#include "schemes/verify/form_check.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

std::vector<RegionRequest> every_kind() {
  std::vector<RegionRequest> requests;
  for (const RegionKind kind : region_kinds()) requests.push_back({to_string(kind), kind});
  return requests;
}

/// Rows of random values: the form formula is an identity of the linearised equations at any section.
Window random_window(const LatticeSystem& system, int rows, double size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<std::vector<double>> values(static_cast<std::size_t>(rows));
  for (auto& row : values) {
    row.resize(static_cast<std::size_t>(system.lattice().sites() * system.components()));
    for (double& value : row) value = uniform(random);
  }
  return system.window(0, std::move(values), 0);
}

struct Result {
  std::vector<Check> checks;
  std::vector<FormCheck::Point> points;
  double largest() const {
    double most = 0;
    for (const Check& check : checks) most = std::max(most, check.value);
    return most;
  }
};

Result checked_at_random(const Problem& problem, std::uint64_t seed, int moments = 3, double size = 2) {
  const Simulation simulation(problem);
  const LatticeSystem& system = simulation.evolution().system();
  const int rows = FormCheck::rows_wanted(system, simulation.evolution().plan(), every_kind());
  FormCheck check(system, simulation.evolution().plan(), rows, {.regions = every_kind()});
  std::mt19937_64 random(seed);
  for (int m = 0; m < moments; ++m) check.at(random_window(system, rows, size, random), random);
  return {check.checks(), check.points()};
}

std::vector<Lattice> lattices_for(const std::string& stencil) {
  if (stencil == "midpoint" || stencil == "trapezoidal" || stencil == "vertex") return {Lattice::point()};
  if (stencil == "hexagon" || stencil == "six-tuple" || stencil == "nine-tuple") return {Lattice::circle(32, 20)};
  return {Lattice::circle(31, 20), Lattice::interval(32, 20), Lattice::interval(32, 20, Wall::natural, Wall::natural)};
}

}  // namespace

TEST_CASE("verify: every stencil with every theory keeps the form formula on every kind of region, at random sections") {
  for (const TheoryInfo& theory : theories())
    for (const NamedFormula& stencil : stencils())
      for (const Lattice& lattice : lattices_for(stencil.name)) {
        Problem p;
        p.theory = theory.name, p.stencil = stencil.name, p.lattice = lattice;
        p.time_step = 0.4 * lattice.space_step();
        Result result;
        try {
          result = checked_at_random(p, 5);
        } catch (const BadInput& bad) {
          WARN(theory.name << " " << stencil.name << ": " << bad.what());
          continue;
        }
        for (const Check& check : result.checks) {
          CAPTURE(theory.name, stencil.name, static_cast<int>(lattice.space()), check.name, check.region, check.failure);
          CHECK(check.value <= 1e-13);
        }
      }
}
