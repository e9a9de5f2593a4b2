// SPDX-License-Identifier: MIT
#include "schemes/stepping/newton.hpp"

#include <numbers>
#include <optional>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

// A uniform field under (5.10) or (5.12), with μ = (mh)²:
//     y₊ − 2y + y₋ + ½μ (sin ½(y₊ + y) + sin ½(y + y₋)) = 0
struct Uniform {
  double mu, before, now;

  double value(double next, double last, double strength) const {
    return next - 2 * now + last + strength / 2 * (std::sin((next + now) / 2) + std::sin((now + last) / 2));
  }
  double slope(double next, double strength) const { return 1 + strength / 4 * std::cos((next + now) / 2); }

  /// The root that a small step leads to, followed in 2000 strides of equal length: with the step sh the row before is
  /// as far away as the same velocity puts it. Nothing where the path turns back.
  std::optional<double> continued() const {
    double root = now;
    constexpr int strides = 2000;
    for (int n = 1; n <= strides; ++n) {
      const double s = static_cast<double>(n) / strides, last = now - s * (now - before), strength = s * s * mu;
      double change = 1;
      for (int it = 0; it < 20 && std::abs(change) > 1e-13; ++it) {
        if (slope(root, strength) <= 0) return std::nullopt;
        change = value(root, last, strength) / slope(root, strength);
        root -= change;
      }
      if (!(std::abs(change) < 1e-12)) return std::nullopt;
    }
    return root;
  }
};

/// A step of sine-Gordon from two uniform rows, h = 5k; nothing where the engine refuses.
std::optional<double> stepped(Evolution& evolution, const Uniform& u) {
  const std::size_t N = at(evolution.system().lattice().sites());
  Stepper& stepper = evolution.stepper();
  stepper.start({Row(N, u.before), Row(N, u.now)});
  try {
    stepper.step();
  } catch (const NoConvergence&) {
    CHECK(stepper.newest() == 1);  // still holds what it held
    CHECK(stepper.row(0) == Row(N, u.now));
    return std::nullopt;
  }
  const Row row = stepper.row(0);
  CHECK(distance(row, Row(N, row[0])) < 1e-10);
  CHECK(stepper.residual() < 1e-13);
  return row[0];
}

Evolution stiff(const std::string& theory, const std::string& stencil, int N, double mass_times_step) {
  const double k = 0.5, h = 5 * k;
  Problem p;
  p.theory = theory, p.parameters["theory.mass"] = mass_times_step / h;
  return evolution_of(p, stencil, Lattice::circle(N, N * k), h);
}

struct Count {
  int solved = 0, refused = 0, other_root = 0;
};
Count count(const std::string& stencil, double mass_times_step, double velocity, int starts) {
  Evolution evolution = stiff("sine-gordon", stencil, 4, mass_times_step);
  Random random(51);
  Count result;
  for (int n = 0; n < starts; ++n) {
    Uniform u{mass_times_step * mass_times_step, 0, random(-3.1, 3.1)};
    u.before = u.now - random(-velocity, velocity);
    const auto root = stepped(evolution, u), right = u.continued();
    if (!root) ++result.refused;
    else if (right && std::abs(*root - *right) < 1e-9) ++result.solved;
    else ++result.other_root;
  }
  return result;
}

}  // namespace

TEST_CASE("Klein-Gordon at mh = 10 and Courant 5 is solved at once and stays bounded, where a triangle blows up") {
  for (const char* stencil : {"rectangle", "rectangle-symmetric", "triangle"}) {
    CAPTURE(stencil);
    Evolution evolution = stiff("klein-gordon", stencil, 63, 10);
    Stepper& stepper = evolution.stepper();
    Row y0;
    for (int i = 0; i < 63; ++i) y0.push_back(std::sin(2 * std::numbers::pi * i / 63));
    stepper.start({y0, y0});
    double largest = 0;
    for (int n = 0; n < (stencil == std::string("triangle") ? 30 : 500); ++n) {
      stepper.step();
      CHECK(stepper.iterations() == 0);
      largest = std::max(largest, distance(stepper.row(0), Row(63, 0)));
    }
    CHECK(stepper.residual() < 1e-14);
    // y_j = cos(ωh(j − ½))/cos(½ωh), tan²(½ωh) ≈ ¼(mh)² = 25
    CHECK((largest < 6) == (stencil != std::string("triangle")));
  }
}

TEST_CASE("where the step is not stiff every uniform start of sine-Gordon is solved, for its only root") {
  for (const char* stencil : {"rectangle", "rectangle-symmetric"})
    for (const double mh : {0.5, 1.0, 1.9}) {
      CAPTURE(stencil, mh);
      const Count all = count(stencil, mh, 1, 30);
      CHECK(all.solved == 30);
    }
}

TEST_CASE("a stiff uniform step of sine-Gordon is solved for the root that a small step leads to, or refused") {
  for (const auto& [stencil, mh] : std::vector<std::pair<const char*, double>>{
           {"rectangle", 2.5}, {"rectangle", 4}, {"rectangle", 10}, {"rectangle-symmetric", 10}}) {
    CAPTURE(stencil, mh);
    const Count all = count(stencil, mh, 0.3, 40);
    CHECK(all.other_root == 0);
    CHECK(all.solved > 0);
  }
}

TEST_CASE("so is one whose rows are far apart") {
  for (const double mh : {4.0, 10.0}) {
    CAPTURE(mh);
    CHECK(count("rectangle", mh, 1.5, 30).other_root == 0);
  }
}

TEST_CASE("the comparison can fail: plain Newton from y₊ = 2y − y₋ finds other roots at mh = 10") {
  Random random(53);
  int others = 0;
  for (int n = 0; n < 150; ++n) {
    Uniform u{100, 0, random(-3.1, 3.1)};
    u.before = u.now - random(-0.3, 0.3);
    double next = 2 * u.now - u.before;
    for (int it = 0; it < 100; ++it) next -= u.value(next, u.before, u.mu) / u.slope(next, u.mu);
    const auto right = u.continued();
    others += std::abs(u.value(next, u.before, u.mu)) < 1e-9 && (!right || std::abs(next - *right) > 1e-6);
  }
  CHECK(others > 10);
}

TEST_CASE("a slab is solved by Newton's method to round-off, with the walls as they are") {
  const double h = 0.3, k = 0.25;
  const Lattice walls = Lattice::interval(12, 11 * k);
  const Evolution evolution = evolution_of(problem_of("phi4"), "rectangle", walls, h);
  Random random(54);
  Window past{&walls, 1, 0, 0, random_rows(random, 2, 12, 0.5)};
  const NewtonResult result = solve_slab(evolution.system(), evolution.plan(), past, 1e-14, 50);
  REQUIRE(result.converged);
  CHECK(result.row.front() == past.rows[1].front());
  CHECK(result.row.back() == past.rows[1].back());
  past.rows.push_back(result.row);
  CHECK(equation_defect(evolution, past) < 2e-15);
}

TEST_CASE("too few iterations are said so") {
  const Lattice ring = Lattice::circle(8, 2);
  const Evolution evolution = evolution_of(problem_of("sine-gordon"), "rectangle", ring, 0.3);
  Random random(55);
  const Window past{&ring, 1, 0, 0, random_rows(random, 2, 8, 1)};
  CHECK_FALSE(solve_slab(evolution.system(), evolution.plan(), past, 1e-14, 1).converged);
  CHECK(solve_slab(evolution.system(), evolution.plan(), past, 1e-14, 50).converged);
}

namespace {

/// Counts how often a stencil's Jacobian is asked for.
class Counting final : public StencilFamily {
 public:
  explicit Counting(std::shared_ptr<const StencilFamily> family)
      : StencilFamily(family->pattern(), family->values(), family->is_variational()), family_(std::move(family)) {}
  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    family_->residual(cell, y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    ++jacobians;
    family_->jacobian(cell, y, J);
  }
  mutable int jacobians = 0;

 private:
  std::shared_ptr<const StencilFamily> family_;
};

}  // namespace

TEST_CASE("a centred start asks for the Jacobian of each stencil once, and is the root of the equations") {
  constexpr int N = 64;  // whole packs: what the last one repeats is counted too
  const double k = 0.4, h = 0.2;
  for (const char* theory : {"sine-gordon", "coupled-sine-gordon", "complex-klein-gordon"})
    for (const char* stencil : {"rectangle-symmetric", "rectangle", "triangle", "triangle-vertex", "hexagon"}) {
      CAPTURE(theory, stencil);
      const auto counting = std::make_shared<Counting>(family_of(problem_of(theory), stencil));
      const LatticeSystem system(Lattice::circle(N, N * k), {counting}, h);
      const SolvePlan plan = make_plan(system.lattice(), system.pattern());
      if (plan.history != 2) continue;
      const int d = system.components();
      Random random(11);
      Row y0, velocity;
      for (int i = 0; i < N * d; ++i) {
        y0.push_back(std::sin(2 * std::numbers::pi * (i / d) / N) + i % d);
        velocity.push_back(random(-0.1, 0.1));
      }
      const Window first{&system.lattice(), d, 0, 0, {y0}};
      counting->jacobians = 0;
      const NewtonResult quick = solve_centred_start(system, plan, first, velocity, false, 1e-14, 50);
      // Stencils below row 0 and above it; those of a brick wall stand at every second site.
      const int rows = stencil == std::string("hexagon") ? 3 : 2;
      CHECK(counting->jacobians <= rows * N);
      REQUIRE(quick.converged);
      counting->jacobians = 0;
      const NewtonResult followed = solve_centred_start(system, plan, first, velocity, true, 1e-14, 50);
      CHECK(counting->jacobians > 10 * rows * N);  // the count can be more
      REQUIRE(followed.converged);
      CHECK(distance(quick.row, followed.row) < 1e-13);
      Row before;
      for (std::size_t i = 0; i < y0.size(); ++i) before.push_back(quick.row[i] - 2 * h * velocity[i]);
      const auto largest = [&](const Row& row1) {
        std::vector<LatticeSystem::Value> values;
        system.equations(system.window(-1, {before, y0, row1}, 0), 0, values);
        double defect = 0, size = 0;  // where all terms are small the solver's tolerance is not
        for (const auto& value : values)
          defect = std::max(defect, std::abs(value.sum)), size = std::max(size, value.absolute);
        return defect / size;
      };
      CHECK(largest(quick.row) < 2e-14);
      Row other = quick.row;
      other[7] += 1e-9;
      CHECK(largest(other) > 1e-9);
    }
}
