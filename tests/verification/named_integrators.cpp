// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/time_tableau.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stability/constraint_ghost.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/mechanics/solar_system.hpp"
#include "tests/catch.hpp"
#include "tests/verification/time_elements.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

std::string refusal(const Problem& p) {
  try {
    Simulation simulation(p);
  } catch (const BadInput& bad) {
    return bad.key() + ": " + bad.what();
  }
  return "accepted";
}

/// The largest difference of (q, p) of two schemes over so many steps.
double apart(const Problem& a, const Problem& b, const Numbers& q, const Numbers& v, int steps) {
  Body one(a, q, v), other(b, q, v);
  double most = 0;
  for (int n = 1; n <= steps; ++n) {
    one.to(n), other.to(n);
    most = std::max({most, distance(one.q(), other.q()), distance(one.p(), other.p())});
  }
  return most;
}

// ---- Lobatto IIIA–IIIB by hand, for H = p²/(2(1 + q²)) + q⁴/4, the Hamiltonian of L = ½(1 + q²)v² − q⁴/4

Problem heavy(double h, const Elements& e) {
  Problem p = problem_of("text", h, e);
  p.tolerance = 1e-15;
  p.parameters["theory.density"] = "0.5*(1 + phi^2)*phi_t^2 - phi^4/4";
  return p;
}

std::array<double, 2> lobatto_step(int s, double h, std::array<double, 2> y) {
  const LineRule rule = lobatto_rule(s), fine = gauss_rule(12);
  const LagrangeBasis psi(rule.points);
  const std::size_t n = s;
  std::vector<Numbers> a(n, Numbers(n, 0.0)), b = a;
  // a_ij = ∫₀^{c_i} ψ_j of IIIA, and b_j (1 − a_ji/b_i) of IIIB
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < fine.points.size(); ++k) {
      const Numbers at = psi.values(rule.points[i] * fine.points[k]);
      for (std::size_t j = 0; j < n; ++j) a[i][j] += rule.points[i] * fine.weights[k] * at[j];
    }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) b[i][j] = rule.weights[j] * (1 - a[j][i] / rule.weights[i]);
  const auto q_t = [](double q, double p) { return p / (1 + q * q); };
  const auto p_t = [](double q, double p) { return q * p * p / ((1 + q * q) * (1 + q * q)) - q * q * q; };
  Numbers Q(n, y[0]), P(n, y[1]);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Numbers Q0 = Q, P0 = P;
    for (std::size_t i = 0; i < n; ++i) {
      Q[i] = y[0], P[i] = y[1];
      for (std::size_t j = 0; j < n; ++j)
        Q[i] += h * a[i][j] * q_t(Q0[j], P0[j]), P[i] += h * b[i][j] * p_t(Q0[j], P0[j]);
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    y = {y[0] + h * rule.weights[i] * q_t(Q[i], P[i]), y[1] + h * rule.weights[i] * p_t(Q[i], P[i])};
  return y;
}

double from_lobatto(int s, const Elements& e, double h, int steps) {
  std::array<double, 2> y{0.7, 0.3};
  Body body(heavy(h, e), {y[0]}, {y[1] / (1 + y[0] * y[0])});
  double most = 0;
  for (int n = 1; n <= steps; ++n) {
    y = lobatto_step(s, h, y);
    body.to(n);
    most = std::max({most, std::abs(body.q()[0] - y[0]), std::abs(body.p()[0] - y[1])});
  }
  return most;
}

// ---- a spherical pendulum by hand: RATTLE with |q| = 1

using Vector = std::array<double, 3>;
struct Phase {
  Vector q, p;
};
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector plus(const Vector& a, double s, const Vector& b) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }

Phase rattle(const Phase& y, double h) {
  const Vector down{0, 0, -1};
  // p½ = p + ½h F − μ q with |q + h p½| = 1: a quadratic equation for μ
  const Vector half = plus(y.p, 0.5 * h, down), there = plus(y.q, h, half);
  const double a = h * h * dot(y.q, y.q), b = -2 * h * dot(y.q, there), c = dot(there, there) - 1;
  const double mu = 2 * c / (-b + std::sqrt(b * b - 4 * a * c));
  const Vector p_half = plus(half, -mu, y.q), q = plus(y.q, h, p_half), p = plus(p_half, 0.5 * h, down);
  return {q, plus(p, -dot(q, p) / dot(q, q), q)};
}

Vector vector_of(const Numbers& x) { return {x[0], x[1], x[2]}; }
double distance(const Vector& a, const Numbers& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// The error at t = 2 of a pendulum that goes round on a cone.
double cone_error(const std::string& tableau, int n) {
  const auto cone = state_of("spherical-pendulum", "spherical-swing");
  return delf::testing::distance(
      Body(problem_of("spherical-pendulum", 2.0 / n, tableau), at(*cone, 0), rate_at(*cone, 0)).to(n).q(),
      at(*cone, 2));
}

/// A pendulum pushed sideways, which stays on no cone.
std::unique_ptr<State> pushed() {
  ParameterValues values;
  values["initial.amplitude"] = 1.2, values["initial.azimuth_rate"] = 0.5;
  return state_of("spherical-pendulum", "spherical-swing", values);
}

}  // namespace

TEST_CASE("a tableau is the basis and the rule that it stands for") {
  const std::pair<const char*, Elements> same[] = {
      {"midpoint", {2, "gauss", 1}},   {"stormer-verlet", {2, "lobatto", 2}}, {"gauss1", {2, "gauss", 1}},
      {"gauss2", {3, "gauss", 2}},     {"gauss4", {5, "gauss", 4}},           {"lobatto2", {3, "lobatto", 2}},
      {"lobatto3", {4, "lobatto", 3}}, {"lobatto4", {5, "lobatto", 4}}};
  const Numbers q{0.5, -0.2}, v{0.3, 0.1};
  for (const auto& [name, elements] : same) {
    const double off =
        apart(problem_of("double-pendulum", 0.1, name), problem_of("double-pendulum", 0.1, elements), q, v, 10);
    CAPTURE(name, off);
    // lobatto3 and 4 have another basis of the same space, and round otherwise
    CHECK(off < (elements.quadrature == "lobatto" && elements.functions > 3 ? 5e-13 : 1e-13));
  }
  // the mass depends on q: without the bubble it is another method
  CHECK(apart(problem_of("double-pendulum", 0.1, "lobatto2"), problem_of("double-pendulum", 0.1, "stormer-verlet"), q,
              v, 10) > 1e-6);
  for (const TimeTableau& t : time_tableaux()) CHECK(refusal(problem_of("kepler", 0.01, t.name)) == "accepted");
}

TEST_CASE("a tableau beside a key that it stands for is refused, and both are named") {
  for (const char* key : {"scheme.basis", "scheme.functions", "scheme.quadrature", "scheme.points", "scheme.degree"}) {
    Problem p = problem_of("pendulum", 0.1, "gauss2");
    if (std::string(key) == "scheme.basis") p.parameters[key] = "bernstein";
    else if (std::string(key) == "scheme.quadrature") p.parameters[key] = "gauss";
    else p.parameters[key] = 2;
    const std::string why = refusal(p);
    CHECK(why.starts_with("scheme.tableau"));
    CHECK(why.find(key) != std::string::npos);
  }
}

TEST_CASE("Lobatto IIIA-IIIB of s stages is the element of s + 1 functions, with a mass that depends on q") {
  for (const int s : {2, 3, 4}) {
    CAPTURE(s);
    for (const char* basis : {"lagrange-lobatto-bubble", "bernstein"}) {
      const double off = from_lobatto(s, {s + 1, "lobatto", s, basis}, 0.1, 1);
      CAPTURE(basis, off);
      CHECK(off < 1e-14);
      CHECK(from_lobatto(s, {s + 1, "lobatto", s, basis}, 0.1, 10) < 1e-13);  // what rounding has grown to
    }
  }
  // without the bubble it is not: after one step of two stages q is off by 3.0e-6
  Body body(heavy(0.1, {2, "lobatto", 2}), {0.7}, {0.3 / 1.49});
  CHECK(std::abs(std::abs(body.to(1).q()[0] - lobatto_step(2, 0.1, {0.7, 0.3})[0]) - 3.0e-6) < 5e-8);
}

TEST_CASE("B-splines of degree p are of order 2p with Gauss's rule on every span, from both sides") {
  struct Case {
    int functions, degree, points, order, steps;
  };
  for (const Case& c : {Case{4, 2, 2, 4, 8}, Case{4, 2, 3, 4, 8}, Case{5, 3, 3, 6, 4}, Case{6, 2, 1, 2, 16}}) {
    CAPTURE(c.functions, c.degree, c.points);
    const auto state = state_of("pendulum", "pendulum-swing");
    const auto error = [&](int n) {
      Problem p = problem_of("pendulum", 2.0 / n, {c.functions, "gauss", c.points, "b-spline"});
      p.parameters["scheme.degree"] = c.degree;
      return distance(Body(p, at(*state, 0), rate_at(*state, 0)).to(n).q(), at(*state, 2));
    };
    const double slope = std::log2(error(c.steps) / error(2 * c.steps));
    CAPTURE(slope);
    CHECK(std::abs(slope - c.order) < 0.25);
  }
  // a degree that the functions cannot have
  Problem p = problem_of("pendulum", 0.1, {4, "gauss", 3});
  p.parameters["scheme.degree"] = 2;
  CHECK(refusal(p).starts_with("scheme.degree"));
  p = problem_of("pendulum", 0.1, {3, "gauss", 3, "b-spline"});
  p.parameters["scheme.degree"] = 3;
  CHECK(refusal(p).starts_with("scheme.degree"));
}

TEST_CASE("elements step a rotor on S1 as on the line, and refuse increments that cannot be distinguished") {
  for (const char* tableau : {"midpoint", "gauss3", "lobatto3"}) {
    Problem line = problem_of("pendulum", 0.25, tableau), circle = line;
    circle.circle_valued = true;
    Body one(line, {0.5}, {2.5}), other(circle, {0.5}, {2.5});  // over the top, again and again
    one.to(100), other.to(100);
    CAPTURE(tableau);
    CHECK(one.q() == other.q());
    CHECK(std::abs(one.q()[0]) > 4 * std::numbers::pi);
    CHECK_THROWS_AS(Body(circle, {0.5}, {40}).to(3), NotFinite);
  }
  Problem broken = problem_of("pendulum", 0.1, {2, "gauss", 1, "lagrange-gauss"});
  broken.circle_valued = true;
  CHECK(refusal(broken).starts_with("theory.fibre"));
}

TEST_CASE("a spherical pendulum on a constraint is the method RATTLE with the tableau stormer-verlet") {
  const auto state = pushed();
  const Numbers q = at(*state, 0), v = rate_at(*state, 0);
  Body body(problem_of("spherical-pendulum", 0.1, "stormer-verlet"), q, v);
  Phase y{vector_of(q), vector_of(v)};
  for (int n = 1; n <= 100; ++n) {
    y = rattle(y, 0.1);
    body.to(n);
    CAPTURE(n);
    CHECK(distance(y.q, body.q()) < 1e-12);
    CHECK(distance(y.p, body.p()) < 1e-12);
  }
}

TEST_CASE("a component lies at one node of the cell for all stencils: regions take those of a node as a site") {
  const Simulation simulation(problem_of("spherical-pendulum", 0.1, "lobatto3"));
  const LatticeSystem& system = simulation.evolution().system();
  std::vector<std::set<int>> nodes(system.all_components().size());
  for (const auto& family : system.families())
    for (int i = 0; i < family->size(); ++i) nodes[family->values()[i].component].insert(family->site(i).node);
  for (const std::set<int>& of_component : nodes) CHECK(of_component.size() == 1);
  CHECK(std::ranges::any_of(nodes, [](const auto& of_component) { return *of_component.begin() > 0; }));
}

TEST_CASE("constrained Lobatto elements keep constraint, momenta and their order") {
  for (const auto& [tableau, order, steps] :
       {std::tuple{"stormer-verlet", 2, 20}, {"lobatto2", 2, 20}, {"lobatto3", 4, 8}, {"lobatto4", 6, 4}}) {
    CAPTURE(tableau);
    const double slope = std::log2(cone_error(tableau, steps) / cone_error(tableau, 2 * steps));
    CAPTURE(slope);
    CHECK(std::abs(slope - order) < 0.25);
    const auto state = pushed();
    const Numbers q0 = at(*state, 0), v0 = rate_at(*state, 0);
    Body body(problem_of("spherical-pendulum", 0.1, tableau), q0, v0);
    REQUIRE(body.simulation().conserved_names() == std::vector<std::string>{"angular_momentum"});
    const double J = q0[0] * v0[1] - q0[1] * v0[0];
    double off = 0, turned = 0, slipping = 0;
    for (int n = 1; n <= 300; ++n) {
      const Vector q = vector_of(body.to(n).q()), p = vector_of(body.p());
      off = std::max(off, std::abs(dot(q, q) - 1));
      turned = std::max(turned, std::abs(q[0] * p[1] - q[1] * p[0] - J));
      slipping = std::max(slipping, std::abs(dot(q, p)));
    }
    CHECK(off < 1e-13);
    CHECK(turned < 1e-12);
    CHECK(slipping < 1e-13);
    CHECK(std::abs(body.simulation().monitors().energy - (0.5 * dot(vector_of(v0), vector_of(v0)) + q0[2])) < 1e-2);
  }
}

TEST_CASE("a constraint on a point has no waves that could grow") {
  const auto ghost = [](const Problem& p) {
    return ghost_under_constraint(Simulation(p).evolution().system()).has_value();
  };
  CHECK_FALSE(ghost(problem_of("spherical-pendulum", 0.1, "stormer-verlet")));
  Problem p = problem_of("spherical-pendulum", 0.1, "stormer-verlet");
  p.parameters = {}, p.method = "multisymplectic", p.stencil = "trapezoidal";
  CHECK_FALSE(ghost(p));
}

TEST_CASE("elements that cannot keep a constraint at their points are refused with a tableau that can") {
  for (const char* tableau : {"midpoint", "gauss2"}) {
    const std::string why = refusal(problem_of("spherical-pendulum", 0.1, tableau));
    CHECK(why.find("stormer-verlet") != std::string::npos);
  }
  CHECK(refusal(problem_of("spherical-pendulum", 0.1, {4, "lobatto", 3, "bernstein"})) != "accepted");
  CHECK(refusal(problem_of("spherical-pendulum", 0.1, {3, "lobatto", 3})) == "accepted");
}

TEST_CASE("the planets move as by Newton's law, and keep momentum and angular momentum") {
  constexpr std::size_t bodies = SolarSystem::bodies, d = SolarSystem::components;
  const auto state = state_of("solar-system", "solar-system");
  Numbers q = at(*state, 0), v = rate_at(*state, 0);
  const double h = 50;
  Body body(problem_of("solar-system", h, "stormer-verlet"), q, v);
  const auto kick = [&](double part) {
    for (std::size_t i = 0; i < bodies; ++i)
      for (std::size_t k = 0; k < bodies; ++k) {
        if (i == k) continue;
        double square = 0;
        for (std::size_t e = 0; e < 3; ++e) square += (q[3 * k + e] - q[3 * i + e]) * (q[3 * k + e] - q[3 * i + e]);
        for (std::size_t e = 0; e < 3; ++e)
          v[3 * i + e] +=
              part * SolarSystem::G * SolarSystem::mass[k] * (q[3 * k + e] - q[3 * i + e]) / std::pow(square, 1.5);
      }
  };
  const auto before = body.simulation().monitors();
  for (int n = 1; n <= 12; ++n) {
    kick(0.5 * h);
    for (std::size_t a = 0; a < d; ++a) q[a] += h * v[a];
    kick(0.5 * h);
  }
  body.to(12);
  CHECK(distance(q, body.q()) < 1e-11);
  Numbers p(d);
  for (std::size_t a = 0; a < d; ++a) p[a] = SolarSystem::mass[a / 3] * v[a];
  CHECK(distance(p, body.p()) < 1e-15);
  const auto after = body.simulation().monitors();
  REQUIRE(after.conserved.size() == 6);
  for (std::size_t j = 0; j < 6; ++j)
    CHECK(std::abs(after.conserved[j] - before.conserved[j]) < 1e-14 * after.conserved_scale[j]);
  CHECK(std::abs(after.energy - before.energy) < 1e-3 * std::abs(before.energy));
}

TEST_CASE("symmetric elements return to their start when the momenta are turned, and others do not") {
  const auto way_back = [](const Problem& p) {
    Body body(p, {0.25, 0.125}, {-0.1, 0.3});
    const Numbers p0 = body.simulation().dataset(0, 1);
    body.to(30);
    Numbers turned = body.p(), row, momenta;
    for (double& x : turned) x = -x;
    const Numbers q = body.q();
    for (const Component& c : body.simulation().components()) {
      row.push_back(c.role == Role::multiplier ? 0 : q[c.field]);
      momenta.push_back(c.role == Role::field ? turned[c.field] : 0);
    }
    Simulation back(p);
    back.start_momenta(row, momenta);
    while (back.newest() < 30) back.step();
    Numbers end(2), p_end = back.dataset(0);
    back.copy_row(0, end);
    return std::max(
        {std::abs(end[0] - 0.25), std::abs(end[1] - 0.125), std::abs(p_end[0] + p0[0]), std::abs(p_end[1] + p0[1])});
  };
  for (const char* tableau : {"midpoint", "stormer-verlet", "gauss2", "gauss4", "lobatto3"})
    CHECK(way_back(problem_of("henon-heiles", 0.2, tableau)) < 1e-12);
  CHECK(way_back(problem_of("henon-heiles", 0.2, {3, "gauss", 3, "lagrange-gauss"})) < 1e-12);
  CHECK(way_back(problem_of("henon-heiles", 0.2, {3, "radau", 2})) > 1e-6);
}

namespace {

/// Kepler's problem of eccentricity 0.6, some 64 steps a turn.
struct Drift {
  double momentum = 0, early = 0, late = 0;  ///< |J − J₀|; largest |H − H₀| in the first and in the last tenth
};
Drift kepler_drift(const char* tableau, int steps) {
  const auto orbit = state_of("kepler", "kepler-orbit");
  Body body(problem_of("kepler", 0.1, tableau), at(*orbit, 0), rate_at(*orbit, 0));
  Drift drift;
  for (int n = 1; n <= steps; ++n) {
    const Numbers q = body.to(n).q(), p = body.p();
    drift.momentum = std::max(drift.momentum, std::abs(q[0] * p[1] - q[1] * p[0] - 0.8));
    const double off = std::abs(0.5 * (p[0] * p[0] + p[1] * p[1]) - 1 / std::hypot(q[0], q[1]) + 0.5);
    if (10 * n <= steps) drift.early = std::max(drift.early, off);
    if (10 * n > 9 * steps) drift.late = std::max(drift.late, off);
  }
  return drift;
}
void check_drift(const char* tableau, int steps) {
  const Drift drift = kepler_drift(tableau, steps);
  CAPTURE(tableau, drift.momentum, drift.early, drift.late);
  CHECK(drift.momentum < 5e-14 + 1e-17 * steps);  // rounding of what a step adds to p
  CHECK(drift.late < 1.2 * drift.early);
  CHECK(drift.early > 1e-9);  // it is measured: the energy is not conserved
}

}  // namespace

TEST_CASE("a planet of eccentricity 0.6 keeps its momentum, and its energy stays in its band") {
  for (const char* tableau : {"gauss2", "gauss3", "lobatto3"}) check_drift(tableau, 3000);
}

TEST_CASE("so it does over 100000 steps", "[slow]") {
  for (const char* tableau : {"gauss2", "gauss3", "lobatto3"}) check_drift(tableau, 100000);
}
