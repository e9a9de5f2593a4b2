// SPDX-License-Identifier: MIT
#include "schemes/complex/spacetime_complex.hpp"

#include <algorithm>
#include <cmath>

#include "jets/tables/named_tables.hpp"
#include "schemes/complex/complex_form.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/complex/lattice_complex.hpp"
#include "schemes/complex/space_rows.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/stencil_lists.hpp"
#include "tests/schemes/support.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

std::string fault_of(const StencilList& list) {
  const auto fault = find_fault(list);
  return fault ? std::to_string(fault->line) + ": " + fault->what : "none";
}

TEST_CASE("a lattice written as a list of stencils has the lattice's plan and rows on every shape") {
  Problem problem;
  problem.theory = "sine-gordon";
  const auto theory = theory_named(problem);
  for (const NamedTable& named : named_tables()) {
    if (named.is_for_point()) continue;
    CAPTURE(named.name);
    const int N = named.name == "hexagon" ? 14 : 15, steps = 4;
    const Lattice lattice = Lattice::circle(N, 0.5 * N);
    const double h = 0.4 * lattice.space_step();
    Evolution evolution(lattice, {theory->variational(named.name)}, h);
    const SolvePlan& plan = evolution.plan();
    Random random(3);
    const std::vector<Row> rows = random_rows(random, evolution.stepper().starting_rows(), N, 1.0);
    evolution.stepper().start(rows);
    const int count = plan.history + steps;
    const LatticeComplex whole(lattice, plan, named.table, theory->shared_density(), h, count);
    const StencilList list = list_of(whole.system.complex(), named.name, lattice.length());
    // rows outside, which no equation reads, may be of no stencil
    REQUIRE((fault_of(list) == "none" || whole.outer > 0));
    const ComplexSystem system = spacetime_complex(list, theory->shared_density());
    CHECK(system.families() == 1);
    const ComplexSolver solver(system);
    CHECK(solver.plan().describe() == ComplexSolver(whole.system).plan().describe());
    std::vector<double> y(system.nodes());
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < N; ++i)
        y[static_cast<std::size_t>(whole.site(j, i))] =
            rows[std::min(static_cast<std::size_t>(j), rows.size() - 1)][static_cast<std::size_t>(i)];
    solver.solve(y);
    for (int j = plan.history; j < count; ++j) {
      evolution.stepper().step();
      const Row row = evolution.stepper().row(0);
      for (int i = 0; i < N; ++i)
        CHECK(std::abs(y[static_cast<std::size_t>(whole.site(j, i))] - row[static_cast<std::size_t>(i)]) < 1e-13);
    }
  }
}

TEST_CASE("mixed shapes with jets from their coordinates are exact on affine fields and keep the form formula") {
  Problem problem;
  problem.theory = "sine-gordon";
  const auto sine_gordon = theory_named(problem);
  problem.theory = "wave";
  const auto wave = theory_named(problem);
  const StencilList list = bent_rows(13, 8);
  REQUIRE(fault_of(list) == "none");

  SECTION("an affine field solves the wave equation") {
    const ComplexSystem system = spacetime_complex(list, wave->shared_density());
    CHECK(system.families() > 2);  // bent cells couple all their sites, and others do not
    std::vector<double> exact, y;
    for (const auto& s : list.sites) exact.push_back(0.3 + 0.7 * s.position[0] - 0.4 * s.position[1]);
    y = exact;
    for (int s = 0; s < system.complex().sites(); ++s)
      if (system.complex().is_unknown(s)) y[static_cast<std::size_t>(s)] = 0;
    const ComplexSolver solver(system);
    solver.solve(y);
    for (std::size_t n = 0; n < y.size(); ++n) CHECK(y[n] == Approx(exact[n]).margin(1e-11));
    CHECK(largest_residual(system, y) < 1e-13);
  }
  SECTION("the form formula holds, and one derivative of the wrong sign breaks it") {
    const ComplexSystem system = spacetime_complex(list, sine_gordon->shared_density());
    std::vector<double> y;
    for (const auto& s : list.sites) y.push_back(3 * std::exp(-std::pow(s.position[1] - 1.5, 2)));
    ComplexSolver(system).solve(y);
    const Touching touching(system.complex());
    std::mt19937_64 seed(1);
    const auto region =
        ComplexRegion::around(system.complex(), touching, draw_centres(system.complex(), touching, 12, seed));
    for (const bool wrong : {false, true}) {
      const ComplexForm form(system, region, y, wrong);
      const auto V = form.first_variations(2, seed);
      const double defect = form.form_formula(V[0], V[1]).relative();
      CHECK((wrong ? defect > 1e-6 : defect < 1e-13));
    }
  }
}

TEST_CASE("motion, sites and gradients of a list are those of rows over a mesh") {
  Problem problem;
  problem.theory = "sine-gordon";
  const auto theory = theory_named(problem);
  const CellSpace space(rectangle_mesh(1, 1, 3, 3, false), theory->shared_density(), true);
  const std::array times{0.0, 0.1, 0.25, 0.3};
  const SpaceRows rows(space, times);
  const Complex& complex = rows.system().complex();
  const int n = space.sites();
  StencilList list;
  for (int s = 0; s < complex.sites(); ++s) list.sites.push_back({complex.position(s), complex.role(s)});
  for (int j = 0; j < 4; ++j) {
    const auto u = static_cast<std::size_t>(j);
    const double share = 0.5 * ((j < 3 ? times[u + 1] : times[u]) - (j > 0 ? times[u - 1] : times[u]));
    for (int i = 0; i < n; ++i) {
      const double mass = space.masses[static_cast<std::size_t>(i)];
      list.stencils.push_back({"site", {j * n + i}, share * mass});
      if (j > 0) list.stencils.push_back({"motion", {(j - 1) * n + i, j * n + i}, mass});
    }
    for (int c = 0; c < space.mesh.cells(); ++c) {
      StencilList::Entry e{"gradient", {}, share};
      for (const int p : space.mesh.cell(c)) e.sites.push_back(j * n + p);
      list.stencils.push_back(e);
    }
  }
  REQUIRE(fault_of(list) == "none");
  const ComplexSystem system = spacetime_complex(list, theory->shared_density());
  std::vector<double> y(system.nodes()), z;
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = std::sin(1.7 * static_cast<double>(i));
  z = y;
  ComplexSolver(system).solve(y), ComplexSolver(rows.system()).solve(z);
  for (std::size_t i = 0; i < y.size(); ++i) CHECK(y[i] == Approx(z[i]).margin(1e-13));
}

TEST_CASE("faults of a list of stencils are named with their line") {
  StencilList good = bent_rows(5, 4, 0);
  for (std::size_t n = 0; n < good.stencils.size(); ++n) good.stencils[n].line = 100 + static_cast<int>(n);
  for (std::size_t n = 0; n < good.sites.size(); ++n) good.sites[n].line = static_cast<int>(n);
  REQUIRE(fault_of(good) == "none");
  const auto with = [&](const auto& change) {
    StencilList list = good;
    change(list);
    return fault_of(list);
  };
  CHECK_THAT(with([](auto& l) { std::ranges::reverse(l.stencils[1].sites); }),
             Catch::StartsWith("101: stencil 1 (rectangle) is listed the wrong way round"));
  CHECK_THAT(with([](auto& l) { l.stencils.push_back(l.stencils[8]); }),
             Catch::Contains("is stencil 8 again (line 108)"));
  CHECK_THAT(with([](auto& l) {
               l.stencils.push_back(l.stencils[8]);
               auto& sites = l.stencils.back().sites;
               std::ranges::rotate(sites, sites.begin() + 1);
             }),
             Catch::Contains("is stencil 8 again"));
  CHECK_THAT(with([](auto& l) { l.stencils[2].sites.pop_back(); }), Catch::Contains("has 3 sites and needs 4"));
  CHECK_THAT(with([](auto& l) { l.stencils[2].sites[0] = 99; }), Catch::Contains("names site 99, and there are sites"));
  CHECK_THAT(with([](auto& l) { l.sites[7].position = l.sites[8].position; }),
             Catch::StartsWith("8: site 8 lies where"));
  CHECK_THAT(with([](auto& l) {
               l.sites.push_back({{9, 9, 0, 0}, SiteRole::free, 77});
             }),
             Catch::StartsWith("77: site 20 is in no stencil"));
  CHECK_THAT(with([](auto& l) { l.stencils.push_back({"triangle", {0, 5, 10}}); }), Catch::Contains("spans no area"));
  CHECK_THAT(with([](auto& l) {
               l.stencils.push_back({"motion", {5, 0}, 1.0});
             }),
             Catch::Contains("goes back in time"));
  CHECK_THAT(with([](auto& l) { l.stencils.push_back({"site", {5}}); }), Catch::Contains("needs its share"));
  CHECK_THAT(with([](auto& l) { l.sites[2].position[2] = 1; }), Catch::Contains("is of t and x alone"));
}

}  // namespace
