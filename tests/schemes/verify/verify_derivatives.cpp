// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/spacetime_element.hpp"
#include "lattice/index.hpp"
#include "schemes/families/r_adaptive.hpp"
#include "schemes/scheme.hpp"
#include "schemes/theories/klein_gordon.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/theories/wave_map.hpp"
#include "schemes/verify/derivatives.hpp"
#include "schemes/verify/newton_order.hpp"
#include "schemes/verify/wrong_sign.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Family = std::shared_ptr<const StencilFamily>;

constexpr double k = 0.4, h = k / 2;

/// A family in which one entry of the Jacobian is a multiple of what it ought to be.
class WrongEntry final : public StencilFamily {
 public:
  WrongEntry(Family right, int row, int column, double factor)
      : StencilFamily(right->pattern(), right->values(), right->is_variational()),
        right_(std::move(right)),
        entry_(at(row * size() + column)),
        factor_(factor) {
    placed_ = right_->is_placed();
  }
  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    right_->residual(cell, y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    right_->jacobian(cell, y, J);
    J[entry_] *= factor_;
  }
  std::optional<double> lagrangian(const Cell& cell, std::span<const double> y) const override {
    return right_->lagrangian(cell, y);
  }

 private:
  Family right_;
  std::size_t entry_;
  double factor_;
};

/// √(1.5 − φ²) and log φ: not defined at most values of order one.
struct RootAndLogarithm {
  auto operator()(const auto& j) const {
    using std::log, std::sqrt;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + sqrt(1.5 - j.phi * j.phi) + log(j.phi);
  }
};

bool is_mechanics(const std::string& stencil) {
  return stencil == "midpoint" || stencil == "trapezoidal" || stencil == "vertex";
}
Lattice lattice_for(const std::string& stencil) {
  return is_mechanics(stencil) ? Lattice::point() : Lattice::circle(16, 16 * k);
}
LatticeSystem system_with(Family family, const Lattice& lattice) { return {lattice, {std::move(family)}, h}; }

/// The families of a theory on a stencil, its constraint among them, with their components.
LatticeSystem system_named(const TheoryEntry& entry, const std::string& stencil) {
  const auto theory = make_theory(entry, problem_of(entry.name).parameters);
  const Lattice lattice = lattice_for(stencil);
  Families families;
  families.push_back(theory->variational(stencil));
  std::vector<Component> components = fields(theory->components());
  if (const auto constraint = theory->constraint()) {
    families.push_back(constraint);
    components.push_back({"lambda", Role::multiplier, {}});
  }
  return {lattice, families, h, components};
}

/// The check of that name: of a system of one family.
Check named(const std::vector<Check>& checks, const std::string& name) {
  const auto found = std::ranges::find(checks, name, &Check::name);
  REQUIRE(found != checks.end());
  return *found;
}
constexpr const char *of_residual = "derivatives: gradient", *of_jacobian = "derivatives: Jacobian";

void all_pass(const std::vector<Check>& checks) {
  for (const Check& check : checks) {
    CAPTURE(check.name, check.region, check.value, check.failure);
    CHECK(check.passed());
    CHECK(check.samples == 20);
    CHECK(check.normaliser > 0);
  }
}

/// Two waves that run against each other.
Row waves(const Lattice& lattice, int row, double time_step) {
  Row y;
  const double t = row * time_step, by_x = 2 * std::numbers::pi / lattice.length();
  for (int i = 0; i < lattice.sites(); ++i) {
    const double x = by_x * lattice.position(i);
    y.push_back(1.5 * std::cos(x - 0.9 * t) + 0.7 * std::sin(2 * x + t));
  }
  return y;
}
/// 4 arctan(√(1 − w²)/w · sin(wt)/cosh(√(1 − w²)(x − L/2)))
Row breather(const Lattice& lattice, int row, double time_step) {
  constexpr double w = 0.5;
  const double q = std::sqrt(1 - w * w), t = 1 + row * time_step;
  Row y;
  for (int i = 0; i < lattice.sites(); ++i)
    y.push_back(4 * std::atan(q / w * std::sin(w * t) / std::cosh(q * (lattice.position(i) - lattice.length() / 2))));
  return y;
}
/// A wave on a great circle that is tilted, with a zero for the multiplier.
Row on_sphere(const Lattice& lattice, int row, double time_step) {
  Row y;
  for (int i = 0; i < lattice.sites(); ++i) {
    const double angle = 0.8 * std::cos(lattice.position(i)) * std::cos(row * time_step);
    const double tilt = 0.5 * std::sin(lattice.position(i));
    y.insert(y.end(), {std::cos(angle) * std::cos(tilt), std::sin(angle) * std::cos(tilt), std::sin(tilt), 0.0});
  }
  return y;
}

/// The rows that `steps` steps from rows 0 and 1 end with.
Window solved(Evolution& evolution, Row (*row)(const Lattice&, int, double), int steps, int rows) {
  const LatticeSystem& system = evolution.system();
  Stepper& stepper = evolution.stepper();
  stepper.start({row(system.lattice(), 0, system.time_step()), row(system.lattice(), 1, system.time_step())});
  for (int n = 0; n < steps; ++n) stepper.step();
  return stepper.window(rows);
}

/// Newton's check of other families with the plan and the solution of an evolution.
std::optional<Check> newton_of(const Evolution& evolution, const Families& families, const Window& solution) {
  const LatticeSystem& right = evolution.system();
  const LatticeSystem system(right.lattice(), families, right.time_step(), right.all_components());
  return check_newton(system, evolution.plan(), solution, 3);
}

Evolution sine_gordon_circle() {
  const Lattice lattice = Lattice::circle(31, 40);
  return Scheme{rectangle_symmetric, SineGordon{}}.on(lattice, lattice.space_step() / 2);
}

}  // namespace

TEST_CASE("residuals and Jacobians of every theory on every stencil are derivatives") {
  for (const TheoryEntry* entry : theory_entries())
    for (const NamedFormula& stencil : stencils()) {
      // 18 coordinates are checked on a point
      if (!is_mechanics(stencil.name) && make_theory(*entry, problem_of(entry->name).parameters)->components() > 6)
        continue;
      const LatticeSystem system = system_named(*entry, stencil.name);
      CAPTURE(entry->name, stencil.name);
      const auto checks = check_derivatives(system, 1);
      CHECK(checks.size() == 2 * system.families().size());
      all_pass(checks);
    }
}

TEST_CASE("residuals and Jacobians of comparators, elements and a moving mesh are derivatives") {
  for (const char* method : {"vu-quoc-li", "guo", "damped"}) {
    const Family family = family_of(problem_of("phi4"), method);
    REQUIRE(family);
    const auto checks = check_derivatives(system_with(family, lattice_for("")), 2);
    // there is no Lagrangian to compare with
    REQUIRE(checks.size() == 1);
    CHECK(checks[0].name == of_jacobian);
    CHECK(checks[0].count == 20 * family->size() * family->size());
    all_pass(checks);
  }
  const StencilTable element = spacetime_element(3, 2, TimeQuadrature::gauss);
  for (const char* theory : {"sine-gordon-impurity", "complex-klein-gordon"})
    all_pass(check_derivatives(system_with(theory_named(problem_of(theory))->on_table(element), lattice_for("")), 3));
  const LatticeSystem mesh(Lattice::interval(17, 25),
                           {std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
                            std::make_shared<LagrangianFamily<ArclengthConstraint>>(ArclengthConstraint{2.5})},
                           0.01, {{"phi"}, {"X"}, {"lambda", Role::multiplier, {}}});
  const auto checks = check_derivatives(mesh, 4);
  CHECK(checks.size() == 4);
  all_pass(checks);
}

TEST_CASE("jets are drawn where the density is defined") {
  const auto family = jet_family(stencil_table(rectangle.table), RootAndLogarithm{});
  all_pass(check_derivatives(system_with(family, lattice_for("rectangle")), 5));
}

TEST_CASE("a residual with the wrong sign at any value is found, and named") {
  for (const NamedFormula& stencil : stencils())
    for (const char* theory : {"sine-gordon", "coupled-sine-gordon"}) {
      const Lattice lattice = lattice_for(stencil.name);
      const Family right = family_of(problem_of(theory), stencil.name);
      for (int value = 0; value < right->size(); ++value) {
        CAPTURE(stencil.name, theory, value);
        const Family wrong = std::make_shared<WrongSign>(right, value);
        CHECK(wrong->is_variational());
        const auto checks = check_derivatives(system_with(wrong, lattice), 6);
        const Check found = named(checks, of_residual);
        CAPTURE(found.value, found.failure);
        CHECK_FALSE(found.passed());
        // 2 if the value's derivative is the largest at some jet; at the corners of a six-tuple it is much smaller
        CHECK(found.value > (stencil.name == "rectangle-symmetric" ? 1.9 : 0.1));
        CHECK(found.value <= 2 + 1e-9);
        CHECK(contains(found.failure, "∂L/∂y of value " + std::to_string(value) + " (vertex {"));
        CHECK(contains(found.failure, "is not the derivative of L"));
        CHECK(contains(found.failure, "the generated and the measured derivative differ by a factor -1"));
        // the row of the Jacobian changes its sign too, and is still the derivative of the residual
        CHECK(named(checks, of_jacobian).passed());
      }
    }
}

TEST_CASE("a failure names vertex and component") {
  const Family right = family_of(problem_of("coupled-sine-gordon"), "rectangle");
  const auto checks =
      check_derivatives(system_with(std::make_shared<WrongSign>(right, 3), lattice_for("rectangle")), 7);
  CHECK(contains(named(checks, of_residual).failure, "value 3 (vertex {1, 0}, component phi2)"));
  CHECK(contains(named(checks, of_residual).region, "family 1 of 1, 8 values"));
}

TEST_CASE("a wrong entry of the Jacobian is found, and named") {
  for (const char* stencil : {"triangle", "rectangle", "rectangle-symmetric", "hexagon", "six-tuple", "nine-tuple"}) {
    const Family right = family_of(problem_of("phi4"), stencil);
    const Family wrong = std::make_shared<WrongEntry>(right, 1, 2, 2.0);
    const auto checks = check_derivatives(system_with(wrong, lattice_for(stencil)), 8);
    const Check found = named(checks, of_jacobian);
    CAPTURE(stencil, found.value, found.failure);
    CHECK(named(checks, of_residual).passed());
    CHECK_FALSE(found.passed());
    CHECK(found.value > 1e-2);
    CHECK(contains(found.failure, "∂r/∂y of value 1 (vertex {"));
    CHECK(contains(found.failure, "by value 2 (vertex {"));
    CHECK(contains(found.failure, "differ by a factor 2"));
  }
}

TEST_CASE("an error a thousand times the tolerance is found, one that is not a number too") {
  const Family right = family_of(problem_of("phi4"), "rectangle");
  const auto with = [&](double factor) {
    return named(check_derivatives(system_with(std::make_shared<WrongEntry>(right, 0, 0, factor), lattice_for("")), 9),
                 of_jacobian);
  };
  CHECK_FALSE(with(1 + 1e3 * derivative_tolerance).passed());
  CHECK_FALSE(with(std::nan("")).passed());
  CHECK(with(1).passed());
}

TEST_CASE("Newton converges quadratically where the slab is nonlinear") {
  Evolution evolution = sine_gordon_circle();
  const auto check = check_newton(evolution.system(), evolution.plan(), solved(evolution, breather, 6, 3), 3);
  REQUIRE(check.has_value());
  CAPTURE(check->region, check->value);
  CHECK(check->passed());
  CHECK(contains(check->region, "slab 7, 31 unknowns: errors "));
  CHECK(contains(check->region, "order "));
}

TEST_CASE("Newton converges quadratically with a multiplier among the unknowns") {
  const Lattice lattice = Lattice::circle(16, 2 * std::numbers::pi);
  Evolution evolution = Scheme{rectangle, WaveMap{}}.on(lattice, lattice.space_step() / 4);
  const Window solution = solved(evolution, on_sphere, 6, 3);
  const auto check = check_newton(evolution.system(), evolution.plan(), solution, 3);
  REQUIRE(check.has_value());
  CAPTURE(check->region, check->value);
  CHECK(check->passed());
  CHECK(contains(check->region, "order "));

  // the check can fail: ∂²L/∂u∂λ of the constraint at double strength
  Families families(evolution.system().families().begin(), evolution.system().families().end());
  families.back() = std::make_shared<WrongEntry>(families.back(), 3, 0, 2.0);
  const auto wrong = newton_of(evolution, families, solution);
  REQUIRE(wrong.has_value());
  CAPTURE(wrong->region, wrong->value, wrong->failure);
  CHECK_FALSE(wrong->passed());
}

TEST_CASE("Newton solves linear equations at once") {
  const Lattice lattice = Lattice::circle(31, 40);
  Evolution evolution = Scheme{rectangle_symmetric, KleinGordon{}}.on(lattice, lattice.space_step() / 2);
  const auto check = check_newton(evolution.system(), evolution.plan(), solved(evolution, waves, 6, 3), 3);
  REQUIRE(check.has_value());
  CHECK(check->value == 0);
  CHECK(contains(check->region, "converges at once: linear in the slab"));
}

TEST_CASE("a wrong entry of the Jacobian makes Newton converge with order one") {
  Evolution evolution = sine_gordon_circle();
  const Window solution = solved(evolution, breather, 6, 3);
  const Family right = evolution.system().families()[0];
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const auto check = newton_of(evolution, {std::make_shared<WrongEntry>(right, row, column, 2.0)}, solution);
      REQUIRE(check.has_value());
      CAPTURE(row, column, check->region, check->value, check->failure);
      // The equations of a slab, at row J − 1, see the stencils below row J: what they contain of row J is ∂r/∂y from
      // their lower vertices by their upper ones.
      const bool in_slab = right->site(row).time == 0 && right->site(column).time == 1;
      CHECK(check->passed() == !in_slab);
      if (in_slab) CHECK(contains(check->failure, "the Jacobian is not the derivative of the equations"));
    }
}

TEST_CASE("Newton is not asked about a window that is too short") {
  Evolution evolution = sine_gordon_circle();
  CHECK_FALSE(check_newton(evolution.system(), evolution.plan(), solved(evolution, breather, 6, 2), 3).has_value());
}
