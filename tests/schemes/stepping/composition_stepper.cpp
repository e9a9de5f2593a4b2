// SPDX-License-Identifier: MIT
#include "schemes/stepping/composition_stepper.hpp"

#include <cmath>
#include <limits>

#include "lattice/index.hpp"
#include "schemes/state.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int N = 30;

struct Run {
  Problem problem;
  Simulation simulation;
  std::size_t C;

  Run(const std::string& theory, int order, int space_order, double courant, int sites = N, int winding = 0)
      : problem([&] {
          Problem p = problem_of(theory);
          p.method = "composition", p.parameters["scheme.order"] = order,
          p.parameters["lattice.space_order"] = space_order, p.winding = winding;
          // far from the seam: stencils across it see x beyond L, where rows see it once more from 0
          p.parameters["theory.position"] = 6, p.parameters["theory.width"] = 0.3;
          p.lattice = Lattice::circle(sites, 12), p.time_step = courant * p.lattice.space_step();
          return p;
        }()),
        simulation(problem),
        C(simulation.components().size()) {
    const std::size_t size = sites;
    const std::size_t d = at(simulation.count(Role::field));
    std::vector<double> row(size * C), rate(size * C);
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t a = 0; a < d; ++a) {
        const double x = 2 * M_PI * (static_cast<double>(i) + 0.3 * static_cast<double>(a)) / sites;
        row[i * C + a] = std::sin(x) + 0.4 * std::cos(2 * x) + winding * x;
        rate[i * C + a] = 0.5 * std::cos(x) - 0.2;
      }
    simulation.start_legendre(row, rate);
  }
  std::vector<double> fields(int back = 0) const {
    std::vector<double> row(problem.lattice.sites() * simulation.count(Role::field));
    simulation.copy_row(back, row);
    return row;
  }
  /// The largest |E| of all rows between row n − 1 and row n, one stencil at a time, relative to Σ |terms|.
  double defect() const {
    const Evolution& evolution = simulation.evolution();
    const Window window = evolution.stepper().window(3);
    std::vector<LatticeSystem::Value> values;
    evolution.system().equations(window, window.last_row() - 1, values);
    double worst = 0, size = 0;
    for (const auto& v : values) worst = std::max(worst, std::abs(v.sum)), size = std::max(size, v.absolute);
    return worst / size;
  }
};

}  // namespace

namespace {
Row newest_of(const Simulation& simulation) {
  Row row(N);
  simulation.copy_row(0, row);
  return row;
}
}  // namespace

TEST_CASE("every row between the sub-steps of a composition solves the field equation there") {
  for (const char* theory : {"sine-gordon", "phi4", "klein-gordon", "wave", "double-sine-gordon",
                             "sine-gordon-impurity", "coupled-sine-gordon", "complex-klein-gordon"})
    for (const auto& [order, space] : {std::pair{2, 2}, {4, 4}, {8, 12}}) {
      CAPTURE(theory, order, space);
      Run run(theory, order, space, 0.4);
      CHECK(std::string(run.simulation.solve_kind()) == "explicit");
      for (int n = 0; n < 3; ++n) run.simulation.step();
      CHECK(run.defect() < 1e-14);
      CHECK(run.simulation.residual() < 1e-14);
    }
}

TEST_CASE("the equations of a composition notice another mass") {
  Run run("sine-gordon", 4, 4, 0.4);
  for (int n = 0; n < 3; ++n) run.simulation.step();
  Problem other = run.problem;
  other.parameters["theory.mass"] = 1.3;
  const Simulation heavier(other);
  const Window window = run.simulation.evolution().stepper().window(3);
  std::vector<LatticeSystem::Value> values;
  heavier.evolution().system().equations(window, window.last_row() - 1, values);
  double worst = 0;
  for (const auto& v : values) worst = std::max(worst, std::abs(v.sum) / v.absolute);
  CHECK(worst > 1e-4);
}

TEST_CASE("order 2 over nearest neighbours is leapfrog") {
  Run run("sine-gordon", 2, 2, 0.7, N, 1);
  Problem p = run.problem;
  p.method = "multisymplectic", p.stencil = "triangle-vertex";
  Simulation leapfrog(p);
  leapfrog.start({run.fields(1), run.fields(0)});
  Row row(N);
  for (int n = 0; n < 200; ++n) run.simulation.step(n % 3 == 1), leapfrog.step();
  leapfrog.copy_row(0, row);
  CHECK(distance(row, run.fields()) < 1e-12);
  // from the same two rows too
  p.method = "composition";
  Simulation started(p);
  started.start({run.fields(1), run.fields(0)});
  leapfrog.step(), started.step();
  leapfrog.copy_row(0, row);
  CHECK(distance(row, newest_of(started)) < 1e-12);
  // and not that of another Courant number
  Run other("sine-gordon", 2, 2, 0.69, N, 1);
  for (int n = 0; n < 200; ++n) other.simulation.step();
  CHECK(distance(row, other.fields()) > 1e-3);
}

TEST_CASE("steps that no one looks at give the same bits") {
  for (const int sites : {13, 16, 30, 41}) {
    Run looked("sine-gordon", 6, 12, 0.5, sites, 1), unlooked("sine-gordon", 6, 12, 0.5, sites, 1);
    for (int n = 0; n < 150; ++n) looked.simulation.step(), unlooked.simulation.step(n % 50 == 49);
    CAPTURE(sites);
    CHECK(looked.fields() == unlooked.fields());
    CHECK_THROWS_AS(unlooked.fields(2), std::logic_error);
    unlooked.simulation.step(false);
    CHECK(std::isnan(unlooked.simulation.residual()));
  }
}

TEST_CASE("a composition that overflows stops with the last good row") {
  for (const bool looked_at : {true, false}) {
    Run run("sine-gordon", 4, 6, 4), again("sine-gordon", 4, 6, 4);
    std::string message;
    try {
      for (int n = 0; n < 5000; ++n) run.simulation.step(looked_at);
    } catch (const NotFinite& failure) {
      message = failure.what();
    }
    CAPTURE(looked_at, message);
    CHECK(message.find("no longer finite") != std::string::npos);
    while (again.simulation.newest() < run.simulation.newest()) again.simulation.step();
    CHECK(run.fields() == again.fields());
    CHECK(run.fields(1) == again.fields(1));
    for (const double y : run.fields()) CHECK(std::abs(y) < 1e150);
  }
}

TEST_CASE("many steps at once that overflow say so, whatever rows they leave") {
  // a step that fails just after a row was saved leaves one row
  int alone = 0;
  for (int n = 0; n < 400; ++n) {
    Run run("sine-gordon", 4, 6, 2.2 + 0.002 * n);
    std::string message;
    try {
      run.simulation.steps(5000);
    } catch (const NotFinite& failure) {
      message = failure.what();
    }
    CAPTURE(n, message);
    REQUIRE(message.find("no longer finite") != std::string::npos);
    if (run.simulation.evolution().stepper().held() < 2) ++alone;
  }
  CHECK(alone > 0);
}

TEST_CASE("compositions refuse what they cannot start from or be built on") {
  Run run("sine-gordon", 4, 4, 0.5);
  CHECK_THROWS_AS(run.simulation.start({Row(N * run.C), Row(N * run.C)}), BadInput);
  const auto refused = [&](auto change) {
    Problem p = run.problem;
    change(p);
    try {
      Simulation{p};
    } catch (const BadInput& failure) {
      return failure.key();
    }
    return std::string();
  };
  CHECK(refused([](Problem& p) { p.parameters["scheme.order"] = 3; }) == "scheme.order");
  CHECK(refused([](Problem& p) { p.parameters["scheme.order"] = 10; }) == "scheme.order");
  CHECK(refused([](Problem& p) { p.parameters["lattice.space_order"] = 5; }) == "lattice.space_order");
  CHECK(refused([](Problem& p) { p.parameters["lattice.space_order"] = 22; }) == "lattice.space_order");
  CHECK(refused([](Problem& p) { p.parameters["lattice.space_order"] = 12, p.lattice = Lattice::circle(12, 12); }) ==
        "lattice.sites");
  CHECK(refused([](Problem& p) { p.lattice = Lattice::interval(30, 12, Wall::clamped); }) == "boundary.left");
  CHECK(refused([](Problem& p) { p.theory = "wave-map"; }) == "scheme.method");
  CHECK(refused([](Problem& p) { p.circle_valued = true; }) == "theory.fibre");
}
