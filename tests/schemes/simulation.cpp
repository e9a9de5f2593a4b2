// SPDX-License-Identifier: MIT
#include "schemes/simulation.hpp"

#include <limits>
#include <numbers>

#include "lattice/index.hpp"
#include "schemes/state.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double pi = std::numbers::pi;

Problem problem(const std::string& stencil, const Lattice& lattice, double courant,
                const std::string& theory = "sine-gordon") {
  Problem p;
  p.theory = theory, p.stencil = stencil, p.lattice = lattice, p.time_step = courant * lattice.space_step();
  if (theory == "text") p.parameters["theory.density"] = std::string("0.5*phi_t^2 - 0.5*phi_x^2 + cosm1(phi)");
  return p;
}
template <class Change>
Problem with(Problem p, Change change) {
  change(p);
  return p;
}
std::string key_of(const Problem& p) {
  return refused_key([&] { Simulation{p}; });
}
std::string message_of(const Problem& p) {
  return testing::message_of([&] { Simulation{p}; });
}

Row newest(const Simulation& simulation, const Lattice& lattice, int back = 0) {
  Row row(at(lattice.sites()));
  simulation.copy_row(back, row);
  return row;
}

std::unique_ptr<State> state(const std::string& name, const Lattice& lattice, double speed = 0) {
  StateRequest request;
  request.name = name, request.theory = "sine-gordon", request.values["initial.speed"] = speed;
  if (name == "breather") request.values["initial.frequency"] = 0.6;
  return make_state(request, lattice);
}
Row values(const State& s, double t, const Lattice& lattice) {
  Row row(at(lattice.sites()));
  s.values(t, lattice, row);
  return row;
}
Row velocities(const State& s, const Lattice& lattice) {
  Row row(at(lattice.sites()));
  s.velocities(0, lattice, row);
  return row;
}

/// Each value in [−π, π], as somebody gives it who does not count turns.
Row reduced(Row row) {
  for (double& y : row) y = std::remainder(y, 2 * pi);
  return row;
}
/// max |a − b| after the multiple of 2π that a[0] − b[0] is nearest to is taken away from all.
double distance_but_turns(const Row& a, const Row& b) {
  const double turns = 2 * pi * std::round((a[0] - b[0]) / (2 * pi));
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i] - turns));
  return largest;
}

}  // namespace

TEST_CASE("an unknown theory, stencil or method is refused by its key, with the nearest one") {
  const Problem right = problem("rectangle", Lattice::circle(16, 8), 0.5);
  CHECK(key_of(right) == "accepted");
  const Problem theory = with(right, [](Problem& p) { p.theory = "sine-gorden"; });
  const Problem stencil = with(right, [](Problem& p) { p.stencil = "rectangel"; });
  const Problem method = with(right, [](Problem& p) { p.method = "vu-quoc-lee"; });
  CHECK(key_of(theory) == "theory.name");
  CHECK(contains(message_of(theory), "did you mean sine-gordon?"));
  CHECK(key_of(stencil) == "lattice.stencil");
  CHECK(contains(message_of(stencil), "did you mean rectangle?"));
  CHECK(key_of(method) == "scheme.method");
  CHECK(contains(message_of(method), "did you mean vu-quoc-li?"));
  const Problem far = with(right, [](Problem& p) { p.theory = "qwertyuiop"; });
  CHECK_FALSE(contains(message_of(far), "did you mean"));
  CHECK(contains(message_of(far), "sine-gordon-impurity"));  // all that there are
}

TEST_CASE("a time step that is 0 or not finite is refused") {
  for (const double h : {0.0, std::nan(""), std::numeric_limits<double>::infinity()})
    CHECK(key_of(with(problem("rectangle", Lattice::circle(16, 8), 0.5), [h](Problem& p) { p.time_step = h; })) ==
          "lattice.time_step");
}

TEST_CASE("hexagons need an even circle, six- and nine-tuples take walls, comparators walls that are fixed") {
  CHECK(key_of(problem("hexagon", Lattice::circle(255, 40), 0.5)) == "lattice.sites");
  CHECK(key_of(problem("hexagon", Lattice::circle(254, 40), 0.5)) == "accepted");
  CHECK(key_of(problem("hexagon", Lattice::interval(64, 10), 0.5)) == "lattice.stencil");
  CHECK(key_of(problem("six-tuple", Lattice::interval(64, 10, Wall::clamped), 0.5)) == "boundary.left");
  CHECK(key_of(problem("triangle", Lattice::interval(64, 10, Wall::fixed, Wall::clamped), 0.5)) == "boundary.right");
  for (const char* stencil : {"triangle", "rectangle", "rectangle-symmetric", "six-tuple", "nine-tuple"})
    CHECK(key_of(problem(stencil, Lattice::interval(64, 10, Wall::natural, Wall::natural), 0.5)) == "accepted");
  const auto comparator = [](Wall left, Wall right) {
    return with(problem("", Lattice::interval(64, 10, left, right), 0.5), [](Problem& p) { p.method = "guo"; });
  };
  CHECK(key_of(comparator(Wall::fixed, Wall::fixed)) == "accepted");
  CHECK(key_of(comparator(Wall::natural, Wall::fixed)) == "boundary.left");
  CHECK(key_of(comparator(Wall::fixed, Wall::natural)) == "boundary.right");
}

TEST_CASE("a comparator is refused where waves have another speed than 1, or the density other derivatives") {
  const Lattice ring = Lattice::circle(32, 10);
  for (const char* method : {"vu-quoc-li", "guo", "damped"}) {
    const auto key = [&](const char* density) {
      return key_of(with(problem("rectangle", ring, 0.25, "text"), [&](Problem& p) {
        p.method = method, p.parameters["theory.density"] = std::string(density);
      }));
    };
    CHECK(key("0.5*phi_t^2 - 0.5*phi_x^2 - phi^4") == "accepted");
    for (const char* other : {"0.5*phi_t^2 - 0.5*340^2*phi_x^2 - phi^4", "1e3*(0.5*phi_t^2 - 0.5*phi_x^2 - phi^4)",
                              "0.5*phi_t^2 - 0.5*phi_x^2 + 0.1*phi_t*phi_x - phi^4"})
      CHECK(key(other) == "scheme.method");
  }
}

TEST_CASE("a comparator that is not written for a theory is refused, and says for which") {
  for (const char* method : {"guo", "vu-quoc-li"}) {
    const auto of = [method](const char* theory) {
      return with(problem("", Lattice::circle(16, 8), 0.5, theory), [method](Problem& p) { p.method = method; });
    };
    CHECK(key_of(of("sine-gordon-impurity")) == "scheme.method");
    CHECK(contains(message_of(of("sine-gordon-impurity")), "theory.name = sine-gordon-impurity"));
    for (const char* theory : {"wave", "klein-gordon", "sine-gordon", "phi4", "double-sine-gordon"})
      CHECK(key_of(of(theory)) == "accepted");
  }
}

TEST_CASE("a blow-up names step, time and site, and leaves the last good rows") {
  // the triangle at Courant 1.2: the shortest wave grows by (1.2 + √0.44)² a step
  const Lattice lattice = Lattice::circle(64, 16);
  Problem p = problem("triangle", lattice, 1.2);
  Simulation simulation(p);
  Row row(64);
  for (int i = 0; i < 64; ++i) row[i] = 0.1 * std::sin(2 * pi * i / 64);
  row[20] += 1e-6;
  simulation.start({row, row});
  std::string message;
  try {
    for (int n = 0; n < 2000; ++n) simulation.step();
  } catch (const NotFinite& error) {
    message = error.what();
  }
  const auto failed = simulation.newest() + 1;
  CHECK(failed < 2000);
  CHECK(contains(message, "step " + std::to_string(failed) + ","));
  CHECK(contains(message, "t = "));
  CHECK(contains(message, "site "));
  double largest = 0;
  for (int back : {0, 1})
    for (double y : newest(simulation, lattice, back)) {
      CHECK(std::isfinite(y));
      largest = std::max(largest, std::abs(y));
    }
  CHECK(largest > 1e100);
  // asked again, it fails again at the same step
  CHECK_THROWS_AS(simulation.step(), NotFinite);
  CHECK(simulation.newest() + 1 == failed);
  // at Courant 0.9 it does not
  Simulation stable(problem("triangle", lattice, 0.9));
  stable.start({row, row});
  for (int n = 0; n < 2000; ++n) stable.step();
  CHECK(distance(newest(stable, lattice), Row(64, 0)) < 1);
}

TEST_CASE("S1 and R give the same rows modulo 2π, from the same start reduced modulo 2π") {
  const Lattice lattice = Lattice::circle(127, 40);
  for (const char* stencil : {"triangle", "rectangle", "rectangle-symmetric"}) {
    CAPTURE(stencil);
    Problem real = problem(stencil, lattice, 0.5);
    real.winding = 1;
    const Problem circle = with(real, [](Problem& p) { p.circle_valued = true; });
    const auto kink = state("kink", lattice, 0.5);
    const Row y0 = values(*kink, 0, lattice), y1 = values(*kink, real.time_step, lattice);
    CHECK(distance(reduced(y0), y0) > 3);  // it is another row
    Simulation on_line(real), on_circle(circle);
    on_line.start({y0, y1});
    on_circle.start({reduced(y0), reduced(y1)});
    for (int n = 0; n < 200; ++n) {
      on_line.step();
      on_circle.step();
    }
    CHECK(distance_but_turns(newest(on_circle, lattice), newest(on_line, lattice)) < 1e-11);
    // and on the line the reduced rows are a field that jumps by 2π: not the same
    Simulation jumping(real);
    jumping.start({reduced(y0), reduced(y1)});
    for (int n = 0; n < 200; ++n) jumping.step();
    CHECK(distance_but_turns(newest(jumping, lattice), newest(on_line, lattice)) > 0.1);
  }
}

TEST_CASE("S1 and R agree after a centred start too") {
  const Lattice lattice = Lattice::circle(127, 40);
  Problem real = problem("rectangle", lattice, 0.5);
  real.winding = 1;
  const Problem circle = with(real, [](Problem& p) { p.circle_valued = true; });
  const auto kink = state("kink", lattice, 0.5);
  const Row y0 = values(*kink, 0, lattice), velocity = velocities(*kink, lattice);
  Simulation on_line(real), on_circle(circle);
  on_line.start_centred(y0, velocity);
  on_circle.start_centred(reduced(y0), velocity);
  for (int n = 0; n < 50; ++n) on_line.step(), on_circle.step();
  CHECK(distance_but_turns(newest(on_circle, lattice), newest(on_line, lattice)) < 1e-11);
}

TEST_CASE("on S1 a jump above 0.9π is refused, in the start and later") {
  const Lattice lattice = Lattice::circle(16, 8);
  const Problem p = with(problem("triangle", lattice, 0.2, "wave"), [](Problem& q) { q.circle_valued = true; });
  Simulation simulation(p);
  Row jump(16, 0.0);
  jump[7] = 0.95 * pi;
  CHECK_THROWS_AS(simulation.start({jump, jump}), NotFinite);
  CHECK_THROWS_AS(simulation.start({Row(16, 0.0), jump}), NotFinite);
  jump[7] = 0.85 * pi;
  CHECK_NOTHROW(simulation.start({jump, jump}));
  jump[7] = 0.85 * pi + 2 * pi;  // the same point of the circle
  CHECK_NOTHROW(simulation.start({jump, jump}));
  // from rest to a zigzag of 0.8π between neighbours, and to 1.84 times that in the next row
  Row rest(16, 0.0), moved(16, 0.0);
  for (std::size_t i = 0; i < 16; ++i) moved[i] = (i % 2 == 0 ? 0.4 : -0.4) * pi;
  simulation.start({rest, moved});
  const std::string message = testing::message_of([&] {
    for (int n = 0; n < 10; ++n) simulation.step();
  });
  CHECK(contains(message, "0.9 pi"));
  CHECK(contains(message, "site "));
  CHECK(contains(message, "step "));
  Simulation on_line(with(p, [](Problem& q) { q.circle_valued = false; }));
  on_line.start({rest, moved});
  CHECK_NOTHROW(on_line.step());
}

TEST_CASE("on S1 the winding of the start must be the one that the problem states") {
  const Lattice lattice = Lattice::circle(127, 40);
  const auto kink = state("kink", lattice);
  const Row y = reduced(values(*kink, 0, lattice));
  for (int winding : {-1, 0, 1, 2}) {
    Simulation simulation(with(problem("rectangle", lattice, 0.5),
                               [winding](Problem& p) { p.circle_valued = true, p.winding = winding; }));
    CHECK(refused_key([&] { simulation.start({y, y}); }) == (winding == 1 ? "accepted" : "boundary.winding"));
  }
}

TEST_CASE("a kink on a circle winds once: it keeps its charge and shape, and does not without the winding") {
  const Lattice lattice = Lattice::circle(127, 40);
  const auto kink = state("kink", lattice);
  const Row y0 = values(*kink, 0, lattice);
  Simulation wound(with(problem("rectangle-symmetric", lattice, 0.5), [](Problem& p) { p.winding = 1; }));
  wound.start({y0, y0});
  const double energy = wound.monitors().energy;
  CHECK(wound.monitors().charge == 1);
  CHECK(std::abs(energy - 8) < 0.05);
  for (int n = 0; n < 100; ++n) wound.step();
  CHECK(distance(newest(wound, lattice), y0) < 0.01);
  CHECK(std::abs(wound.monitors().energy - energy) < 1e-3);
  Simulation torn(problem("rectangle-symmetric", lattice, 0.5));
  torn.start({y0, y0});
  CHECK(torn.monitors().energy > 50);  // a jump of 2π at the seam: ½(2π)²/k
}

TEST_CASE("charge on an interval is the difference of its ends") {
  const Lattice lattice = Lattice::interval(128, 40);
  const auto kink = state("kink", lattice);
  Simulation simulation(problem("rectangle", lattice, 0.5));
  simulation.start({values(*kink, 0, lattice), values(*kink, 0, lattice)});
  CHECK(std::abs(simulation.monitors().charge - 1) < 1e-7);
  simulation.start({Row(128, 2.0), Row(128, 2.0)});
  CHECK(simulation.monitors().charge == 0);
}

TEST_CASE("the centred start is of second order, a step by Euler of first") {
  const auto error = [](const std::string& stencil, int sites, bool euler) {
    const Lattice lattice = Lattice::circle(sites, 40);
    const Problem p = problem(stencil, lattice, 0.5);
    const auto breather = state("breather", lattice);
    Simulation simulation(p);
    const Row y0 = values(*breather, 0.0, lattice);
    Row velocity = velocities(*breather, lattice);
    if (euler) {
      Row y1 = y0;
      for (std::size_t i = 0; i < y1.size(); ++i) y1[i] += p.time_step * velocity[i];
      simulation.start({y0, y1});
    } else {
      simulation.start_centred(y0, velocity);
    }
    const int steps = static_cast<int>(std::lround(5 / p.time_step));
    while (simulation.newest() < steps) simulation.step();
    return distance(newest(simulation, lattice), values(*breather, steps * p.time_step, lattice));
  };
  for (const char* stencil : {"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric", "hexagon"}) {
    CAPTURE(stencil);
    CHECK(std::abs(std::log2(error(stencil, 200, false) / error(stencil, 400, false)) - 2) < 0.1);
  }
  CHECK(std::abs(std::log2(error("rectangle", 200, true) / error("rectangle", 400, true)) - 1) < 0.2);
}

TEST_CASE("a simulation says how it solves, and what it holds") {
  Simulation implicit(problem("rectangle", Lattice::circle(64, 16), 0.5)),
      open(problem("triangle-vertex", Lattice::circle(64, 16), 0.5));
  CHECK(implicit.starting_rows() == 2);
  CHECK(implicit.solve_kind() == std::string("cyclic-band"));
  CHECK(open.solve_kind() == std::string("explicit"));
  CHECK(contains(open.solve_summary(), "no iteration"));
  CHECK(contains(open.plan_report(), "any matrix"));
  CHECK_FALSE(contains(implicit.plan_report(), "any matrix"));
  CHECK(implicit.bytes() > 10 * 64 * sizeof(double));
  CHECK(open.bytes() < implicit.bytes());
}

TEST_CASE("a simulation may be moved while it runs") {
  const Lattice lattice = Lattice::circle(64, 16);
  Row row;
  for (int i = 0; i < 64; ++i) row.push_back(std::sin(2 * pi * i / 64));
  Simulation first(problem("rectangle", lattice, 0.5)), other(problem("rectangle", lattice, 0.5));
  first.start({row, row});
  other.start({row, row});
  first.step(), other.step();
  Simulation second = std::move(first);
  second.step(), other.step();
  CHECK(newest(second, lattice) == newest(other, lattice));
  CHECK(second.newest() == 3);
}

TEST_CASE("every theory, stencil and method that is listed can be made") {
  CHECK(theories().size() == 22);
  CHECK(stencils().size() == 10);
  CHECK(methods().size() == 11);
  for (const TheoryInfo& theory : theories()) {
    CHECK_FALSE(theory.formula.empty());
    for (const NamedFormula& stencil : stencils()) {
      CHECK_FALSE(stencil.formula.empty());
      const bool on_point = stencil.name == "midpoint" || stencil.name == "trapezoidal" || stencil.name == "vertex";
      CAPTURE(theory.name, stencil.name);
      if (theory.components > 6 && !on_point) continue;  // 18 coordinates are made on a point
      // A stencil belongs on a point or beside neighbours, and is refused elsewhere.
      CHECK(key_of(problem(stencil.name, on_point ? Lattice::point() : Lattice::circle(16, 8), 0.1, theory.name)) ==
            "accepted");
      CHECK(key_of(problem(stencil.name, on_point ? Lattice::circle(16, 8) : Lattice::point(), 0.1, theory.name)) ==
            "lattice.stencil");
    }
  }
}
