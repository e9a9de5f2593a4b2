// SPDX-License-Identifier: MIT
#include "jets/expressions/field_equation.hpp"

#include <cmath>

#include "jets/batch_of.hpp"
#include "jets/expressions/expression.hpp"
#include "jets/expressions/formula_jet.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

// ℓ = ½φ_t² − ½φ_x² + cos φ − 1, compiled
struct SineGordon {
  auto operator()(const auto& j) const {
    using std::cos;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + cos(j.phi) - 1.0;
  }
};

}  // namespace

TEST_CASE("the field equation of a density at a jet, by its text and by its Hessian") {
  const auto text = expression("0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1");
  const BatchOf<SineGordon> compiled{SineGordon{}};
  const std::vector<double> jet{0.7, 0.3, -0.2, 1.1, 0.4, -0.6};
  const double wanted = 1.1 + 0.6 + std::sin(0.7);  // φ_tt − φ_xx + sin φ
  for (const BatchDensity* density :
       {static_cast<const BatchDensity*>(text.get()), static_cast<const BatchDensity*>(&compiled)}) {
    const auto equations = FieldEquations::of(*density);
    REQUIRE(equations);
    CHECK(equations->order() == 2);
    const auto values = (*equations)(jet, 0, 0);
    REQUIRE(values.size() == 1);
    CHECK(values[0].sum == Approx(wanted).epsilon(1e-14));
    CHECK(values[0].absolute == Approx(1.1 + 0.6 + std::sin(0.7)).epsilon(1e-14));
  }
}

TEST_CASE("densities of second order, with places, and under a constraint have their field equations") {
  // D_t² ∂ℓ/∂φ_xx and its like: φ_tt + φ_xxxx = 0
  const auto beam = expression("0.5*phi_t^2 - 0.5*phi_xx^2");
  std::vector<double> jet(15, 0.0);
  jet[3] = 2, jet[14] = 5;  // φ_tt, φ_xxxx
  const auto of_beam = FieldEquations::of(*beam);
  REQUIRE(of_beam);
  CHECK(of_beam->order() == 4);
  CHECK((*of_beam)(jet, 0, 0)[0].sum == Approx(7));
  // D_t (exp(t) φ_t) = exp(t) (φ_tt + φ_t)
  const auto damped = expression("0.5*exp(t)*phi_t^2");
  CHECK((*FieldEquations::of(*damped))(std::vector<double>{0, 3, 0, 4, 0, 0}, 1, 0)[0].sum ==
        Approx(7 * std::exp(1.0)));
  // on the circle u² + v² = 1 at (1, 0): the multiplier takes what points along u
  const auto map =
      expression("0.5*(u_t^2 + v_t^2)", {.fields = {"u", "v"}}, "theory.density", {.constraint = "u^2 + v^2 - 1"});
  const auto on_circle = (*FieldEquations::of(*map))(std::vector<double>{1, 0, 0, 1, 0, 0, -1, 0.5, 0, 0, 0, 0}, 0, 0);
  REQUIRE(on_circle.size() == 3);
  CHECK(std::abs(on_circle[0].sum) < 1e-15);
  CHECK(on_circle[1].sum == Approx(0.5));
  CHECK(std::abs(on_circle[2].sum) < 1e-15);
}

TEST_CASE("a formula has all its derivatives up to an order") {
  const FormulaJet formula("t^2*x^3", {}, "exact.phi", 4);
  const auto jet = formula(2, 3);
  REQUIRE(jet.size() == 15);
  const std::vector<double> wanted{108, 108, 108, 54, 108, 72, 0, 54, 72, 24, 0, 0, 36, 24, 0};
  for (std::size_t n = 0; n < jet.size(); ++n) CHECK(jet[n] == Approx(wanted[n]));
}

TEST_CASE("rounding of a jet is small where terms cancel, and large where they are large") {
  const auto text = expression("0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1");
  const auto equations = FieldEquations::of(*text);
  // in the tail of a kink sin φ is the rounding of φ = 2π
  const std::vector<double> tail{2 * std::acos(-1.0), 0, 0, 1e-30, 0, 1e-30};
  const auto floor = equations->rounding(tail, 0, 0, 1e-15);
  CHECK(std::abs((*equations)(tail, 0, 0)[0].sum) < floor[0]);
  CHECK(floor[0] < 1e-13);
}
