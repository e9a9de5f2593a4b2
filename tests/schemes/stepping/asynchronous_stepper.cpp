// SPDX-License-Identifier: MIT
#include "schemes/stepping/asynchronous_stepper.hpp"

#include <algorithm>
#include <cmath>

#include "jets/expressions/expression.hpp"
#include "schemes/complex/asynchronous_window.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/complex_forms.hpp"
#include "tests/schemes/complex/mesh_rows.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

/// An interval with cells that shrink towards its right end, and steps of no common multiple.
struct Case {
  explicit Case(double courant)
      : space(graded_interval(20, 41, 0.96), expression("0.5*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)"), true) {
    for (int c = 0; c < space.mesh.cells(); ++c) steps.push_back(courant * measure(space.mesh, c));
    for (const Mesh::Point& p : space.mesh.points) {
      const double s = (p[0] - 8) / std::sqrt(0.91);
      values.push_back(4 * std::atan(std::exp(s)));
      rates.push_back(-0.3 / std::sqrt(0.91) * 2 / std::cosh(s));
    }
  }
  CellSpace space;
  std::vector<double> steps, values, rates;
};

TEST_CASE("asynchronous steps are a complex with the same order, and the form formula holds on it") {
  const Case c(0.4);
  MeshCells cells(c.space, c.steps);
  cells.stepper.start_rates(c.values, c.rates);
  cells.stepper.advance(1);
  cells.stepper.keep_updates();
  cells.stepper.update(400);
  const AsynchronousWindow window(c.space, cells.stepper);
  const ComplexSolver solver(window.system);
  CHECK(solver.plan().largest == 1);
  CHECK(solver.is_direct());
  // solved from the data by the plan's own order, from values that are all wrong
  std::vector<double> y = window.values;
  const Complex& complex = window.system.complex();
  for (int s = 0; s < complex.sites(); ++s)
    if (complex.is_unknown(s)) y[s] = 0;
  solver.solve(y);
  double distance = 0;
  for (std::size_t n = 0; n < y.size(); ++n) distance = std::max(distance, std::abs(y[n] - window.values[n]));
  CHECK(distance < 1e-12);

  std::mt19937_64 random(1);
  for (const int centres : {1, 10, 40}) {
    const ComplexForms form(window.system, drawn_region(window.system, centres, random), window.values);
    auto V = form.first_variations(2, random);
    CHECK(form.form_formula(V[0], V[1]).relative() < 1e-13);
    V[0][*form.coupling_node()] += 0.1;
    CHECK(form.form_formula(V[0], V[1]).relative() > 1e-6);
  }
}

TEST_CASE("asynchronous steps converge with order 2 on a mesh, and their energy does not drift") {
  const Case fine(0.4);
  const double h = 0.001;
  MeshRows reference(fine.space, h);
  reference.start(fine.values, fine.rates);
  while (reference.newest() < 4000) reference.step();
  const auto error = [&](double courant) {
    const Case c(courant);
    MeshCells cells(c.space, c.steps);
    cells.stepper.start_rates(c.values, c.rates);
    const double energy = cells.energy(0);
    for (double t = 1; t <= 4; ++t) {
      cells.stepper.advance(t);
      CHECK(std::abs(cells.energy(t) - energy) < 0.05 * courant * courant * energy);
    }
    const auto values = cells.stepper.values(4);
    double most = 0;
    for (std::size_t i = 0; i < values.size(); ++i) most = std::max(most, std::abs(values[i] - reference.row()[i]));
    return most;
  };
  CHECK(std::log2(error(0.1) / error(0.05)) == Approx(2).margin(0.3));
}

TEST_CASE("asynchronous steps of one length are leapfrog rows") {
  const Case c(0.4);
  const double h = 0.05;
  MeshCells cells(c.space, std::vector<double>(c.steps.size(), h));
  cells.stepper.start_rates(c.values, c.rates);
  MeshRows rows(c.space, h);
  rows.start(c.values, c.rates);
  while (rows.newest() < 40) rows.step();
  cells.stepper.advance(40 * h);
  const auto values = cells.stepper.values(40 * h);
  for (std::size_t i = 0; i < values.size(); ++i) CHECK(std::abs(values[i] - rows.row()[i]) < 1e-12);
}

}  // namespace
