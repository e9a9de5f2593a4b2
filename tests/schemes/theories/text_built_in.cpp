// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

/// A built-in theory, and what a scene would write in its place.
struct Pair {
  std::string name, density;
  std::string fields = "phi", parameters = "", constraint = "", symmetry = "";
  int components = 1;
  double size = 1;  ///< of the motion that it starts with
};

const std::vector<Pair> on_a_circle{
    {"wave", "0.5*(phi_t^2 - phi_x^2)"},
    {"klein-gordon", "0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*m^2*phi^2", "phi", "m = 1"},
    {"sine-gordon", "0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)", "phi", "m = 1"},
    {"phi4", "0.5*(phi_t^2 - phi_x^2) - 0.25*lambda*(phi^2 - 1)^2", "phi", "lambda = 1"},
    {"double-sine-gordon", "0.5*(phi_t^2 - phi_x^2) + cosm1(phi) + 0.5*cosm1(2*phi)"},
    {"sine-gordon-impurity", "0.5*(phi_t^2 - phi_x^2) + (1 + exp(-x^2))*cosm1(phi)"},
    {"coupled-sine-gordon", "0.5*(u_t^2 - u_x^2 + v_t^2 - v_x^2) + cosm1(u) + cosm1(v) + cosm1(u - v)", "u, v", "", "",
     "", 2},
    {"complex-klein-gordon", "let s = u^2 + v^2; 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2) - 0.5*s - 0.25*s^2", "u, v", "",
     "", "-v, u", 2},
    {"wave-map", "0.5*(u_t^2 + v_t^2 + w_t^2 - u_x^2 - v_x^2 - w_x^2)", "u, v, w", "", "u^2 + v^2 + w^2 - 1",
     "0, -w, v; w, 0, -u; -v, u, 0", 3}};
const std::vector<Pair> on_a_point{
    {"pendulum", "0.5*phi_t^2 + cosm1(phi)"},
    {"harmonic-oscillator", "0.5*phi_t^2 - 0.5*phi^2"},
    {"kepler", "0.5*(u_t^2 + v_t^2) + 1/sqrt(u^2 + v^2)", "u, v", "", "", "-v, u", 2},
    {"henon-heiles", "0.5*(u_t^2 + v_t^2) - 0.5*(u^2 + v^2) - u^2*v + v^3/3", "u, v", "", "", "", 2, 0.3},
    {"double-pendulum", "u_t^2 + 0.5*v_t^2 + u_t*v_t*cos(u - v) + 2*cosm1(u) + cosm1(v)", "u, v", "", "", "", 2}};

Problem problem(const Pair& pair, const std::string& stencil, bool as_text, bool point, bool planted = false) {
  Problem p;
  p.stencil = stencil;
  p.lattice = point ? Lattice::point() : Lattice::circle(24, 6);
  p.time_step = point ? 0.05 : 0.4 * p.lattice.space_step();
  p.theory = as_text ? "text" : pair.name;
  if (!as_text) return p;
  const auto set = [&](const char* key, const std::string& text) {
    if (!text.empty()) p.parameters[key] = text;
  };
  set("theory.density",
      !planted ? pair.density : pair.density + " + 0.01*cos(" + pair.fields.substr(0, pair.fields.find(',')) + ")");
  set("theory.fields", pair.fields);
  set("theory.parameters", pair.parameters);
  set("theory.constraint", pair.constraint);
  if (!planted) set("theory.symmetry", pair.symmetry);
  return p;
}

/// Two rows of a smooth motion; of unit length where there is a constraint.
std::vector<std::vector<double>> start(const Problem& p, const Pair& pair) {
  const int d = pair.components, C = d + (pair.constraint.empty() ? 0 : 1), N = p.lattice.sites();
  std::vector<std::vector<double>> rows(2, std::vector<double>(static_cast<std::size_t>(N * C)));
  for (int r = 0; r < 2; ++r)
    for (int i = 0; i < N; ++i) {
      const double angle = 2 * std::numbers::pi * i / N, t = r * p.time_step;
      double* const y = &rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(i * C)];
      double length = 0;
      for (int a = 0; a < d; ++a) {
        y[a] = (a == 0 ? 0.9 : 0.1) + 0.3 * std::sin(angle + a) + 0.2 * t * std::cos(angle + 2 * a) + (a == 1 ? t : 0);
        y[a] *= pair.size;
        length += y[a] * y[a];
      }
      if (!pair.constraint.empty())
        for (int a = 0; a < d; ++a) y[a] /= std::sqrt(length);
    }
  return rows;
}

struct Result {
  std::string plan;
  std::vector<double> row;
  std::vector<double> conserved;
  double energy = 0;
};

Result result(const Problem& p, const Pair& pair, int steps) {
  Simulation simulation(p);
  simulation.start(start(p, pair));
  simulation.steps(steps);
  simulation.step();
  std::vector<double> row(static_cast<std::size_t>(p.lattice.sites() * pair.components));
  simulation.copy_row(0, row);
  const auto monitors = simulation.monitors();
  return {simulation.solve_summary(), row, monitors.conserved, monitors.energy};
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, a[i] == b[i] ? 0 : std::abs(a[i] - b[i]));
  return worst;
}

void compare(const Pair& pair, const std::string& stencil, bool point, int steps) {
  INFO(pair.name << " on " << stencil);
  const Result built_in = result(problem(pair, stencil, false, point), pair, steps);
  const Result text = result(problem(pair, stencil, true, point), pair, steps);
  CHECK(text.plan == built_in.plan);
  CHECK(distance(text.row, built_in.row) < 1e-12);
  CHECK(distance(text.conserved, built_in.conserved) < 1e-12);
  CHECK(text.energy == Approx(built_in.energy).epsilon(1e-12).margin(1e-12));
  CHECK(distance(result(problem(pair, stencil, true, point, true), pair, std::min(steps, 50)).row,
                 result(problem(pair, stencil, false, point), pair, std::min(steps, 50)).row) > 1e-7);  // it can fail
}

bool fits(const NamedTable& table, bool point) { return table.is_for_point() == point; }

/// As long as rounding is below what is compared. Staggered waves grow from it, on an even circle linearly and off the
/// sphere like e^t, and the phase of a planet is off by its square.
int steps_of(const Pair& pair, const std::string& stencil) {
  if (stencil == "rectangle-symmetric" || stencil == "nine-tuple") return pair.constraint.empty() ? 300 : 30;
  return pair.density.find("1/sqrt") != std::string::npos ? 300 : 1000;
}

}  // namespace

TEST_CASE("built-in theories written as text have the same plan, rows, energy and momenta") {
  for (const Pair& pair : on_a_circle)
    compare(pair, pair.constraint.empty() ? "rectangle-symmetric" : "rectangle", false, 10);
  for (const Pair& pair : on_a_point) compare(pair, "midpoint", true, 10);
}

TEST_CASE("every built-in theory as text steps like the compiled one on every stencil", "[slow]") {
  for (const NamedTable& table : named_tables()) {
    for (const Pair& pair : on_a_circle)
      if (fits(table, false)) compare(pair, table.name, false, steps_of(pair, table.name));
    for (const Pair& pair : on_a_point)
      if (fits(table, true)) compare(pair, table.name, true, steps_of(pair, table.name));
  }
}

TEST_CASE("constraints and symmetries that are none are refused with the key") {
  const auto refusal = [](const std::string& key, const std::string& text) {
    Problem p = problem(on_a_circle.back(), "rectangle", true, false);
    p.parameters[key] = text;
    try {
      Simulation{p};
    } catch (const BadInput& bad) {
      CHECK(bad.key() == key);
      return std::string(bad.what());
    }
    return std::string("accepted");
  };
  const auto says = [](const std::string& message, const std::string& part) {
    INFO(message);
    CHECK(message.find(part) != std::string::npos);
  };
  says(refusal("theory.constraint", "3"), "is a number and no condition on the fields");
  says(refusal("theory.constraint", "u_t^2 - 1"), "unknown name u_t");
  says(refusal("theory.symmetry", "1, 0, 0"), "is no symmetry: it leads off the constraint");
  says(refusal("theory.symmetry", "0, -w, v; w, 0, u"), "is no symmetry: the density changes along it");
  CHECK(refusal("theory.symmetry", "0, -w, v") == "accepted");
}
