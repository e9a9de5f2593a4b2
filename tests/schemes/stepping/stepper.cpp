// SPDX-License-Identifier: MIT
#include "schemes/stepping/stepper.hpp"

#include <numbers>
#include <set>

#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "lattice/index.hpp"
#include "schemes/scheme.hpp"
#include "schemes/stepping/newton.hpp"
#include "schemes/theories/klein_gordon.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.1, k = 0.25;

std::vector<std::string> all_schemes() {
  std::vector<std::string> names = stencil_names();
  names.insert(names.end(), {"guo", "vu-quoc-li"});
  return names;
}

/// The worst defect and residual() of three steps from random rows.
struct Worst {
  double defect = 0, residual = 0;
};
Worst worst_of(Evolution& evolution, double amplitude = 1, int steps = 3) {
  Stepper& stepper = evolution.stepper();
  Random random(41);
  stepper.start(random_rows(random, stepper.starting_rows(), evolution.system().lattice().sites(), amplitude));
  Worst worst;
  for (int n = 0; n < steps; ++n) {
    stepper.step();
    worst.defect = std::max(worst.defect, equation_defect(evolution, window_of(evolution)));
    worst.residual = std::max(worst.residual, stepper.residual());
  }
  return worst;
}

Lattice walls(int N, Wall left, Wall right) { return Lattice::interval(N, (N - 1) * k, left, right); }

// ---- densities and residuals whose second derivatives do not depend on the field, though the form does not show it

struct Spring {  // a mass that depends on the place
  static constexpr bool placed = true;
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - (0.5 + 0.3 * sin(j.x)) * (j.phi * j.phi);
  }
};
struct Medium {  // an inertia that depends on the place
  static constexpr bool placed = true;
  auto operator()(const auto& j) const {
    return 0.5 * (1.0 + 0.3 * sin(j.x)) * (j.phi_t * j.phi_t) - 0.5 * (j.phi_x * j.phi_x);
  }
};
struct Hidden {  // (φ + 1)³ − φ³
  auto operator()(const auto& j) const {
    const auto w = j.phi + 1.0;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - 0.2 * (w * w * w - j.phi * j.phi * j.phi);
  }
};
/// A damping −κφ_t as a difference over both steps, or over the known one only.
std::shared_ptr<const StencilFamily> damped(double kappa, bool centred) {
  DirectResidual stencil = damped_leapfrog(kappa);
  if (!centred) stencil.by_t = {kappa, 0, -kappa, 0, 0};
  return TheoryOf<KleinGordon>(KleinGordon{1}).comparator(stencil);
}

/// ½φ_t² − ½φ_x² − ¼φ_x⁴: nonlinear in a derivative, and explicit on triangles.
struct Chain {
  auto operator()(const auto& j) const {
    const auto s = j.phi_x * j.phi_x;
    return 0.5 * (j.phi_t * j.phi_t - s) - 0.25 * (s * s);
  }
};
/// ½|φ_t|² − ½|φ_x|² + cos(φ¹ − φ²) in ℝ²
struct Pair {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    return 0.5 *
               (j.phi_t[0] * j.phi_t[0] + j.phi_t[1] * j.phi_t[1] - j.phi_x[0] * j.phi_x[0] - j.phi_x[1] * j.phi_x[1]) +
           cos(j.phi[0] - j.phi[1]);
  }
};

/// Runs `steps`, swaps the last two rows, and runs back: the distance to where it began.
double there_and_back(Evolution& evolution, int steps) {
  Stepper& stepper = evolution.stepper();
  const int N = evolution.system().lattice().sites();
  std::vector<Row> start;
  for (int j : {0, 1}) {
    start.emplace_back();
    for (int i = 0; i < N; ++i)
      start.back().push_back(std::sin(2 * std::numbers::pi * i / N) + 0.1 * j * std::cos(6 * std::numbers::pi * i / N));
  }
  stepper.start(start);
  for (int n = 0; n < steps; ++n) stepper.step();
  stepper.start({stepper.row(0), stepper.row(1)});
  for (int n = 0; n < steps; ++n) stepper.step();
  return std::max(distance(stepper.row(0), start[0]), distance(stepper.row(1), start[1]));
}

}  // namespace

TEST_CASE("a step solves the field equations at every site of a circle, for every theory and scheme") {
  for (const std::string& theory : theory_names())
    for (const std::string& scheme : all_schemes())
      for (int N : {2, 3, 4, 5, 16, 63, 64}) {
        const Problem p = problem_of(theory);
        if (!family_of(p, scheme) || (scheme == "hexagon" && N % 2 != 0)) continue;
        CAPTURE(theory, scheme, N);
        Evolution evolution = evolution_of(p, scheme, Lattice::circle(N, N * k), h);
        const Worst worst = worst_of(evolution);
        CHECK(worst.defect < 2e-15);
        CHECK(worst.residual < 4e-15);
      }
}

TEST_CASE("a step solves the field equations at every site between walls, fixed or natural") {
  const Wall either[]{Wall::fixed, Wall::natural};
  for (const std::string& theory : theory_names())
    for (const std::string& scheme : all_schemes())
      for (int N : {2, 3, 5, 17})
        for (Wall left : either)
          for (Wall right : either) {
            const Problem p = problem_of(theory);
            const bool wide = scheme == "hexagon" || scheme == "six-tuple" || scheme == "nine-tuple" ||
                              scheme == "guo" || scheme == "vu-quoc-li";
            const bool natural = left == Wall::natural || right == Wall::natural;
            if (!family_of(p, scheme)) continue;
            if (N == 2 && (wide || !natural)) continue;                // no equation at all
            if (scheme == "hexagon" && (N == 3 || natural)) continue;  // sites solved in other rows than the rest
            CAPTURE(theory, scheme, N, left == Wall::natural, right == Wall::natural);
            Evolution evolution = evolution_of(p, scheme, walls(N, left, right), h);
            const Worst worst = worst_of(evolution);
            CHECK(worst.defect < 2e-15);
            CHECK(worst.residual < 1e-14);  // two free sites grow: rounding at the size that they had leaves most
            const Row before = evolution.stepper().row(1), now = evolution.stepper().row(0);
            if (left == Wall::fixed) CHECK(now.front() == before.front());
            if (right == Wall::fixed) CHECK(std::abs(now.back() - before.back()) < 1e-16);
          }
}

TEST_CASE("the equations can be seen to be violated: one value moved by 1e-9") {
  Evolution evolution = evolution_of(problem_of("sine-gordon"), "rectangle", Lattice::circle(16, 16 * k), h);
  CHECK(worst_of(evolution).defect < 2e-15);
  Window moved = window_of(evolution);
  moved.rows.back()[7] += 1e-9;
  CHECK(equation_defect(evolution, moved) > 1e-11);
}

TEST_CASE("a density that is nonlinear in its derivatives is stepped, explicit on triangles and implicit on others") {
  const Lattice ring = Lattice::circle(32, 32 * k);
  const auto check = [&](Evolution evolution, bool iterates) {
    const Worst worst = worst_of(evolution, 0.3);
    CHECK(worst.defect < 2e-15);
    CHECK(worst.residual < 1e-14);
    CHECK((evolution.stepper().iterations() > 0) == iterates);
  };
  check(Scheme{triangle, Chain{}}.on(ring, h), false);
  check(Scheme{rectangle, Chain{}}.on(ring, h), true);
  check(Scheme{hexagon, Chain{}}.on(ring, h), true);
  check(Scheme{rectangle, Chain{}}.on(walls(32, Wall::natural, Wall::fixed), h), true);
}

TEST_CASE("a fixed wall keeps its value, however the rows before moved there and whatever the density") {
  const auto kept = [](Evolution evolution) {
    worst_of(evolution, 0.3, 1);  // random rows, whose walls move
    Stepper& stepper = evolution.stepper();
    bool same = true;
    for (int n = 0; n < 4; ++n) {
      const Row before = stepper.row(0);
      stepper.step();
      same = same && std::abs(stepper.row(0).front() - before.front()) < 1e-15 &&
             std::abs(stepper.row(0).back() - before.back()) < 1e-15;
    }
    return same;
  };
  const Lattice fixed = walls(32, Wall::fixed, Wall::fixed);
  CHECK(kept(Scheme{rectangle, SineGordon{}}.on(fixed, h)));
  CHECK(kept(Scheme{triangle, SineGordon{}}.on(fixed, h)));
  CHECK(kept(Scheme{triangle, Chain{}}.on(fixed, h)));
  CHECK(kept(Scheme{rectangle, Chain{}}.on(fixed, h)));
  CHECK_FALSE(kept(Scheme{rectangle, SineGordon{}}.on(walls(32, Wall::natural, Wall::fixed), h)));
}

TEST_CASE("fields of two components are stepped") {
  for (int N : {3, 8, 33}) {
    Evolution evolution = Scheme{rectangle, Pair{}}.on(Lattice::circle(N, N * k), h);
    Stepper& stepper = evolution.stepper();
    Random random(42);
    stepper.start(random_rows(random, 2, 2 * N, 1));
    for (int n = 0; n < 3; ++n) stepper.step();
    CHECK(equation_defect(evolution, window_of(evolution)) < 2e-15);
    // what is added to both components moves on freely: the mean of the sum is linear in time
    const auto mean = [&](int back) {
      double sum = 0;
      for (double y : stepper.row(back)) sum += y / N;
      return sum;
    };
    CHECK(std::abs(mean(0) - 2 * mean(1) + mean(2)) < 1e-14);
  }
}

TEST_CASE("coefficients that are constant but not written so are solved all the same: densities") {
  const Lattice ring = Lattice::circle(32, 32 * k);
  const auto defect = [&](Evolution evolution) { return worst_of(evolution, 0.5).defect; };
  CHECK(defect(Scheme{triangle, Spring{}}.on(ring, h)) < 2e-15);
  CHECK(defect(Scheme{rectangle, Spring{}}.on(ring, h)) < 2e-15);
  CHECK(defect(Scheme{triangle, Hidden{}}.on(ring, h)) < 2e-15);
  CHECK(defect(Scheme{rectangle_symmetric, Hidden{}}.on(ring, h)) < 2e-15);
  CHECK(defect(Scheme{triangle, Medium{}}.on(ring, h)) < 2e-15);
  CHECK(defect(Scheme{rectangle, Medium{}}.on(ring, h)) < 2e-15);
}

TEST_CASE("coefficients that are constant but not written so are solved all the same: residual stencils") {
  const Lattice ring = Lattice::circle(32, 32 * k);
  const auto defect = [&](std::shared_ptr<const StencilFamily> family) {
    Evolution evolution(ring, {std::move(family)}, h);
    return worst_of(evolution).defect;
  };
  const TheoryOf<KleinGordon> klein_gordon(KleinGordon{2});
  CHECK(defect(klein_gordon.comparator(guo())) < 2e-15);
  CHECK(defect(klein_gordon.comparator(vu_quoc_li())) < 2e-15);
  CHECK(defect(damped(0.1, false)) < 2e-15);
  CHECK(defect(damped(0.1, true)) < 2e-15);
}

TEST_CASE("residual() is what a loose tolerance leaves, and leaves no trace") {
  const Lattice ring = Lattice::circle(63, 63 * k);
  const Problem p = problem_of("sine-gordon");
  StepOptions loose;
  loose.tolerance = 1e-3;
  Evolution evolution = evolution_of(p, "rectangle", ring, h, loose);
  const Worst worst = worst_of(evolution);
  CHECK(worst.residual > 1e-9);
  CHECK(worst.residual < 1e-3);
  CHECK(worst.residual > 0.1 * worst.defect);
  CHECK(worst.residual < 1000 * worst.defect);

  Evolution asked = evolution_of(p, "rectangle", ring, h, loose), silent = evolution_of(p, "rectangle", ring, h, loose);
  Random random(43);
  const std::vector<Row> start = random_rows(random, 2, 63, 1);
  asked.stepper().start(start);
  silent.stepper().start(start);
  for (int n = 0; n < 20; ++n) {
    asked.stepper().step();
    silent.stepper().step();
    asked.stepper().residual();
  }
  CHECK(asked.stepper().row(0) == silent.stepper().row(0));
}

TEST_CASE("a linear theory is solved at once, and so is an explicit scheme, and other steps iterate") {
  const auto iterations = [](const std::string& theory, const std::string& scheme) {
    Evolution evolution = evolution_of(problem_of(theory), scheme, Lattice::circle(64, 64 * k), h);
    worst_of(evolution);
    return evolution.stepper().iterations();
  };
  for (const std::string& scheme : stencil_names()) {
    CHECK(iterations("wave", scheme) == 0);
    CHECK(iterations("klein-gordon", scheme) == 0);
    CHECK((iterations("sine-gordon", scheme) > 0) == (scheme != "triangle-vertex"));
  }
}

TEST_CASE("the plan is found, not stated: explicit, one number, recurrences, a band") {
  const auto plan = [](const std::string& theory, const std::string& scheme, double step) {
    const Evolution evolution = evolution_of(problem_of(theory), scheme, Lattice::circle(64, 64 * k), step);
    return std::string(to_string(evolution.plan().kind)) + ": " + evolution.stepper().report(false).solver;
  };
  CHECK(plan("sine-gordon", "triangle-vertex", h) == "explicit: division by one number");
  CHECK(plan("wave", "triangle", h) == "explicit: division by one number");
  CHECK(plan("sine-gordon", "triangle", h) == "cyclic-band: division by one number");
  CHECK(plan("sine-gordon", "rectangle-symmetric", k) == "cyclic-band: division by one number");  // h = k
  CHECK(contains(plan("sine-gordon", "rectangle-symmetric", h), "cyclic-band: two recurrences"));
  CHECK(contains(plan("sine-gordon", "rectangle", k), "cyclic-band: two recurrences"));
  const Evolution none = evolution_of(problem_of("sine-gordon"), "triangle-vertex", Lattice::circle(64, 64 * k), h);
  CHECK(none.stepper().matrix_free());
  CHECK_FALSE(evolution_of(problem_of("sine-gordon"), "rectangle", walls(64, Wall::fixed, Wall::fixed), h)
                  .stepper()
                  .matrix_free());
}

TEST_CASE("sine-Gordon runs back to where it began") {
  for (const std::string& scheme :
       {std::string("rectangle"), std::string("rectangle-symmetric"), std::string("hexagon"), std::string("guo")}) {
    CAPTURE(scheme);
    Evolution evolution = evolution_of(problem_of("sine-gordon"), scheme, Lattice::circle(64, 64 * k), h);
    CHECK(there_and_back(evolution, 50) < 1e-10);
  }
}

TEST_CASE("running back can fail: with a damping it does not reach where it began") {
  Evolution evolution(Lattice::circle(64, 64 * k), {damped(0.1, false)}, h);
  CHECK(there_and_back(evolution, 50) > 1e-3);
}

TEST_CASE("starting again gives the same bits, whatever was stepped before") {
  Evolution evolution = evolution_of(problem_of("sine-gordon"), "rectangle", Lattice::circle(31, 31 * k), h);
  Stepper& stepper = evolution.stepper();
  Random random(44);
  const std::vector<Row> start = random_rows(random, 2, 31, 1);
  Row first;
  for (int again = 0; again < 2; ++again) {
    stepper.start(start);
    CHECK(stepper.newest() == 1);
    for (int n = 0; n < 15; ++n) stepper.step();
    if (again == 0) first = stepper.row(0);
  }
  CHECK(first == stepper.row(0));
}

TEST_CASE("a turn around the circle is kept: a field that winds is the one that does not, plus its slope") {
  // of the wave equation: y_i + 2πi/N
  const int N = 37;
  StepOptions winding;
  winding.monodromy = 2 * std::numbers::pi;
  for (const std::string& scheme :
       {std::string("triangle"), std::string("rectangle-symmetric"), std::string("vu-quoc-li")}) {
    Evolution flat = evolution_of(problem_of("wave"), scheme, Lattice::circle(N, N * k), h);
    Evolution turned = evolution_of(problem_of("wave"), scheme, Lattice::circle(N, N * k), h, winding);
    Random random(45);
    std::vector<Row> start = random_rows(random, 2, N, 1);
    flat.stepper().start(start);
    for (Row& row : start)
      for (int i = 0; i < N; ++i) row[i] += winding.monodromy * i / N;
    turned.stepper().start(start);
    for (int n = 0; n < 40; ++n) flat.stepper().step(), turned.stepper().step();
    Row back = turned.stepper().row(0);
    for (int i = 0; i < N; ++i) back[i] -= winding.monodromy * i / N;
    CHECK(distance(back, flat.stepper().row(0)) < 1e-12);
    CHECK(equation_defect(turned, window_of(turned, winding.monodromy)) < 2e-15);
    CHECK(equation_defect(turned, window_of(turned)) > 1e-3);  // without the turn the seam shows
  }
}

TEST_CASE("the order of the seed changes the number of iterations, not the solution") {
  const auto run = [](int order) {
    StepOptions options;
    options.predictor_order = order;
    Evolution evolution = evolution_of(problem_of("sine-gordon"), "rectangle", Lattice::circle(64, 64 * k), h, options);
    Stepper& stepper = evolution.stepper();
    std::vector<Row> start(2);
    for (int i = 0; i < 64; ++i)
      for (int j : {0, 1}) start[j].push_back(std::sin(2 * std::numbers::pi * i / 64 - 0.04 * j));
    stepper.start(start);
    int iterations = 0;
    for (int n = 0; n < 100; ++n) stepper.step(), iterations += stepper.iterations();
    return std::pair{iterations, stepper.row(0)};
  };
  const auto [many, plain] = run(1);
  const auto [few, extrapolated] = run(8);
  CHECK(few < many);
  CHECK(distance(plain, extrapolated) < 1e-11);
}

TEST_CASE("the centred start solves the equation at row 0 with y₋₁ = y₁ − 2hφ_t") {
  for (const std::string& scheme : all_schemes()) {
    CAPTURE(scheme);
    Evolution evolution = evolution_of(problem_of("sine-gordon"), scheme, Lattice::circle(32, 32 * k), h);
    Stepper& stepper = evolution.stepper();
    Random random(46);
    const Row y0 = random_row(random, 32, 1), velocity = random_row(random, 32, 1);
    stepper.start_centred(y0, velocity);
    REQUIRE(stepper.newest() == 1);
    CHECK(stepper.row(1) == y0);
    Window window{&evolution.system().lattice(), 1, 0, -1, {stepper.row(0), y0, stepper.row(0)}};
    for (std::size_t i = 0; i < 32; ++i) window.rows[0][i] -= 2 * h * velocity[i];
    CHECK(equation_defect(evolution, window) < 2e-15);
    window.rows[0][3] += 1e-6;
    CHECK(equation_defect(evolution, window) > 1e-9);
  }
}

TEST_CASE("a start that is not finite is refused") {
  Evolution evolution = evolution_of(problem_of("sine-gordon"), "triangle", Lattice::circle(8, 8 * k), h);
  Row bad(8, 0.0);
  bad[5] = std::nan("");
  CHECK_THROWS_AS(evolution.stepper().start({Row(8, 0.0), bad}), NotFinite);
}

TEST_CASE("a step before a start is refused, and a start from rows of another size, however the scheme is stepped") {
  for (const char* method : {"multisymplectic", "composition", "spacetime"}) {
    CAPTURE(method);
    Problem p = problem_of("sine-gordon");
    p.method = method, p.time_step = p.lattice.space_step() / 8;
    Simulation simulation(p);
    CHECK_THROWS_AS(simulation.step(), std::logic_error);
    const auto start = [&](std::size_t values) {
      const Row row(values, 0.1), at_rest(values, 0.0);
      if (p.method == "multisymplectic") simulation.start_centred(row, at_rest);
      else simulation.start_legendre(row, at_rest);
    };
    const std::size_t values = at(p.lattice.sites()) * simulation.components().size();
    for (const std::size_t wrong : {values - 1, values + 1}) CHECK_THROWS_AS(start(wrong), BadInput);
    CHECK_THROWS_AS(simulation.step(), std::logic_error);
    start(values);
    CHECK_NOTHROW(simulation.step());
  }
}

TEST_CASE("a step says whether it was followed by continuation, and why") {
  const auto why = [](double mass, int max_iterations) {
    Problem p = problem_of("sine-gordon");
    p.parameters["theory.mass"] = mass;
    StepOptions options;
    options.max_iterations = max_iterations;
    Evolution evolution = evolution_of(p, "rectangle", Lattice::circle(21, 21 * k), h, options);
    worst_of(evolution, 1, 1);
    return evolution.stepper().continued();
  };
  CHECK(why(1.2, 50) == Continued::no);
  CHECK(why(1.2, 2) == Continued::out_of_iterations);
  CHECK(why(25, 50) == Continued::stiff);
}

TEST_CASE("where few iterations are allowed the advice is to allow more, or else a smaller step") {
  const auto advice = [](int max_iterations, const Row& velocity) {
    StepOptions options;
    options.max_iterations = max_iterations;
    Evolution evolution = evolution_of(problem_of("sine-gordon"), "rectangle", Lattice::circle(21, 21 * k), h, options);
    const Row row(21, 0.5);
    return message_of([&] {
      evolution.stepper().start_centred(row, velocity);
      evolution.stepper().step();
    });
  };
  const std::string few = advice(1, Row(21, 0.3));
  CHECK(contains(few, "scheme.max_iterations = 1 leaves it too few: raise it"));
  CHECK_FALSE(contains(few, "lattice.courant"));
  CHECK(contains(remedy_for(50), "reduce lattice.courant"));
}

TEST_CASE("a tolerance below what rounding allows is the least that it allows, to the bit") {
  for (const char* scheme : {"rectangle", "hexagon"}) {
    const auto row = [&](double tolerance) {
      StepOptions options;
      options.tolerance = tolerance;
      Evolution evolution = evolution_of(problem_of("sine-gordon"), scheme, Lattice::circle(22, 22 * k), h, options);
      worst_of(evolution);
      return evolution.stepper().row(0);
    };
    CHECK(row(1e-300) == row(smallest_tolerance));
    CHECK(row(1e-4) != row(smallest_tolerance));
  }
}
