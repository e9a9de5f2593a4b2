// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/tables/named_splittings.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/splitting.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/mesh_energy.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/mesh_rows.hpp"
#include "tests/schemes/complex/space_complex.hpp"

namespace {

using namespace delf;
using delf::testing::MeshRows;
using delf::testing::SpaceRows;
using Values = std::vector<double>;

ParameterValues keys(std::initializer_list<std::pair<const char*, ParameterValue>> given) {
  ParameterValues values;
  for (const auto& [key, value] : given) values[key] = value;
  return values;
}

/// A scheme of lattices on a mesh, from a pulse with a rate of its own.
struct OnMesh {
  Problem problem;
  std::shared_ptr<const MeshSpace> space;

  OnMesh(Mesh mesh, const std::string& method, ParameterValues keys, bool fixed = false,
         std::string theory = "sine-gordon") {
    MeshSpace made{std::move(mesh), {}};
    made.fixed.assign(made.mesh.points.size(), 0);
    if (fixed)
      for (const auto p : boundary_points(made.mesh)) made.fixed[p] = 1;
    space = std::make_shared<const MeshSpace>(std::move(made));
    problem.theory = std::move(theory);
    problem.method = method;
    problem.parameters = std::move(keys);
    problem.lattice = Lattice::on(space);
  }
  /// The field and, behind it, its rates: [i·d + a] each.
  Values pulse(int d, bool rates) const {
    Values values;
    for (std::size_t i = 0; i < space->mesh.points.size(); ++i)
      for (int a = 0; a < d; ++a) {
        const auto& [x, y, z] = space->mesh.points[i];
        const double pulse = 2 * std::exp(-3 * ((x - 1) * (x - 1) + y * y + z * z));
        values.push_back(rates ? (space->fixed[i] ? 0 : 0.3 * (a + y)) : pulse + 0.2 * a * z);
      }
    return values;
  }
  std::unique_ptr<Simulation> started(double h) {
    problem.time_step = h;
    auto simulation = std::make_unique<Simulation>(problem);
    const int d = simulation->theory().components();
    const Values field = pulse(d, false), rate = pulse(d, true);
    Values row, velocity;
    for (std::size_t i = 0; i < space->mesh.points.size(); ++i)
      for (const Component& c : simulation->components()) {
        const std::size_t at = i * delf::at(d) + delf::at(c.field);
        row.push_back(c.role == Role::multiplier ? 0 : field[at]);
        velocity.push_back(c.role == Role::field ? rate[at] : 0);
      }
    simulation->start_legendre(row, velocity);
    return simulation;
  }
  static Values fields(const Simulation& simulation) {
    Values row(delf::at(simulation.evolution().system().lattice().sites()) *
               delf::at(simulation.theory().components()));
    simulation.copy_row(0, row);
    return row;
  }
  Values at_one(int steps) {
    const auto simulation = started(1.0 / steps);
    simulation->steps(steps - 1);
    return fields(*simulation);
  }
};

double distance(const Values& a, const Values& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

const ParameterValues verlet = keys({{"scheme.tableau", std::string("stormer-verlet")}});

/// Row `steps` of the complex of all rows at once, from rows 0 and 1.
Values rows_as_complex(const OnMesh& on, const std::shared_ptr<const BatchDensity>& density, bool fixed, double h,
                       int steps, const Values& row0, const Values& row1) {
  const CellSpace space(on.space->mesh, density, fixed);
  Values times;
  for (int n = 0; n <= steps; ++n) times.push_back(n * h);
  const SpaceRows rows(space, times);
  Values y;
  for (int n = 0; n <= steps; ++n)
    y.insert(y.end(), n == 0 ? row0.begin() : row1.begin(), n == 0 ? row0.end() : row1.end());
  ComplexSolver(rows.system()).solve(y);
  return {y.end() - static_cast<std::ptrdiff_t>(row0.size()), y.end()};
}

/// The same by lattices' families and stepper, for a density that no registry has.
Evolution by_families(const OnMesh& on, const StencilTable& time, const std::shared_ptr<const BatchDensity>& density,
                      double h, int steps, std::vector<Component> components = {}) {
  Evolution evolution(Lattice::on(on.space), mesh_families(time, density, *on.space, !components.empty()), h, {},
                      std::move(components));
  const int C = evolution.system().components();
  const Values field = on.pulse(1, false), rate = on.pulse(1, true), masses = lumped_masses(on.space->mesh);
  Values row, p;
  for (std::size_t i = 0; i < field.size(); ++i)
    for (int c = 0; c < C; ++c) row.push_back(field[i]), p.push_back(c == 0 ? masses[i] * rate[i] : 0);
  evolution.stepper().start_legendre(row, p);
  evolution.stepper().steps(steps - 1);
  return evolution;
}
Values rows_by_families(const OnMesh& on, const std::shared_ptr<const BatchDensity>& density, double h, int steps) {
  TablePoint lower{.weight = 0.5, .time = 0, .slots = {}}, upper{.weight = 0.5, .time = 1, .slots = {}};
  for (TablePoint* point : {&lower, &upper}) {
    point->set(JetSlot::phi, {point == &lower ? 1.0 : 0.0, point == &upper ? 1.0 : 0.0});
    point->set(JetSlot::phi_t, {-1, 1});
  }
  const StencilTable trapezoidal{.pattern = StencilPattern({{0, 0}, {1, 0}}), .points = {lower, upper}};
  return by_families(on, trapezoidal, density, h, steps).stepper().row(0);
}

}  // namespace

TEST_CASE("families of a time table on a mesh have the rows of a finite complex of the same stencils") {
  const Mesh clipped = [] {  // triangles and quadrilaterals side by side
    Mesh mesh{.points = {}, .vertices = {}};
    for (int j = 0; j <= 6; ++j)
      for (int i = 0; i <= 6; ++i) mesh.points.push_back({0.3 * i + 0.02 * j * (i % 2), 0.25 * j, 0});
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        const int n = 7 * j + i;
        if ((i + j) % 2) mesh.add_cell(std::vector<std::int32_t>{n, n + 1, n + 8, n + 7});
        else
          mesh.add_cell(std::vector<std::int32_t>{n, n + 1, n + 8}),
              mesh.add_cell(std::vector<std::int32_t>{n, n + 8, n + 7});
      }
    return mesh;
  }();
  for (const char* text :
       {"0.5*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)", "0.5*phi_t^2 - 0.5*(1 + 0.3*phi^2)*phi_x^2 - phi^4",
        "0.5*phi_t^2 - 0.5*(1 + 0.2*x^2)*phi_x^2 - (1 + 0.1*x + sin(t))*phi^4"})
    for (const bool fixed : {false, true}) {
      CAPTURE(text, fixed);
      const auto density = expression(text);
      for (const Mesh& mesh : {clipped, graded_interval(2, 21, 1.1), icosahedral_sphere(1)}) {
        if (fixed && boundary_points(mesh).empty()) continue;
        // A gradient that reads x does so at Gauss's points of a quadrilateral, and in the complex at its middle.
        if (std::string(text).find("x^2)") != std::string::npos && mesh.cells() == clipped.cells()) continue;
        const OnMesh on(mesh, "cgvi", verlet, fixed);
        const Values row1 = rows_by_families(on, density, 0.02, 1), row40 = rows_by_families(on, density, 0.02, 40);
        CHECK(distance(rows_as_complex(on, density, fixed, 0.02, 40, on.pulse(1, false), row1), row40) < 1e-12);
      }
    }
  // A mass that is another's is seen.
  const OnMesh on(clipped, "cgvi", verlet), other(icosahedral_sphere(1), "cgvi", verlet);
  const auto half = expression("0.25*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)");
  CHECK(distance(rows_as_complex(on, expression("0.5*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)"), false, 0.02, 40,
                                 on.pulse(1, false), rows_by_families(on, half, 0.02, 1)),
                 rows_by_families(on, half, 0.02, 40)) > 1e-3);
}

TEST_CASE("methods of lattices have their orders in time on a sphere") {
  struct Case {
    std::string method;
    ParameterValues keys;
    double order;
    int steps;
  };
  for (const Case& c :
       {Case{"cgvi", keys({{"scheme.tableau", std::string("gauss1")}}), 2, 40},
        Case{"cgvi", keys({{"scheme.tableau", std::string("gauss2")}}), 4, 20},
        Case{"cgvi", keys({{"scheme.tableau", std::string("lobatto3")}}), 4, 20},
        Case{"radau-iia", keys({{"scheme.stages", 2}}), 3, 20}, Case{"composition", keys({{"scheme.order", 2}}), 2, 40},
        Case{"composition", keys({{"scheme.order", 4}}), 4, 16},
        Case{"composition", keys({{"scheme.order", 6}}), 6, 12}}) {
    CAPTURE(c.method, c.order);
    OnMesh on(icosahedral_sphere(1), c.method, c.keys);
    const Values coarse = on.at_one(c.steps), middle = on.at_one(2 * c.steps), fine = on.at_one(4 * c.steps);
    const double order = std::log2(distance(coarse, middle) / distance(middle, fine));
    CHECK(order > c.order - 0.3);
    CHECK(order < c.order + 0.3);
  }
}

TEST_CASE("on a sphere variational methods keep the charge of a complex field, and Radau IIA loses it") {
  const auto lost = [](const std::string& method, ParameterValues keys) {
    OnMesh on(icosahedral_sphere(1), method, std::move(keys), false, "complex-klein-gordon");
    const auto simulation = on.started(0.05);
    const auto charge = [&](Side side, int back) {
      const Stepper& stepper = simulation->evolution().stepper();
      const LatticeSystem& system = simulation->evolution().system();
      const Window rows = stepper.window(2);
      const Values p = half_equations(system, rows, stepper.newest() - back, side);
      double sum = 0;
      const int C = system.components();
      for (int i = 0; i < system.lattice().sites(); ++i) {
        const std::size_t at = i * C;
        sum += p[at] * rows(stepper.newest() - back, i, 1) - p[at + 1] * rows(stepper.newest() - back, i, 0);
      }
      return sum;
    };
    const double first = charge(Side::above, 1);
    REQUIRE(std::abs(first) > 0.1);
    simulation->steps(100);
    return std::abs(charge(Side::below, 0) - first) / std::abs(first);
  };
  CHECK(lost("cgvi", keys({{"scheme.tableau", std::string("gauss2")}})) < 1e-12);
  CHECK(lost("composition", keys({})) < 1e-12);
  CHECK(lost("radau-iia", keys({{"scheme.stages", 2}})) > 1e-8);
}

TEST_CASE("the energy of a row of a mesh is that of its rates and gradients") {
  const OnMesh on(rectangle_mesh(1, 1, 8, 8, false), "cgvi", verlet);
  const MeshEnergy energy(expression("0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2 + 7"), *on.space);
  Values values, rates;
  for (const Mesh::Point& p : on.space->mesh.points) values.push_back(2 * p[0] - p[1]), rates.push_back(3);
  // ½ 9 + ½ |(2, −1)|² + Σ A_i ½ φ_i² − 7
  double potential = 0;
  const Values masses = lumped_masses(on.space->mesh);
  for (std::size_t i = 0; i < values.size(); ++i) potential += 0.5 * masses[i] * values[i] * values[i];
  CHECK(energy(values, rates, 0) == Approx(4.5 + 2.5 + potential - 7).epsilon(1e-12));
  Values p;
  for (std::size_t i = 0; i < values.size(); ++i) p.push_back(3 * masses[i]);
  CHECK(distance(energy.rates(values, p, 0), rates) < 1e-12);
}

TEST_CASE("the sub-steps of a composition on a mesh are solved in turn, without iteration") {
  OnMesh on(icosahedral_sphere(1), "composition", {});
  const auto simulation = on.started(0.05);
  simulation->step();
  CHECK(simulation->iterations() == 0);
  CHECK(simulation->residual() < 1e-14);
  // Kicks that are no sparse product and a function of the field are solved level by level.
  const OnMesh mesh(icosahedral_sphere(1), "composition", {});
  const StencilTable time = splitting_element(splitting_of_order(4));
  std::vector<Component> components = fields(1);
  for (std::size_t s = 1; s < time.nodes.size(); ++s)
    components.push_back({"phi after " + std::to_string(s), Role::inner, time.nodes[s], false, 0});
  const auto coupled =
      by_families(mesh, time, expression("0.5*phi_t^2 - 0.5*(1 + 0.3*phi^2)*phi_x^2 - phi^4"), 0.02, 20, components);
  CHECK(coupled.stepper().iterations() == 0);
  CHECK(coupled.stepper().residual() < 1e-13);
  OnMesh implicit(icosahedral_sphere(1), "cgvi", keys({{"scheme.tableau", std::string("gauss2")}}));
  const auto iterated = implicit.started(0.05);
  iterated->step();
  CHECK(iterated->iterations() > 1);
}

TEST_CASE("a mesh whose every point keeps its value, and a stencil with neighbours, are refused there") {
  OnMesh on(rectangle_mesh(1, 1, 1, 1, true), "cgvi", verlet, true);
  CHECK_THROWS_AS(on.started(0.1), BadInput);
  OnMesh spacetime(icosahedral_sphere(0), "spacetime", {});
  CHECK_THROWS_AS(spacetime.started(0.1), BadInput);
}

TEST_CASE("a splitting steps a body whose potential has no value at 0") {
  Problem p;
  p.theory = "kepler", p.method = "composition", p.lattice = Lattice::point(), p.time_step = 0.01;
  Simulation simulation(p);
  Values row, momenta;
  for (const Component& c : simulation.components()) {
    row.push_back(c.field == 0 ? 1 : 0);
    momenta.push_back(c.role == Role::field && c.field == 1 ? 1 : 0);
  }
  simulation.start_momenta(row, momenta);
  simulation.steps(99);
  const Values q = OnMesh::fields(simulation);  // a circle of radius 1, once around in 2π
  CHECK(q[0] == Approx(std::cos(1.0)).epsilon(1e-8));
  CHECK(q[1] == Approx(std::sin(1.0)).epsilon(1e-8));
}

TEST_CASE("the nodes between two rows are those below the newest row, whether rows before it were looked at or not") {
  for (const bool looked_at : {true, false}) {
    CAPTURE(looked_at);
    Problem problem{.theory = "pendulum", .lattice = Lattice::point(), .method = "composition", .time_step = 0.01};
    Simulation simulation(problem);
    const Values start(simulation.components().size(), 1.0), rates(start.size(), 2.0);
    simulation.start_legendre(start, rates);
    for (int n = 0; n < 20; ++n) simulation.step(looked_at || n == 19);
    Values newest(1), before(1), nodes(delf::at(simulation.count(Role::inner)));
    simulation.copy_row(0, newest), simulation.copy_row(1, before), simulation.copy_row(0, nodes, Role::inner);
    REQUIRE_FALSE(nodes.empty());
    const double step = newest[0] - before[0];
    for (const double node : nodes) CHECK(std::abs(node - (newest[0] + before[0]) / 2) < 1.5 * std::abs(step));
    // six rows before they are elsewhere
    CHECK(std::abs(newest[0] - start[0]) > 10 * std::abs(step));
  }
}

TEST_CASE("rows of steps in turn on a mesh are those of the steps by themselves, and end where they are to") {
  OnMesh on(icosahedral_sphere(1), "multisymplectic", {});
  on.problem.time_steps = {0.03, 0.05, 0.02};
  const auto simulation = on.started(0.03);
  while (simulation->newest() < 60) simulation->step(simulation->newest() % 7 == 0);
  CHECK(simulation->time(60) == Approx(2).epsilon(1e-13));
  const CellSpace space(on.space->mesh, expression("0.5*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)"), false);
  MeshRows rows(space, 0.03);
  rows.start(on.pulse(1, false), on.pulse(1, true));
  while (rows.newest() < 60) rows.step(on.problem.time_steps[delf::at(rows.newest()) % 3]);
  CHECK(distance(OnMesh::fields(*simulation), rows.row()) < 1e-13);
  on.problem.time_steps = {};
  CHECK(distance(OnMesh::fields(*simulation), on.at_one(60)) > 1e-3);
}
