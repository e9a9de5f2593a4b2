// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/stencil_text.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "schemes/simulation.hpp"
#include "tests/catch.hpp"
#include "tests/verification/experiment.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A density that reads t and x, with a force F(t, x) φ which makes u a solution.
struct Manufactured {
  std::string density, solution;
};

/// ℓ = ½Aφ_t² + ¼Gφ_t⁴ − ½Bφ_x² − ¼Eφ_x⁴ − ¼Cφ⁴ + Fφ with all coefficients of t and x,
///
///     F = (Au_t + Gu_t³)_t − (Bu_x + Eu_x³)_x + Cu³        for u = w(x) cos(ct), w given with two derivatives
///
Manufactured nonlinear(const std::string& w, const std::string& w_x, const std::string& w_xx) {
  const std::string c = "cos(1.1*t)", s = "(-1.1*sin(1.1*t))";
  const auto times = [](const std::string& a, const std::string& b) { return fmt::format("(({})*({}))", a, b); };
  const std::string u = times(w, c), u_t = times(w, s), u_tt = times("-1.21", u), u_x = times(w_x, c),
                    u_xx = times(w_xx, c);
  const std::string A = "(1.5 + 0.5*sin(x + 0.7*t))", A_t = "(0.35*cos(x + 0.7*t))";
  const std::string B = "(1.2 + 0.4*cos(2*x - 0.5*t))", B_x = "(-0.8*sin(2*x - 0.5*t))";
  const std::string G = "(0.2 + 0.1*cos(x - t))", G_t = "(0.1*sin(x - t))";
  const std::string E = "(0.2 + 0.06*sin(x))", E_x = "(0.06*cos(x))", C = "(1 + 0.5*sin(2*x + t))";
  const std::string F = fmt::format(
      "({}*{} + {}*{} + {}*({})^3 + 3*{}*({})^2*{} - {}*{} - {}*{} - {}*({})^3 - 3*{}*({})^2*{} + {}*({})^3)", A_t, u_t,
      A, u_tt, G_t, u_t, G, u_t, u_tt, B_x, u_x, B, u_xx, E_x, u_x, E, u_x, u_xx, C, u);
  return {fmt::format("0.5*{}*phi_t^2 + 0.25*{}*phi_t^4 - 0.5*{}*phi_x^2 - 0.25*{}*phi_x^4 - 0.25*{}*phi^4 + {}*phi", A,
                      G, B, E, C, F),
          u};
}
/// Round a circle of length 2π.
Manufactured on_circle() {
  return nonlinear("(sin(x) + 0.3*cos(2*x))", "(cos(x) - 0.6*sin(2*x))", "(-sin(x) - 1.2*cos(2*x))");
}
/// Zero at 0 and π.
Manufactured with_nodes() {
  return nonlinear("(sin(x) + 0.3*sin(2*x))", "(cos(x) + 0.6*cos(2*x))", "(-sin(x) - 1.2*sin(2*x))");
}
/// Level at 0 and π.
Manufactured with_crests() {
  return nonlinear("(cos(x) + 0.3*cos(2*x))", "(-sin(x) - 0.6*sin(2*x))", "(-cos(x) - 1.2*cos(2*x))");
}

/// A triangle whose φ_t and φ_x lie on the edges at its first site.
constexpr const char* reversed_triangle[] = {"(0,0) (1,0) (0,1)", "1; phi: 1 0 0; phi_t: -1 1 0; phi_x: -1 0 1"};

Problem problem_of(const Manufactured& m, const std::string& stencil, const Lattice& lattice, double courant) {
  Problem p;
  p.theory = "text";
  p.parameters["theory.density"] = m.density;
  p.stencil = stencil;
  if (stencil == stencil_as_text)
    p.parameters["stencil.sites"] = reversed_triangle[0], p.parameters["stencil.point"] = reversed_triangle[1];
  p.lattice = lattice, p.time_step = courant * lattice.space_step();
  return p;
}

double error_of(const Problem& p, const std::string& solution, double until) {
  const Formula u(solution, {}, "exact.phi");
  const auto row = [&](double t) {
    Row values;
    for (int i = 0; i < p.lattice.sites(); ++i) values.push_back(u(t, p.lattice.position(i)));
    return values;
  };
  Simulation simulation(p);
  std::vector<Row> rows;
  for (int j = 0; j < simulation.starting_rows(); ++j) rows.push_back(row(j * p.time_step));
  simulation.start(rows);
  const auto steps = static_cast<std::int64_t>(std::lround(until / p.time_step));
  while (simulation.newest() < steps) simulation.step();
  return distance(newest(simulation, p.lattice), row(static_cast<double>(steps) * p.time_step));
}

std::vector<std::string> stencils_of_fields() {
  std::vector<std::string> names{stencil_as_text};
  for (const NamedTable& named : named_tables())
    if (!named.is_for_point()) names.push_back(named.name);
  return names;
}

void check_second_order(const Manufactured& m, const std::string& stencil, const std::function<Lattice(int)>& lattice,
                        int cells) {
  const auto error = [&](int n) { return error_of(problem_of(m, stencil, lattice(n), 0.4), m.solution, 0.8); };
  const double coarse = error(cells), fine = error(2 * cells), p = order(coarse, fine, 2);
  CAPTURE(stencil, coarse, fine, p);
  CHECK(p > 1.85);
  CHECK(p < 2.2);
}

}  // namespace

TEST_CASE("densities with nonlinear terms of t and x are of second order on every stencil") {
  for (const std::string& stencil : stencils_of_fields())
    check_second_order(
        on_circle(), stencil, [](int n) { return Lattice::circle(n, 2 * std::numbers::pi); }, 40);
}

TEST_CASE("and between fixed and natural walls") {
  for (const std::string& stencil : stencils_of_fields()) {
    if (stencil == "hexagon" || stencil == stencil_as_text) continue;
    for (const Wall wall : {Wall::fixed, Wall::natural})
      check_second_order(
          wall == Wall::fixed ? with_nodes() : with_crests(), stencil,
          [wall](int n) { return Lattice::interval(n + 1, std::numbers::pi, wall, wall); }, 24);
  }
}

namespace {

/// ℓ = ½Aφ_t² − ½Bφ_x² − ¼Eφ_x⁴ − ¼Cφ⁴ + Fφ round a circle, B, E and C of t and x, with u = (sin x + 0.3 cos 2x) cos 1.1t.
Manufactured for_sub_steps(const std::string& A, const std::string& A_t) {
  const std::string w = "(sin(x) + 0.3*cos(2*x))", c = "cos(1.1*t)", u = w + "*" + c,
                    u_t = "(-1.1*" + w + "*sin(1.1*t))", u_x = "((cos(x) - 0.6*sin(2*x))*" + c + ")",
                    u_xx = "((-sin(x) - 1.2*cos(2*x))*" + c + ")";
  const std::string B = "(1.2 + 0.4*cos(2*x - 0.5*t))", B_x = "(-0.8*sin(2*x - 0.5*t))", E = "(0.2 + 0.06*sin(x))",
                    E_x = "(0.06*cos(x))", C = "(1 + 0.5*sin(2*x + t))";
  return {fmt::format("0.5*{0}*phi_t^2 - 0.5*{2}*phi_x^2 - 0.25*{4}*phi_x^4 - 0.25*{6}*phi^4 + phi*({1}*{7} - "
                      "1.21*{0}*{9} - {3}*{8} - {2}*{10} - {5}*{8}^3 - 3*{4}*{8}^2*{10} + {6}*({9})^3)",
                      A, A_t, B, B_x, E, E_x, C, u_t, u_x, u, u_xx),
          u};
}

/// The error at t ≈ 0.8 of a composition, started by the Legendre transform.
double error_of_composition(const Manufactured& m, int order_in_time, int order_in_space, int sites) {
  Problem p = problem_of(m, "", Lattice::circle(sites, 2 * std::numbers::pi), 0.4);
  p.method = "composition";
  p.parameters["scheme.order"] = order_in_time, p.parameters["lattice.space_order"] = order_in_space;
  const Formula u(m.solution, {}, "exact.phi");
  Row values, rates;
  for (int i = 0; i < sites; ++i) {
    values.push_back(u(0, p.lattice.position(i)));
    rates.push_back(u.by_t(0, p.lattice.position(i)));
  }
  Simulation simulation(p);
  const auto d = simulation.components().size();
  const auto spread = [&](const Row& row) {
    Row all(row.size() * d);
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = row[n / d];
    return all;
  };
  simulation.start_legendre(spread(values), spread(rates));
  const auto steps = static_cast<std::int64_t>(std::lround(0.8 / p.time_step));
  while (simulation.newest() < steps) simulation.step();
  Row exact;
  for (int i = 0; i < sites; ++i) exact.push_back(u(static_cast<double>(steps) * p.time_step, p.lattice.position(i)));
  return distance(newest(simulation, p.lattice), exact);
}

}  // namespace

TEST_CASE("compositions of densities that read t and x are of their order") {
  const Manufactured of_x = for_sub_steps("(1.5 + 0.5*sin(x))", "0"),
                     of_t = for_sub_steps("(1.5 + 0.5*sin(x + 0.7*t))", "(0.35*cos(x + 0.7*t))");
  struct Case {
    const Manufactured& density;
    int time, space, sites;
  };
  for (const auto& [density, time, space, sites] : {Case{of_x, 4, 4, 32}, Case{of_t, 8, 4, 32}, Case{of_t, 2, 2, 32}}) {
    const double coarse = error_of_composition(density, time, space, sites),
                 fine = error_of_composition(density, time, space, 2 * sites), p = order(coarse, fine, 2);
    CAPTURE(time, space, coarse, fine, p);
    CHECK(p > std::min(time, space) - 0.3);
    CHECK(p < std::min(time, space) + 0.5);
  }
}

TEST_CASE("compositions refuse what would cost them their order") {
  const auto key = [](Problem p, const char* order) {
    p.method = "composition";
    p.parameters["scheme.order"] = order[0] - '0';
    p.parameters["lattice.space_order"] = order[2] - '0';
    try {
      Simulation{p};
    } catch (const BadInput& bad) {
      return bad.key();
    }
    return std::string();
  };
  const Manufactured of_x = for_sub_steps("(1.5 + 0.5*sin(x))", "0"),
                     of_t = for_sub_steps("(1.5 + 0.5*sin(x + 0.7*t))", "(0.35*cos(x + 0.7*t))");
  const Lattice circle = Lattice::circle(32, 2 * std::numbers::pi),
                interval = Lattice::interval(33, 2 * std::numbers::pi);
  CHECK(key(problem_of(of_t, "", circle, 0.4), "4 4") == "theory.name");
  CHECK(key(problem_of(of_x, "", circle, 0.4), "4 4").empty());
  CHECK(key(problem_of(of_x, "", interval, 0.4), "4 4") == "lattice.space_order");
  CHECK(key(problem_of(of_x, "", interval, 0.4), "4 2").empty());
}

TEST_CASE("what couples phi with its derivatives and reads x is of second order on triangles too") {
  // ℓ = ½(1 + φ²)a(x)φ_t² − ½(1 + φ²)b(x)φ_x² + Fφ, u = w(x) cos t:
  // F = a[(1 + u²)u_tt + uu_t²] − (b(1 + u²)u_x)_x + b u u_x²
  const Manufactured m{
      "0.5*(1 + phi^2)*((1.5 + 0.5*sin(x))*phi_t^2 - (1.2 + 0.4*cos(x))*phi_x^2) + phi*("
      "(1.5 + 0.5*sin(x))*(-(1 + (0.5*sin(x)*cos(t))^2)*0.5*sin(x)*cos(t) + 0.5*sin(x)*cos(t)*(0.5*sin(x)*sin(t))^2)"
      " + 0.4*sin(x)*(1 + (0.5*sin(x)*cos(t))^2)*0.5*cos(x)*cos(t)"
      " + (1.2 + 0.4*cos(x))*((1 + (0.5*sin(x)*cos(t))^2)*0.5*sin(x)*cos(t) - "
      "0.5*sin(x)*cos(t)*(0.5*cos(x)*cos(t))^2))",
      "0.5*sin(x)*cos(t)"};
  for (const char* stencil : {"triangle", "triangle-vertex", "rectangle"})
    check_second_order(
        m, stencil, [](int n) { return Lattice::circle(n, 2 * std::numbers::pi); }, 32);
}
