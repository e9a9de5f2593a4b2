// SPDX-License-Identifier: MIT
#include "schemes/complex/spacetime_complex.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "jets/tables/named_tables.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/complex_forms.hpp"
#include "tests/schemes/complex/lattice_complex.hpp"
#include "tests/schemes/complex/lattice_values.hpp"
#include "tests/schemes/complex/space_complex.hpp"
#include "tests/schemes/complex/stencil_lists.hpp"
#include "tests/schemes/support.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

std::string fault_of(const StencilList& list) {
  const auto fault = find_fault(list);
  return fault ? std::to_string(fault->line) + ": " + fault->what : "none";
}

/// A beam with rotary inertia on a nonlinear foundation.
struct Beam {
  static constexpr int jet_order = 2;
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_xx * j.phi_xx + 0.3 * (j.phi_tx * j.phi_tx)) + cos(j.phi);
  }
};
struct Euler {
  static constexpr int jet_order = 2;
  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t - j.phi_xx * j.phi_xx); }
};
/// The first with a term of φ_tt.
struct SecondInTime {
  static constexpr int jet_order = 2;
  auto operator()(const auto& j) const { return Beam{}(j) + 0.05 * (j.phi_tt * j.phi_tt); }
};

TEST_CASE("a lattice written as a list of stencils has the lattice's plan and rows on every shape") {
  Problem problem;
  problem.theory = "sine-gordon";
  const std::shared_ptr<const FieldTheory> first_order = theory_named(problem);
  const auto second_order = std::make_shared<TheoryOf<Beam>>(Beam{});
  const auto has_second = [](const NamedTable& named) { return !named.table.points[0][JetSlot::phi_xx].empty(); };
  for (const bool of_second_order : {false, true})
    for (const NamedTable& named : named_tables()) {
      if (named.is_for_point() || (of_second_order && !has_second(named))) continue;
      CAPTURE(named.name, of_second_order);
      const FieldTheory* const theory = of_second_order ? second_order.get() : first_order.get();
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
      std::vector<double> y = first_values(whole, rows, count);
      solver.solve(y);
      for (int j = plan.history; j < count; ++j) {
        evolution.stepper().step();
        const Row row = evolution.stepper().row(0);
        for (int i = 0; i < N; ++i)
          CHECK(std::abs(y[whole.site(j, i)] - row[i]) < 1e-13 * std::max(1.0, std::abs(row[i])));
      }
    }
}

TEST_CASE("second derivatives on sites that lie anywhere are exact on quadratic fields") {
  std::mt19937_64 seed(2);
  std::uniform_real_distribution<double> bend(-0.1, 0.1);
  for (const NamedTable& named : named_tables()) {
    if (named.table.points[0][JetSlot::phi_xx].empty()) continue;
    CAPTURE(named.name);
    const bool nine = named.table.pattern.size() == 9;
    std::vector<Complex::Position> sites;
    for (const Site& v : named.table.pattern.vertices)
      sites.push_back({0.3 * v.time + (nine ? 0.3 * bend(seed) : 0), 0.5 * v.space + 0.5 * bend(seed), 0, 0});
    const auto jets = [&](const auto& field) {
      std::vector<std::array<double, 3>> all;
      for (const TablePoint& p : placed_points(named.table, sites)) {
        std::array<double, 3> jet{};
        for (const int s : {3, 4, 5})
          for (const auto& e : p.slots[at(s)]) jet[s - 3] += e.weight * field(sites[e.vertex][0], sites[e.vertex][1]);
        all.push_back(jet);
      }
      return all;
    };
    for (const auto& [tt, tx, xx] : jets([&](double t, double x) {
           return 1 + 2 * t - x + (nine ? 0.7 * t * t : 0) - 0.4 * t * x + 1.1 * x * x;
         })) {
      CHECK(tt == Approx(nine ? 1.4 : 0).margin(1e-11));
      CHECK(tx == Approx(-0.4).margin(1e-11));
      CHECK(xx == Approx(2.2).margin(1e-11));
    }
    const auto [tt, tx, xx] = jets([](double t, double x) { return x * x * (x + t); }).front();
    CHECK(std::abs(xx - 6 * 0.5) > 1e-3);  // of a cubic they are not
  }
}

TEST_CASE("a beam on six-tuples of unequal spacing converges with order 2, and not where jets take it for equal") {
  // φ_tt + φ_xxxx = 0: cos(x − t), of cells that grow and shrink around the circle, or are twice as long on one half
  const auto density = TheoryOf<Euler>(Euler{}).shared_density();
  const double turn = 2 * std::acos(-1.0);
  const auto error_of = [&](int n, bool abrupt, bool taken_for_equal) {
    const auto x = [&](int i) {
      const double xi = static_cast<double>(i) / n;
      if (!abrupt) return turn * xi + 0.4 * std::sin(turn * xi);
      return turn * (xi < 0.5 ? 2 * xi / 3 : (4 * xi - 1) / 3);
    };
    const int rows = n / 2 + 1;
    const StencilList list = beam_rows(n, rows, turn, 0.5 / (rows - 1), x);
    REQUIRE(fault_of(list) == "none");
    StencilList solved = list;
    for (std::size_t s = 0; taken_for_equal && s < solved.sites.size(); ++s)
      solved.sites[s].position[1] = turn * static_cast<double>(s % at(n)) / n;
    const ComplexSystem system = spacetime_complex(solved, density);
    std::vector<double> y, exact;
    for (const auto& s : list.sites) exact.push_back(std::cos(s.position[1] - s.position[0]));
    y = exact;
    for (std::size_t s = at(2 * n); s < y.size(); ++s) y[s] = 0;
    ComplexSolver(system).solve(y);
    double most = 0;
    for (std::size_t s = 0; s < y.size(); ++s) most = std::max(most, std::abs(y[s] - exact[s]));
    return most;
  };
  for (const bool abrupt : {false, true}) {
    CAPTURE(abrupt);
    CHECK(std::log2(error_of(24, abrupt, false) / error_of(48, abrupt, false)) == Approx(2).margin(0.25));
    CHECK(std::log2(error_of(24, abrupt, true) / error_of(48, abrupt, true)) < 0.5);
  }
}

TEST_CASE(
    "second-order densities on bent nine-tuples keep the form formula, and stencils without a derivative are named") {
  const auto density = TheoryOf<SecondInTime>(SecondInTime{}).shared_density();
  StencilList list = bent_rows(13, 8);
  list.stencils.clear();
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 13; ++i) {
      SiteRole& role = list.sites[13 * j + i].role;
      role = i < 2 || i > 10 || j < 2 ? SiteRole::given
             : j < 4                  ? SiteRole::initial
             : j < 6                  ? SiteRole::free
                                      : SiteRole::final;
    }
  for (int j = 1; j < 7; ++j)
    for (int i = 1; i < 12; ++i) {
      StencilList::Entry e{"nine-tuple", {}};
      e.line = 100 + static_cast<int>(list.stencils.size());
      for (const Site& v : stencil_shape("nine-tuple")->table->pattern.vertices)
        e.sites.push_back(13 * (j + v.time) + i + v.space);
      list.stencils.push_back(e);
    }
  REQUIRE(fault_of(list) == "none");
  const ComplexSystem system = spacetime_complex(list, density);
  std::vector<double> y;
  for (const auto& s : list.sites) y.push_back(3 * std::exp(-std::pow(s.position[1] - 1.5, 2)));
  ComplexSolver(system).solve(y);
  CHECK(largest_residual(system, y) < 1e-12);
  std::mt19937_64 seed(1);
  const Region region = drawn_region(system, 8, seed);
  for (const bool wrong : {false, true}) {
    const ComplexForms form(system, region, y, wrong);
    const auto V = form.first_variations(2, seed);
    const double defect = form.form_formula(V[0], V[1]).relative();
    CHECK((wrong ? defect > 1e-6 : defect < 1e-13));
  }

  const auto refused = [&](const StencilList& of, const auto& by, const char* why) {
    CHECK_THROWS_WITH(spacetime_complex(of, by), Catch::Contains(why));
  };
  StencilList six = beam_rows(8, 3, 8, 0.1, [](int i) { return 1.0 * i; });
  for (std::size_t n = 0; n < six.stencils.size(); ++n) six.stencils[n].line = 10 + static_cast<int>(n);
  refused(six, density, "lattice.mesh: line 10: stencil 0 (six-tuple) has no phi_tt, which the density reads");
  const auto beam = TheoryOf<Beam>(Beam{}).shared_density();
  CHECK_NOTHROW(spacetime_complex(six, beam));
  six.sites[4].position[0] += 0.01;
  refused(six, beam, "line 13: stencil 3 (six-tuple) does not determine phi_tx: each of its rows must lie at one time");
  refused(bent_rows(5, 4, 0), beam, "stencil 0 (rectangle) has no phi_tx, which the density reads; use a six-tuple or");
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
      if (system.complex().is_unknown(s)) y[s] = 0;
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
    std::mt19937_64 seed(1);
    const Region region = drawn_region(system, 12, seed);
    for (const bool wrong : {false, true}) {
      const ComplexForms form(system, region, y, wrong);
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
    const std::size_t u = j;
    const double share = 0.5 * ((j < 3 ? times[u + 1] : times[u]) - (j > 0 ? times[u - 1] : times[u]));
    for (int i = 0; i < n; ++i) {
      const double mass = space.masses[i];
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
