// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "jets/batch_of.hpp"
#include "jets/expressions/expression.hpp"
#include "lattice/error.hpp"
#include "schemes/complex/cell_space.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stability/mesh_frequency.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/verify/first_and_last_step.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/complex_forms.hpp"
#include "tests/schemes/complex/mesh_rows.hpp"
#include "tests/schemes/complex/space_complex.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

std::shared_ptr<const BatchDensity> wave() { return expression("0.5*phi_t^2 - 0.5*phi_x^2"); }
std::shared_ptr<const BatchDensity> sine_gordon() { return expression("0.5*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)"); }

using Solution = std::function<double(double t, const Mesh::Point&)>;

std::vector<double> at_points(const Mesh& mesh, const Solution& f, double t) {
  std::vector<double> values;
  for (const Mesh::Point& p : mesh.points) values.push_back(f(t, p));
  return values;
}

/// The error at t = 1 against a solution, √(Σ A_i e_i²).
double error_of(Mesh mesh, std::shared_ptr<const BatchDensity> density, bool fixed, double courant, const Solution& f) {
  const CellSpace space(std::move(mesh), std::move(density), fixed);
  const int steps = static_cast<int>(std::ceil(1 / (courant * shortest_edge(space.mesh))));
  MeshRows evolution(space, 1.0 / steps);
  std::vector<double> rates;
  for (const Mesh::Point& p : space.mesh.points) rates.push_back((f(1e-6, p) - f(-1e-6, p)) / 2e-6);
  evolution.start(at_points(space.mesh, f, 0), rates);
  CHECK(evolution.evolution().plan().kind == SolveKind::explicit_);
  while (evolution.newest() < steps) evolution.step();
  const std::vector<double> exact = at_points(space.mesh, f, 1);
  double error = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) error += space.masses[i] * std::pow(evolution.row()[i] - exact[i], 2);
  return std::sqrt(error);
}

TEST_CASE("waves on spheres, plane regions and graded intervals converge with order 2") {
  const auto order = [](const std::function<double(int)>& error) { return std::log2(error(1) / error(2)); };
  const Solution harmonic = [](double t, const Mesh::Point& p) { return p[0] * p[1] * std::cos(std::sqrt(6.0) * t); };
  CHECK(order([&](int n) { return error_of(icosahedral_sphere(n + 1), wave(), false, 0.4, harmonic); }) ==
        Approx(2).margin(0.25));
  // the kink's tails meet the walls, where they are held at other values than the solution's: far away
  const Solution line = [](double t, const Mesh::Point& p) {
    return 4 * std::atan(std::exp((p[0] - 15 - 0.5 * t) / std::sqrt(0.75)));
  };
  CHECK(order([&](int n) {
          return error_of(graded_interval(30, 75 * n + 1, std::pow(0.98, 1.0 / n)), sine_gordon(), true, 0.5, line);
        }) == Approx(2).margin(0.25));
  const Solution standing = [](double t, const Mesh::Point& p) {
    return std::cos(M_PI * p[0]) * std::cos(M_PI * p[1]) * std::cos(M_PI * std::sqrt(2.0) * t);
  };
  for (const bool quadrilaterals : {false, true})
    CHECK(order([&](int n) {
            return error_of(rectangle_mesh(2, 1, 16 * n, 8 * n, quadrilaterals), wave(), false, 0.3, standing);
          }) == Approx(2).margin(0.25));
}

TEST_CASE("the form formula holds on irregular spaces with steps of their own, and can fail") {
  const std::array times{0.0, 0.05, 0.12, 0.15, 0.19, 0.27};
  Mesh mixed = rectangle_mesh(2, 1, 4, 3, true);
  mixed.first = {0}, mixed.vertices.clear();
  const Mesh squares = rectangle_mesh(2, 1, 4, 3, true), triangles = rectangle_mesh(2, 1, 4, 3, false);
  for (int c = 0; c < 6; ++c) mixed.add_cell(squares.cell(c));
  for (int c = 12; c < 24; ++c) mixed.add_cell(triangles.cell(c));
  REQUIRE_FALSE(find_fault(mixed));
  for (const Mesh& mesh : {icosahedral_sphere(1), mixed, graded_interval(4, 20, 1.1)})
    for (const bool fixed : {false, true}) {
      const CellSpace space(mesh, sine_gordon(), fixed);
      const SpaceRows rows(space, times);
      const ComplexSystem& system = rows.system();
      std::mt19937_64 random(2);
      std::normal_distribution<double> normal;
      std::vector<double> y(system.nodes());
      for (double& value : y) value = normal(random);
      const ComplexSolver solver(system);
      CHECK(solver.is_direct());
      CHECK(solver.plan().levels == 4);
      solver.solve(y);
      for (const int centres : {1, 7, 25}) {
        const ComplexForms form(system, drawn_region(system, centres, random), y);
        auto V = form.first_variations(2, random);
        CHECK(form.linearised(V[0]) < 1e-12);
        CHECK(form.form_formula(V[0], V[1]).relative() < 1e-13);
        CHECK(form.local_identity(V[0], V[1]).relative() < 1e-13);
        V[0][*form.coupling_node()] += 0.1;
        CHECK(form.form_formula(V[0], V[1]).relative() > 1e-6);
      }
    }
}

TEST_CASE("momenta on rows with steps of their own: a uniform shift of a wave goes on") {
  // φ ↦ φ + ε is a symmetry: Σ A_i (y^{j+1} − y^j)/h_j is the same in every step, whatever the steps are
  const CellSpace space(icosahedral_sphere(1), wave(), false);
  MeshRows evolution(space, 0.05);
  std::vector<double> values, rates;
  for (const Mesh::Point& p : space.mesh.points) values.push_back(std::sin(3 * p[0])), rates.push_back(1 + p[1] * p[2]);
  evolution.start(values, rates);
  const auto momentum = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      sum += space.masses[i] * (evolution.row()[i] - evolution.before()[i]);
    return sum;
  };
  const double first = momentum() / 0.05;
  for (const double h : {0.07, 0.03, 0.08, 0.05, 0.05, 0.02}) {
    evolution.step(h);
    CHECK(momentum() / h == Approx(first).epsilon(1e-12));
  }
  CHECK(evolution.residual() < 1e-12);
}

/// sine-Gordon on a mesh, with steps that the field chooses.
std::unique_ptr<Simulation> of_chosen_steps(const CellSpace& space, double longest, double strength,
                                            std::span<const double> values, std::span<const double> rates) {
  Problem problem{.theory = "sine-gordon",
                  .lattice = Lattice::on(std::shared_ptr<const MeshSpace>(std::shared_ptr<const MeshSpace>(), &space)),
                  .time_step = longest,
                  .step_control = strength};
  auto simulation = std::make_unique<Simulation>(problem);
  if (!values.empty()) simulation->start_legendre(values, rates);
  return simulation;
}
void step(Simulation& simulation, bool reversible, double longest) {
  if (reversible) simulation.step();
  else simulation.step_by(longest / simulation.row_density().density);  // the plain step, which is not reversible
}
std::vector<double> row_of(const Simulation& simulation, int back = 0) {
  return simulation.evolution().stepper().row(back);
}

TEST_CASE("steps that the field chooses run back to where they began, and plain ones do not") {
  const CellSpace space(icosahedral_sphere(1), sine_gordon(), false);
  std::vector<double> start, rates;
  for (const Mesh::Point& p : space.mesh.points) start.push_back(2 * p[0] + 1), rates.push_back(1 + p[1] * p[2]);
  const auto distance = [&](bool reversible) {
    const auto forth = of_chosen_steps(space, 0.2, 1, start, rates), back = of_chosen_steps(space, 0.2, 1, {}, {});
    for (int n = 0; n < 100; ++n) step(*forth, reversible, 0.2);
    back->start({row_of(*forth), row_of(*forth, 1)}, forth->step_density());
    for (int n = 0; n < 100; ++n) step(*back, reversible, 0.2);
    double most = 0;
    for (std::size_t i = 0; i < start.size(); ++i) most = std::max(most, std::abs(row_of(*back)[i] - start[i]));
    return most;
  };
  CHECK(distance(true) < 1e-10);
  CHECK(distance(false) > 1e-4);
}

TEST_CASE("steps that the field chooses have order 2, and keep the energy without drift") {
  // all points swing as one pendulum, to 2.9: slow at its ends, fast between them
  const CellSpace space(icosahedral_sphere(0), sine_gordon(), false);
  const std::vector<double> start(12, 2.9), rest(12, 0.0);
  const auto error = [&](double longest) {
    const auto evolution = of_chosen_steps(space, longest, 1.5, start, rest);
    // the pendulum by Runge-Kutta steps of order 4, a tenth as long
    double q = 2.9, v = 0, t = 0, most = 0;
    for (; t < 20; evolution->step()) {
      const double h = (evolution->time(evolution->newest()) - t) / 10;
      for (int n = 0; n < 10; ++n) {
        const double k1 = v, l1 = -std::sin(q), k2 = v + h / 2 * l1, l2 = -std::sin(q + h / 2 * k1);
        const double k3 = v + h / 2 * l2, l3 = -std::sin(q + h / 2 * k2), k4 = v + h * l3, l4 = -std::sin(q + h * k3);
        q += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), v += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
      }
      t = evolution->time(evolution->newest());
      most = std::max(most, std::abs(row_of(*evolution)[0] - q));
    }
    return most;
  };
  CHECK(std::log2(error(0.1) / error(0.05)) == Approx(2).margin(0.2));

  const MeshEnergy energy_of(sine_gordon(), space);
  const auto drift = [&](bool reversible) {
    const auto evolution = of_chosen_steps(space, 0.25, 1.5, start, rest);
    const auto last_step = [&] { return evolution->evolution().system().times()->step(evolution->newest() - 1); };
    const auto energy_now = [&] {
      return energy_of.between(row_of(*evolution, 1), row_of(*evolution), last_step(), 0);
    };
    const double energy = energy_now();
    double shortest = 1, longest = 0;
    std::array<double, 2> mean{};  // of the energy's change, over the first and the last fifth
    constexpr int count = 4000, part = count / 5;
    for (int n = 0; n < count; ++n) {
      step(*evolution, reversible, 0.25);
      shortest = std::min(shortest, last_step()), longest = std::max(longest, last_step());
      if (n < part) mean[0] += (energy_now() / energy - 1) / part;
      if (n >= count - part) mean[1] += (energy_now() / energy - 1) / part;
    }
    INFO("steps from " << shortest << " to " << longest);
    CHECK(longest > 2 * shortest);
    return std::abs(mean[1] - mean[0]);
  };
  const double reversible = drift(true), plain = drift(false);
  CAPTURE(reversible, plain);
  CHECK(reversible < 1e-3);
  CHECK(plain > 20 * reversible);
}

TEST_CASE("steps that the field chooses need a density quadratic in the rates") {
  const CellSpace space(icosahedral_sphere(0), sine_gordon(), false);
  Problem problem{.theory = "text",
                  .lattice = Lattice::on(std::shared_ptr<const MeshSpace>(std::shared_ptr<const MeshSpace>(), &space)),
                  .time_step = 0.1,
                  .step_control = 1.0};
  problem.parameters["theory.density"] = std::string("phi_t^2 + phi_t^4 - phi_x^2");
  Simulation simulation(problem);
  const std::vector<double> zero(12, 0.0), one(12, 1.0);
  CHECK_THROWS_AS(simulation.start_legendre(zero, one), BadInput);
}

TEST_CASE("one 2-form is kept if the last step is as long as the first, and only then") {
  const std::array same{0.0, 0.05, 0.12, 0.15, 0.19, 0.24}, other{0.0, 0.05, 0.12, 0.15, 0.19, 0.27};
  for (const bool fixed : {false, true}) {
    const CellSpace space(rectangle_mesh(2, 1, 6, 3, false), sine_gordon(), fixed);
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const auto change = [&](std::span<const double> times, bool fault) {
      const MeshRows rows(space, 1);
      std::vector<std::vector<double>> y(times.size(), std::vector<double>(space.fields_of_row()));
      for (std::vector<double>& row : y)
        for (double& value : row) value = normal(random);
      return form_of_first_step(rows.evolution().system(), times, y, random, fault);
    };
    CHECK(change(same, false).count > 0);
    CHECK(change(same, false).relative() < 1e-13);
    CHECK(change(same, true).relative() > 1e-7);
    CHECK(change(other, false).relative() > 1e-5);
  }
}

TEST_CASE("the energy of a wave on a sphere stays in a band that shrinks with the square of the step") {
  const auto band = [](double h) {
    const CellSpace space(icosahedral_sphere(2), sine_gordon(), false);
    MeshRows evolution(space, h);
    CHECK(longest_step(evolution.evolution().system()) == Approx(0.2).margin(0.07));
    std::vector<double> values;
    for (const Mesh::Point& p : space.mesh.points) values.push_back(2 * std::exp(-6 * (1 - p[2])));
    evolution.start(values, std::vector<double>(values.size(), 0.0));
    const double start = evolution.energy();
    double most = 0;
    while (evolution.time() < 20) {
      evolution.step();
      most = std::max(most, std::abs(evolution.energy() - start) / start);
    }
    return most;
  };
  const double coarse = band(0.1), fine = band(0.05);
  CHECK(coarse < 0.1);
  CHECK(coarse / fine > 3);
}

/// ℓ = ½Aφ_t² − ½B|∇φ|² − ¼Cφ⁴ + Fφ, coefficients of t and x, with the solution u = cos πx cos t:
/// F = (Au_t)_t − (Bu_x)_x + Cu³.
std::string manufactured(const std::string& A, const std::string& A_t) {
  const std::string u = "cos(pi*x)*cos(t)", B = "(1.2 + 0.4*cos(2*x - 0.5*t))", B_x = "(-0.8*sin(2*x - 0.5*t))",
                    C = "(1 + 0.5*sin(2*x + t))";
  const std::string F = "(-" + A_t + "*cos(pi*x)*sin(t) - " + A + "*" + u + " + " + B_x + "*pi*sin(pi*x)*cos(t) + " +
                        B + "*pi^2*" + u + " + " + C + "*(" + u + ")^3)";
  return "0.5*" + A + "*phi_t^2 - 0.5*" + B + "*phi_x^2 - 0.25*" + C + "*phi^4 + " + F + "*phi";
}
const Solution manufactured_solution = [](double t, const Mesh::Point& p) {
  return std::cos(M_PI * p[0]) * std::cos(t);
};

TEST_CASE("densities that read t and x converge with order 2 on meshes, and have the form formula") {
  const std::string moving = manufactured("(1.5 + 0.3*sin(x + 0.7*t))", "(0.21*cos(x + 0.7*t))");
  for (const bool quadrilaterals : {false, true}) {
    const auto error = [&](int n) {
      return error_of(rectangle_mesh(2, 0.5, 16 * n, 4 * n, quadrilaterals), expression(moving), false, 0.3,
                      manufactured_solution);
    };
    CHECK(std::log2(error(1) / error(2)) == Approx(2).margin(0.2));
  }
  const std::array times{0.0, 0.05, 0.12, 0.15, 0.19};
  const CellSpace space(rectangle_mesh(2, 1, 4, 3, false), expression(moving), false);
  const SpaceRows rows(space, times);
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> y(rows.system().nodes());
  for (double& value : y) value = 0.3 * normal(random);
  const ComplexForms form(rows.system(), drawn_region(rows.system(), 7, random), y);
  const auto V = form.first_variations(2, random);
  CHECK(form.linearised(V[0]) < 1e-12);
  CHECK(form.form_formula(V[0], V[1]).relative() < 1e-13);
}

TEST_CASE("rows stay where the problem without time puts a field, also where the gradient term reads x") {
  const auto density = expression("0.5*phi_t^2 - 0.5*(1 + 0.5*x^2)*phi_x^2 - 0.3*phi^2 + 0.1*phi^4");
  for (const bool quadrilaterals : {false, true}) {
    const CellSpace space(rectangle_mesh(2, 1, 6, 4, quadrilaterals), density, true);
    const ComplexSystem system = mesh_complex(space);
    std::vector<double> y = at_points(
        space.mesh, [](double, const Mesh::Point& p) { return std::cos(p[0]) * p[1]; }, 0);
    const std::vector<double> start = y;
    ComplexSolver(system).solve(y);
    const auto moved = [&](const std::vector<double>& values) {
      MeshRows rows(space, 0.01);
      rows.start(values, std::vector<double>(values.size(), 0.0));
      while (rows.newest() < 10) rows.step();
      double most = 0;
      for (std::size_t i = 0; i < values.size(); ++i) most = std::max(most, std::abs(rows.row()[i] - values[i]));
      return most;
    };
    CHECK(moved(y) < 1e-13);
    CHECK(moved(start) > 1e-3);
  }
}

TEST_CASE("cells with steps of their own read t and x when they act: of order 2 in their steps") {
  const CellSpace space(graded_interval(2, 21, 0.97), expression(manufactured("1", "0")), false);
  const auto values = [&](double courant) {
    std::vector<double> steps;
    for (int c = 0; c < space.mesh.cells(); ++c) {
      const auto cell = space.mesh.cell(c);
      steps.push_back(courant * std::abs(space.mesh.points[cell[1]][0] - space.mesh.points[cell[0]][0]));
    }
    MeshCells cells(space, steps);
    const std::vector<double> start = at_points(space.mesh, manufactured_solution, 0);
    cells.stepper.start_rates(start, std::vector<double>(start.size(), 0.0));
    cells.stepper.advance(1);
    return cells.stepper.values(1);
  };
  const std::vector<double> limit = values(0.4 / 64), exact = at_points(space.mesh, manufactured_solution, 1);
  const auto distance = [&](const std::vector<double>& now) {
    double sum = 0;
    for (std::size_t i = 0; i < now.size(); ++i) sum += space.masses[i] * std::pow(now[i] - limit[i], 2);
    return std::sqrt(sum);
  };
  CHECK(distance(exact) < 0.02);  // of the mesh alone
  const double order = std::log2(distance(values(0.1)) / distance(values(0.025))) / 2;
  CHECK(order > 1.7);
  CHECK(order < 2.4);
}

TEST_CASE("a density that cells cannot have is refused") {
  for (const char* text : {"0.5*phi_t^2 - 0.5*phi_x^2 + phi_t*phi_x", "0.5*phi_t^2 - phi_x^4",
                           "0.5*(1 + phi^2)*phi_t^2 - 0.5*phi_x^2", "0.5*phi_t^2 - 0.5*phi_x^2 - phi_x"})
    CHECK_THROWS_WITH(SpaceTables(expression(text)), Catch::Contains("needs a density T(phi_t) + V(phi, grad phi)"));
  CHECK_NOTHROW(SpaceTables(expression("0.5*phi_t^2 - 0.5*(1 + phi^2)*phi_x^2")));
}

}  // namespace
