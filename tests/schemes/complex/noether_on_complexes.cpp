// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include "jets/expressions/expression.hpp"
#include "schemes/complex/asynchronous_window.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/verify/noether_check.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/complex_forms.hpp"
#include "tests/schemes/complex/mesh_rows.hpp"
#include "tests/schemes/complex/space_complex.hpp"

namespace {

using namespace delf;
using delf::testing::ComplexForms;
using delf::testing::MeshCells;
using delf::testing::MeshRows;
using delf::testing::SpaceRows;

const LinearSymmetry rotation{"rotation", {0, -1, 1, 0}, {0, 0}};

std::shared_ptr<const BatchDensity> of_two(const char* potential) {
  return expression(std::string("0.5*u_t^2 + 0.5*v_t^2 ") + potential, {{"u", "v"}, {}});
}
constexpr auto round_well = "- 0.5*(u_x^2 + v_x^2) - 0.25*(u^2 + v^2 - 1)^2";
constexpr auto round_metric = "- 0.5*(u_x^2 + v_x^2)/(1 + u^2 + v^2)";
constexpr auto flat_well = "- 0.5*(u_x^2 + v_x^2) - 0.3*u^2";

struct Start {
  explicit Start(const Mesh& mesh) {
    for (const Mesh::Point& p : mesh.points) {
      values.push_back(1 + 0.3 * std::sin(3 * p[0])), values.push_back(0.2 * std::cos(2 * p[1]));
      rates.push_back(0.4 * p[1]), rates.push_back(0.5 + 0.2 * p[0]);
    }
  }
  std::vector<double> values, rates;
};

/// The checks of one symmetry, and whether all pass.
std::vector<Check> checks_on(const ComplexSystem& system, std::span<const double> y, bool forced = false,
                             bool wrong_sign = false) {
  std::mt19937_64 random(4);
  const auto wrong = wrong_sign ? with_wrong_sign(system.row()) : nullptr;
  NoetherCheck noether(wrong ? *wrong : system.row(), {rotation}, 1e-13, forced, 4);
  for (const int centres : {1, 5, 30}) {
    const ComplexForms forms(system, delf::testing::drawn_region(system, centres, random), y, wrong_sign);
    noether.at(forms.on(), forms.y(), "here");
  }
  return noether.checks();
}

std::vector<double> solved_rows(const CellSpace& space, const SpaceRows& rows) {
  const Start start(space.mesh);
  std::vector<double> y(rows.system().nodes());
  const std::size_t n = start.values.size();
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] = start.values[i % n] + 0.05 * static_cast<double>(i / n) * start.rates[i % n];
  ComplexSolver(rows.system()).solve(y);
  return y;
}

TEST_CASE("Noether's theorem holds on connected sets of a sphere and a plane region, and can fail") {
  const std::array times{0.0, 0.05, 0.12, 0.15, 0.19, 0.27};
  for (const Mesh& mesh : {icosahedral_sphere(1), rectangle_mesh(2, 1, 6, 4, true)})
    for (const bool fixed : {false, true})
      for (const char* potential : {round_well, round_metric}) {
        const CellSpace space(mesh, of_two(potential), fixed);
        const SpaceRows rows(space, times);
        std::vector<double> y = solved_rows(space, rows);
        const auto found = checks_on(rows.system(), y);
        REQUIRE(found.size() == 2);
        CHECK(found[0].name == "symmetry of L, rotation");
        CHECK(found[0].value < 1e-13);
        CHECK(found[1].value < 1e-13);
        CHECK(found[1].count > 10);
        CHECK_FALSE(checks_on(rows.system(), y, false, true)[0].passed());  // a derivative of the wrong sign
        for (std::size_t n = 0; n < y.size(); n += 7) y[n] += 1e-3;         // rows that solve nothing
        CHECK(checks_on(rows.system(), y)[1].value > 1e-6);
      }
  const CellSpace space(icosahedral_sphere(1), of_two(flat_well), false);
  const SpaceRows rows(space, times);
  const std::vector<double> y = solved_rows(space, rows);
  CHECK(checks_on(rows.system(), y).size() == 1);  // no symmetry: nothing is owed
  CHECK(checks_on(rows.system(), y)[0].value > 1e-3);
  CHECK(checks_on(rows.system(), y, true)[1].value > 1e-6);
}

TEST_CASE("rows keep the total momentum of a symmetry where nothing holds their boundary") {
  const auto change = [](bool fixed, const char* potential) {
    const CellSpace space(rectangle_mesh(2, 1, 12, 6, false), of_two(potential), fixed);
    MeshRows evolution(space, 0.02);
    const Start start(space.mesh);
    evolution.start(start.values, start.rates);
    const Balance first = evolution.momentum(rotation);
    CHECK(first.absolute > 0.1);
    double most = 0;
    for (int n = 0; n < 60; ++n) {
      evolution.step(n % 3 == 0 ? 0.02 : 0.015);
      most = std::max(most, std::abs(evolution.momentum(rotation).sum - first.sum) / first.absolute);
    }
    return most;
  };
  CHECK(change(false, round_well) < 1e-13);
  CHECK(change(false, round_metric) < 1e-13);
  CHECK(change(true, round_well) > 1e-4);
  CHECK(change(false, flat_well) > 1e-4);
}

TEST_CASE("cells with steps of their own keep the momentum of a symmetry, and Noether's theorem in a window") {
  const auto evolve = [](const char* potential, double& most) {
    const CellSpace space(rectangle_mesh(2, 1, 8, 4, false), of_two(potential), false);
    std::vector<double> steps;
    for (int c = 0; c < space.mesh.cells(); ++c) steps.push_back(0.02 + 0.0013 * (c % 7));
    MeshCells cells(space, steps);
    const Start start(space.mesh);
    cells.stepper.start_rates(start.values, start.rates);
    const Balance first = cells.momentum(rotation, 0);
    most = 0;
    for (int n = 1; n <= 50; ++n) {
      cells.stepper.advance(0.02 * n);
      most = std::max(most, std::abs(cells.momentum(rotation, 0.02 * n).sum - first.sum) / first.absolute);
    }
    cells.stepper.keep_updates();
    cells.stepper.update(6 * space.mesh.cells());
    const AsynchronousWindow window(space, cells.stepper);
    return checks_on(window.system, window.values, true);
  };
  double most = 0;
  for (const Check& check : evolve(round_well, most)) CHECK(check.value < 1e-13);
  CHECK(most < 1e-13);
  for (const Check& check : evolve(flat_well, most)) CHECK(check.value > 1e-6);
  CHECK(most > 1e-4);
}

}  // namespace
