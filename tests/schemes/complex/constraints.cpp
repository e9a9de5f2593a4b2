// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <functional>

#include "lattice/error.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/wave_map.hpp"
#include "schemes/verify/fitted_multipliers.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/complex_forms.hpp"
#include "tests/schemes/complex/mesh_rows.hpp"
#include "tests/schemes/complex/space_complex.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

CellSpace sphere_valued(Mesh mesh, bool fixed) {
  const TheoryOf<WaveMap> theory{WaveMap{}};
  return {std::move(mesh), theory.shared_density(), fixed, theory.constraint()};
}

using Vector = std::array<double, 3>;
using Map = std::function<Vector(double t, const Mesh::Point&)>;

std::vector<double> at_points(const Mesh& mesh, const Map& u, double t) {
  std::vector<double> values;
  for (const Mesh::Point& p : mesh.points)
    for (const double value : u(t, p)) values.push_back(value);
  return values;
}
std::vector<double> rates_at(const Mesh& mesh, const Map& u) {
  std::vector<double> late = at_points(mesh, u, 1e-5), early = at_points(mesh, u, -1e-5);
  for (std::size_t n = 0; n < late.size(); ++n) late[n] = (late[n] - early[n]) / 2e-5;
  return late;
}
double distance(const CellSpace& space, std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += space.masses[n / 3] * (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum);
}

/// The error at t = 1 of a wave map, with h in proportion to the mesh.
double error_of(Mesh mesh, const Map& u) {
  const CellSpace space = sphere_valued(std::move(mesh), false);
  const int steps = static_cast<int>(std::ceil(1 / (0.3 * shortest_edge(space.mesh))));
  MeshRows evolution(space, 1.0 / steps, TheoryOf<WaveMap>{WaveMap{}}.constraint());
  CHECK(evolution.evolution().plan().blocks == space.sites());
  evolution.start(at_points(space.mesh, u, 0), rates_at(space.mesh, u));
  while (evolution.newest() < steps) {
    evolution.step();
    CHECK(evolution.evolution().stepper().iterations() < 8);
  }
  CHECK(space.largest_constraint(evolution.row()) < 1e-13);
  CHECK(evolution.residual() < 1e-13);
  return distance(space, evolution.row(), at_points(space.mesh, u, 1));
}

/// On a great circle: θ solves the wave equation, and u = cos θ e₁ + sin θ e₂ is a wave map.
Map on_great_circle(const std::function<double(double, const Mesh::Point&)>& angle) {
  return [=](double t, const Mesh::Point& p) {
    const double c = std::cos(angle(t, p)), s = std::sin(angle(t, p));
    return Vector{0.6 * c, s, 0.8 * c};
  };
}

/// (tanh s cos ωt, tanh s sin ωt, sech s), s = ω(x − x₀): a soliton of the string that is turned about its axis. With
/// u = (sin ψ cos ωt, sin ψ sin ωt, cos ψ) the wave map equation is ψ_xx + ω² sin ψ cos ψ = 0, and sin ψ = tanh s solves it.
Vector turning(double t, const Mesh::Point& p) {
  const double s = p[0] - 12;
  return {std::tanh(s) * std::cos(t), std::tanh(s) * std::sin(t), 1 / std::cosh(s)};
}

TEST_CASE("wave maps into the sphere converge with order 2 on plane regions, blocks of four unknowns a point") {
  const Map standing = on_great_circle([](double t, const Mesh::Point& p) {
    return 0.4 * t + 0.8 * std::cos(M_PI * p[0]) * std::cos(M_PI * p[1]) * std::cos(M_PI * std::sqrt(2.0) * t);
  });
  for (const bool quadrilaterals : {false, true}) {
    const auto error = [&](int n) { return error_of(rectangle_mesh(1, 1, 8 * n, 8 * n, quadrilaterals), standing); };
    CHECK(std::log2(error(1) / error(2)) == Approx(2).margin(0.25));
  }
  const auto error = [](int n) { return error_of(graded_interval(24, 96 * n + 1, 1), turning); };
  CHECK(std::log2(error(1) / error(2)) == Approx(2).margin(0.1));
}

TEST_CASE("on a sphere a wave map keeps constraint, energy and momenta, with equal steps and others") {
  const CellSpace space = sphere_valued(icosahedral_sphere(1), false);
  const auto band = [&](double h, bool equal) {
    MeshRows evolution(space, h, TheoryOf<WaveMap>{WaveMap{}}.constraint());
    std::vector<double> values, rates;
    for (const Mesh::Point& p : space.mesh.points) {
      const double a = 0.7 * p[2] + 0.3 * p[0], b = 0.5 * p[1];
      for (const double u : {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)}) values.push_back(u);
      for (const double v : {-0.5 * std::sin(a), 0.5 * std::cos(a), 0.0}) rates.push_back(v);
    }
    evolution.start(values, rates);
    const double start = evolution.energy();
    std::array<Balance, 3> first;
    const auto rotations = WaveMap::symmetries();
    for (std::size_t n = 0; n < 3; ++n) first[n] = evolution.momentum(rotations[n]);
    double early = 0, late = 0;
    for (int n = 0; evolution.time() < 20; ++n) {
      evolution.step(equal ? h : h * (n % 3 == 0 ? 0.8 : 1.1));
      double& most = evolution.time() < 5 ? early : late;
      most = std::max(most, std::abs(evolution.energy() / start - 1));
    }
    CHECK(space.largest_constraint(evolution.row()) < 1e-13);
    for (std::size_t n = 0; n < 3; ++n)
      CHECK(std::abs(evolution.momentum(rotations[n]).sum - first[n].sum) < 1e-12 * first[n].absolute);
    if (equal) CHECK(late < 1.5 * early);
    return std::max(early, late);
  };
  const double coarse = band(0.08, true), fine = band(0.04, true);
  CHECK(coarse < 0.02);
  CHECK(coarse / fine == Approx(4).margin(1));
  band(0.04, false);
}

/// The usual method's rows at these times.
LatticeSystem system_of_rows(const CellSpace& space, std::span<const double> times) {
  auto families = mesh_families(time_of_mesh_rows(), space.density, space);
  families.push_back(space.constraint);
  std::vector<Component> components = fields(space.fields());
  components.push_back({"lambda", Role::multiplier, {}});
  LatticeSystem system(Lattice::on(std::make_shared<MeshSpace>(space)), std::move(families), times[1] - times[0],
                       std::move(components));
  system.times()->set({times.begin(), times.end()});
  return system;
}

/// The largest |E|, relative to its terms, of rows with the multipliers that they have, or with those that fit them.
double residual_of(const LatticeSystem& system, const std::vector<std::vector<double>>& rows, bool fitted) {
  Window window = system.window(0, rows, 0);
  if (fitted) fit_multipliers(system, window);
  double sum = 0, terms = 0;
  std::vector<LatticeSystem::Value> E;
  for (std::int64_t row = 1; row < window.last_row(); ++row) {
    system.equations(window, row, E);
    for (std::size_t n = 0; n < E.size(); ++n)
      if (!system.lattice().is_fixed(static_cast<int>(n / 4)))
        sum = std::max(sum, std::abs(E[n].sum)), terms = std::max(terms, E[n].absolute);
  }
  return sum / terms;
}

TEST_CASE("the form formula holds on the constrained rows of a mesh, multipliers among the fields, and can fail") {
  const std::array times{0.0, 0.05, 0.12, 0.15, 0.19};
  for (const bool fixed : {false, true}) {
    const CellSpace space = sphere_valued(rectangle_mesh(1, 1, 4, 3, false), fixed);
    const SpaceRows rows(space, times);
    const ComplexSystem& system = rows.system();
    std::vector<double> y(system.nodes());
    const Map u = on_great_circle([](double t, const Mesh::Point& p) { return t * p[0] + p[1] * p[1]; });
    for (std::size_t j = 0; j < times.size(); ++j)
      std::ranges::copy(at_points(space.mesh, u, fixed ? 0 : times[j]),
                        y.begin() + static_cast<std::ptrdiff_t>(j * space.values_of_row()));
    ComplexSolver(system).solve(y);
    // the multipliers can be found from the fields alone
    const LatticeSystem of_rows = system_of_rows(space, times);
    std::vector<std::vector<double>> fields(times.size());
    for (std::size_t j = 0; j < times.size(); ++j) {
      const auto row = std::span(y).subspan(j * space.values_of_row(), space.fields_of_row());
      CHECK(space.largest_constraint(row) < 1e-13);
      for (std::size_t n = 0; n < row.size(); ++n) {
        fields[j].push_back(row[n]);
        if (n % 3 == 2) fields[j].push_back(0.5);  // any multiplier
      }
    }
    CHECK(residual_of(of_rows, fields, false) > 1e-3);
    CHECK(residual_of(of_rows, fields, true) < 1e-13);
    const std::size_t inside = std::ranges::find(space.fixed, 0) - space.fixed.begin();
    fields[2][4 * inside] += 1e-4;
    CHECK(residual_of(of_rows, fields, true) > 1e-6);

    std::mt19937_64 random(2);
    for (const int centres : {1, 7, 40}) {
      const ComplexForms form(system, drawn_region(system, centres, random), y);
      auto V = form.first_variations(2, random);
      CHECK(form.linearised(V[0]) < 1e-12);
      CHECK(form.form_formula(V[0], V[1]).relative() < 1e-13);
      CHECK(form.local_identity(V[0], V[1]).relative() < 1e-13);
      if (const auto node = form.coupling_node()) {
        V[0][*node] += 0.1;
        CHECK(form.form_formula(V[0], V[1]).relative() > 1e-6);
      }
    }
  }
}

TEST_CASE("a harmonic map of a square into the sphere converges with order 2") {
  // the inverse of the stereographic projection is conformal, and so harmonic
  const Map u = [](double, const Mesh::Point& p) {
    const double r2 = p[0] * p[0] + p[1] * p[1];
    return Vector{2 * p[0] / (1 + r2), 2 * p[1] / (1 + r2), (1 - r2) / (1 + r2)};
  };
  const auto error = [&](int n) {
    const CellSpace space = sphere_valued(rectangle_mesh(0.8, 0.8, n, n, false), true);
    const ComplexSystem system = mesh_complex(space);
    const std::vector<double> exact = at_points(space.mesh, u, 0);
    std::vector<double> y(system.nodes(), 0.0);
    for (std::size_t i = 0; i < exact.size(); ++i) y[i] = space.fixed[i / 3] ? exact[i] : i % 3 == 2;  // the north pole
    const ComplexSolver solver(system);
    CHECK(solver.solve(y).iterations < 12);
    CHECK(largest_residual(system, y) < 1e-13);
    const auto fields = std::span(y).first(exact.size());
    CHECK(space.largest_constraint(fields) < 1e-13);
    return distance(space, fields, exact);
  };
  CHECK(std::log2(error(8) / error(16)) == Approx(2).margin(0.15));
  CHECK(std::log2(error(16) / error(48)) == Approx(2 * std::log2(3.0)).margin(0.15));
}

TEST_CASE("a constant map into the sphere has the residual 0, though all its terms are rounding, and another has not") {
  const CellSpace space = sphere_valued(rectangle_mesh(1, 1, 6, 6, false), true);
  const ComplexSystem system = mesh_complex(space);
  std::vector<double> y(system.nodes(), 0.0);
  for (std::size_t i = 0; i < 3 * space.mesh.points.size(); ++i) y[i] = std::array{0.36, 0.48, 0.8}[i % 3];
  ComplexSolver(system).solve(y);
  CHECK(largest_residual(system, y) < 1e-14);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = 1e-9 * std::sin(static_cast<double>(i));
  CHECK(largest_residual(system, y) > 0.1);
}

TEST_CASE("cells refuse a constraint") {
  Problem problem;
  problem.theory = "wave-map";
  problem.lattice = Lattice::on(std::make_shared<CellSpace>(sphere_valued(icosahedral_sphere(0), false)));
  problem.time_step = 0.1;
  CHECK_NOTHROW(Simulation(problem));
  problem.cell_courant = 0.1;
  CHECK_THROWS_WITH(Simulation(problem), Catch::Contains("cells with steps of their own have no constraints"));
}

}  // namespace
