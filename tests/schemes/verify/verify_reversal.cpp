// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/mirrored_in_time.hpp"
#include "schemes/verify/reversal/time_reversal.hpp"
#include "tests/catch.hpp"
#include "tests/verification/r_adaptive_rows.hpp"

using namespace delf;

namespace {

constexpr double tolerance = 1e-11;
using Rows = std::vector<std::vector<double>>;

/// Rows 0 and 1 of a state, with zeros for multipliers.
Rows start_rows(Problem& p, const std::string& name) {
  StateRequest request;
  request.name = name, request.theory = p.theory;
  if (name == "breather" || name == "kink") request.values["initial.speed"] = 0.3;
  const auto state = make_state(request, p.lattice);
  if (p.lattice.is_circle()) p.winding = state->winding();
  const std::size_t d = state->components(), N = at(p.lattice.sites());
  const std::size_t C = Simulation(p).components().size();
  Rows rows(2, std::vector<double>(C * N));
  std::vector<double> y(d * N);
  for (std::size_t r = 0; r < 2; ++r) {
    state->values(static_cast<double>(r) * p.time_step, p.lattice, y);
    for (std::size_t n = 0; n < y.size(); ++n) rows[r][n / d * C + n % d] = y[n];
  }
  return rows;
}

std::optional<Reversal> there_and_back(Problem p, const std::string& state, std::int64_t steps) {
  const Rows rows = start_rows(p, state);
  return time_reversal([&](auto) { return std::make_unique<Simulation>(p); }, rows, steps, tolerance);
}

Problem sine_gordon(const std::string& stencil, const std::string& method = "multisymplectic") {
  Problem p;
  p.stencil = stencil, p.method = method;
  p.lattice = Lattice::circle(100, 30);
  p.time_step = 0.5 * p.lattice.space_step();
  return p;
}

bool reversible_equations(const Problem& p) { return reversible(Simulation(p).evolution().system(), 7); }

void returns(const Problem& p, const std::string& state, std::int64_t steps) {
  CAPTURE(p.theory, p.stencil, p.method, state);
  CHECK(reversible_equations(p));
  const auto reversal = there_and_back(p, state, steps);
  REQUIRE(reversal);
  CHECK(reversal->promised);
  CAPTURE(reversal->check.value, reversal->check.failure, reversal->distance, reversal->growth);
  CHECK(reversal->check.name == "time reversal");
  CHECK(reversal->check.passed());
  CHECK(reversal->check.count > 0);
  CHECK(reversal->check.tolerance == tolerance);
  CHECK(reversal->steps.back() == steps);
  CHECK(reversal->steps.size() == reversal->distance.size());
  for (const double distance : reversal->distance) CHECK(distance < 1e-9);
  CHECK(reversal->growth < 3);
}

/// The same problem, but what is built after the first simulation is built by `change`d.
template <class Change>
Reversal another_way_back(Problem p, const std::string& state, Change change) {
  const Rows rows = start_rows(p, state);
  int built = 0;
  const auto reversal = time_reversal(
      [&](auto) {
        if (built++ == 1) change(p);
        return std::make_unique<Simulation>(p);
      },
      rows, 8, tolerance);
  REQUIRE(reversal);
  return *reversal;
}

}  // namespace

TEST_CASE("schemes that are their own inverse come back to their start") {
  for (const char* stencil : {"rectangle", "rectangle-symmetric", "triangle-vertex"})
    for (const char* state : {"breather", "kink"}) returns(sine_gordon(stencil), state, 64);
  Problem angle = sine_gordon("rectangle");
  angle.circle_valued = true;
  returns(angle, "kink", 64);
  for (const char* method : {"guo", "vu-quoc-li"}) returns(sine_gordon("", method), "breather", 64);
}

TEST_CASE("bricks come back to their start after an even number of steps, also around a circle that winds") {
  for (const char* state : {"breather", "kink"}) returns(sine_gordon("hexagon"), state, 64);
  const auto reversal = there_and_back(sine_gordon("hexagon"), "breather", 7);
  REQUIRE(reversal);
  CHECK(reversal->steps == std::vector<std::int64_t>{2, 4});
  CHECK_FALSE(there_and_back(sine_gordon("hexagon"), "breather", 1));
}

TEST_CASE("wave maps with their multiplier and bodies at a point come back to their start") {
  Problem p;
  p.theory = "wave-map", p.lattice = Lattice::circle(32, 2 * std::numbers::pi);
  p.time_step = 0.5 * p.lattice.space_step();
  for (const char* stencil : {"rectangle", "triangle-vertex"}) {
    p.stencil = stencil;
    returns(p, "great-circle", 32);
  }
  p.lattice = Lattice::point(), p.time_step = 0.05;
  for (const char* stencil : {"midpoint", "trapezoidal", "vertex"}) {
    p.stencil = stencil;
    p.theory = "pendulum", returns(p, "pendulum-swing", 64);
    p.theory = "kepler", returns(p, "kepler-orbit", 64);
  }
}

// A moving kink's tail changes at fixed walls from row 0 to row 1.
TEST_CASE("schemes come back to their start between walls, which the starting rows do not fit") {
  for (const char* stencil : {"rectangle", "rectangle-symmetric", "triangle-vertex"})
    for (const Wall left : {Wall::fixed, Wall::natural})
      for (const Wall right : {Wall::fixed, Wall::natural}) {
        Problem p = sine_gordon(stencil);
        p.lattice = Lattice::interval(101, 30, left, right);
        returns(p, "kink", 64);
      }
}

TEST_CASE("the distances are those of 1, 2, 4 and so on steps, and of the whole way") {
  const auto reversal = there_and_back(sine_gordon("rectangle"), "breather", 21);
  REQUIRE(reversal);
  CHECK(reversal->steps == std::vector<std::int64_t>{1, 2, 4, 8, 16, 21});
  CHECK(reversal->check.value == reversal->distance[0]);
  CHECK(std::isfinite(reversal->growth));
  const auto brief = there_and_back(sine_gordon("rectangle"), "breather", 2);
  REQUIRE(brief);
  CHECK(brief->check.value == brief->distance[0]);
  CHECK(std::isnan(brief->growth));
}

TEST_CASE("the triangle is not reversible: nothing is promised, its distance is measured") {
  CHECK_FALSE(reversible_equations(sine_gordon("triangle")));
  const auto reversal = there_and_back(sine_gordon("triangle"), "breather", 16);
  REQUIRE(reversal);
  CHECK_FALSE(reversal->promised);
  CHECK(reversal->check.name.empty());
  REQUIRE(reversal->distance.size() == 5);
  CHECK(reversal->distance[3] > 1e-9);
}

TEST_CASE("friction has no Lagrangian to excuse it: the way back misses the start") {
  const Problem p = sine_gordon("", "damped");
  CHECK_FALSE(reversible_equations(p));
  const auto reversal = there_and_back(p, "breather", 16);
  REQUIRE(reversal);
  CHECK(reversal->promised);
  CAPTURE(reversal->check.value, reversal->check.failure);
  CHECK_FALSE(reversal->check.passed());
  CHECK(reversal->check.value > 1e-4);
  CHECK(reversal->check.failure.find("after 1 step: the scheme is not its own inverse") != std::string::npos);
}

TEST_CASE("the check can fail: another scheme on the way back, or another step, misses the start") {
  const auto other =
      another_way_back(sine_gordon("rectangle"), "breather", [](Problem& p) { p.stencil = "rectangle-symmetric"; });
  const auto longer = another_way_back(sine_gordon("rectangle"), "breather", [](Problem& p) { p.time_step *= 1.001; });
  for (const Reversal& reversal : {other, longer}) {
    CAPTURE(reversal.check.value, reversal.check.failure);
    CHECK(reversal.promised);
    CHECK_FALSE(reversal.check.passed());
    CHECK(reversal.check.value > 1e-6);
  }
}

TEST_CASE("a step back that fails is a check that fails, and says how") {
  const auto reversal =
      another_way_back(sine_gordon("rectangle-symmetric"), "breather", [](Problem& p) { p.max_iterations = 1; });
  CHECK(reversal.promised);
  CHECK_FALSE(reversal.check.passed());
  CHECK(std::isnan(reversal.check.value));
  CAPTURE(reversal.check.failure);
  CHECK(reversal.check.failure.find("the way back after 1 step ends: ") == 0);
}

TEST_CASE("moving meshes with their multipliers come back to their start") {
  namespace given = r_adaptive_rows;
  Problem p;
  p.method = "r-adaptive", p.parameters["mesh.alpha"] = given::alpha;
  p.lattice = Lattice::interval(17, 25), p.time_step = given::time_step;
  CHECK(reversible_equations(p));
  Rows rows(2);
  for (std::size_t i = 0; i < 17; ++i) {
    rows[0].insert(rows[0].end(), {given::y0[i], given::X0[i], 0});
    rows[1].insert(rows[1].end(), {given::y1[i], given::X1[i], 0});
  }
  const auto reversal = time_reversal([&](auto) { return std::make_unique<Simulation>(p); }, rows, 8, tolerance);
  REQUIRE(reversal);
  CAPTURE(reversal->check.value, reversal->check.failure, reversal->distance);
  CHECK(reversal->promised);
  CHECK(reversal->check.passed());
}

namespace {

Problem pendulum_by(const std::string& quadrature, int points) {
  Problem p;
  p.theory = "pendulum", p.method = "cgvi", p.lattice = Lattice::point(), p.time_step = 0.1;
  p.parameters["scheme.functions"] = 3, p.parameters["scheme.points"] = points;
  p.parameters["scheme.quadrature"] = quadrature;
  return p;
}

}  // namespace

TEST_CASE("elements in time come back to the row and the momenta that they came from") {
  for (const char* continuity : {"shared", "multipliers"})
    for (const char* quadrature : {"gauss", "lobatto"}) {
      Problem p = pendulum_by(quadrature, 3);
      p.parameters["scheme.continuity"] = continuity;
      const auto reversal = there_and_back(p, "pendulum-swing", 64);
      CAPTURE(quadrature, continuity);
      REQUIRE(reversal);
      CAPTURE(reversal->check.value, reversal->distance);
      CHECK(reversal->promised);
      CHECK(reversal->check.passed());
      CHECK(reversal->distance.back() < 1e-11);
    }
  Problem field = sine_gordon("", "cgvi");
  field.parameters["scheme.tableau"] = "gauss2";
  const auto reversal = there_and_back(field, "breather", 8);
  REQUIRE(reversal);
  CHECK(reversal->promised);
  CHECK(reversal->check.passed());
}

TEST_CASE("an element whose rule has one end is not reversible, and another step on the way back is found") {
  const auto one_sided = there_and_back(pendulum_by("radau", 2), "pendulum-swing", 8);
  REQUIRE(one_sided);
  CHECK_FALSE(one_sided->promised);
  CHECK(one_sided->distance.front() > 1e-9);
  const auto longer =
      another_way_back(pendulum_by("gauss", 3), "pendulum-swing", [](Problem& p) { p.time_step *= 1.001; });
  CHECK(longer.promised);
  CHECK_FALSE(longer.check.passed());
}

TEST_CASE("an element is reversible where the form of its density says that it is even in the rates") {
  const auto way = [](const std::string& density) {
    Problem p = pendulum_by("gauss", 3);
    p.theory = "text", p.parameters["theory.density"] = density;
    const std::size_t C = Simulation(p).components().size();
    return time_reversal([&](auto) { return std::make_unique<Simulation>(p); },
                         Rows{std::vector<double>(C, 0.5), std::vector<double>(C, 0.52)}, 8, tolerance);
  };
  for (const char* even : {"0.5*phi_t^2*(1 + phi^2) + cos(phi)", "0.5*phi_t^2 + 0.1*phi_t*sin(phi_t) + cos(phi)"}) {
    const auto back = way(even);
    CAPTURE(even);
    REQUIRE(back);
    CHECK(back->promised);
    CHECK(back->check.passed());
  }
  const auto other = way("0.5*phi_t^2 + 0.1*phi*phi_t^3 + cos(phi)");
  REQUIRE(other);
  CHECK_FALSE(other->promised);
  CHECK(other->distance.front() > 1e-9);
}

TEST_CASE("traces are not asked: a row and its momenta are not their state") {
  Problem p;
  p.theory = "lotka-volterra", p.method = "dgvi", p.lattice = Lattice::point(), p.time_step = 0.1;
  const auto make = [&](std::optional<double>) { return std::make_unique<Simulation>(p); };
  CHECK_FALSE(
      time_reversal(make, Rows(2, std::vector<double>(make(std::nullopt)->components().size(), 1.0)), 8, tolerance));
}

TEST_CASE("a vacuum stays where it is, forward and back") {
  const Problem p = sine_gordon("rectangle-symmetric");
  const auto reversal = time_reversal([&](auto) { return std::make_unique<Simulation>(p); },
                                      Rows(2, std::vector<double>(100)), 8, tolerance);
  REQUIRE(reversal);
  CHECK(reversal->check.value == 0);
  CHECK(reversal->check.passed());
}

// q_tt + sin q = 0.3 cos(1.3 t): backwards the force is that of T − t.
TEST_CASE("a force that changes in time is reversed with the rows") {
  for (const auto& [stencil, method] :
       std::vector<std::pair<std::string, std::string>>{{"vertex", "multisymplectic"},
                                                        {"midpoint", "multisymplectic"},
                                                        {"trapezoidal", "multisymplectic"},
                                                        {"midpoint", "cgvi"}}) {
    CAPTURE(stencil, method);
    Problem p;
    p.theory = "text", p.lattice = Lattice::point(), p.stencil = stencil, p.method = method, p.time_step = 0.05;
    p.parameters["theory.density"] = std::string("0.5*phi_t^2 + cos(phi) + 0.3*phi*cos(1.3*t)");
    const std::size_t C = Simulation(p).components().size();
    const auto way = [&](bool mirrored) {
      return time_reversal(
          [&](std::optional<double> T) {
            return std::make_unique<Simulation>(T && mirrored ? mirrored_in_time(p, *T) : p);
          },
          Rows{std::vector<double>(C, 0.5), std::vector<double>(C, 0.5003)}, 32, tolerance);
    };
    const auto back = way(true);
    REQUIRE(back);
    CHECK(back->promised);
    CAPTURE(back->check.value, back->distance);
    CHECK(back->check.passed());
    CHECK(back->distance.back() < 1e-11);
    // the same force on the way back is another one
    CHECK(way(false)->distance.back() > 1e-4);
  }
}

TEST_CASE("momenta of short steps are compared within the rounding of the differences that they are") {
  Problem p;
  p.theory = "pendulum", p.lattice = Lattice::point(), p.method = "cgvi";
  for (const double h : {1e-2, 1e-4, 1e-5}) {
    p.time_step = h;
    const std::size_t C = Simulation(p).components().size();
    const auto back = time_reversal([&](auto) { return std::make_unique<Simulation>(p); },
                                    {std::vector<double>(C, 2.0), std::vector<double>(C, 2.0 + 0.7 * h)}, 8, 1e-12);
    REQUIRE(back);
    CAPTURE(h, back->check.value, back->check.tolerance);
    CHECK(back->check.passed());
  }
}
