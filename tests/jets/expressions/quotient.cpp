// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/simd/pack.hpp"
#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

struct Values {
  double q, by_a, by_b;
};
Values quotient(const BatchDensity& density, double a, double b) {
  const Pack at_a(a), at_b(b);
  Pack q, by_a, by_b;
  const auto row = [](const Pack& p) { return reinterpret_cast<const double*>(&p); };
  const std::vector<const double*> in{row(at_a), row(at_b)};
  double* const value[] = {reinterpret_cast<double*>(&q)};
  double* const slopes[] = {reinterpret_cast<double*>(&by_a), reinterpret_cast<double*>(&by_b)};
  density.difference_quotient({lanes, in.data()}, value);
  density.differentiate_quotient({lanes, in.data()}, slopes);
  return {q[0], by_a[0], by_b[0]};
}

}  // namespace

TEST_CASE("difference quotients of texts are those that compiled densities declare, near a = b too") {
  const auto sine_gordon = expression("0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1");
  const auto phi4 = expression("0.5*(phi_t^2 - phi_x^2) - 0.25*0.7*(phi^2 - 1)^2");
  REQUIRE(sine_gordon->has_difference_quotient());
  Random random(4);
  double worst = 0, worst_slope = 0, planted = 0;
  const auto compare = [&](const auto& text, const auto& compiled, double a, double b) {
    const double e = 1e-6;
    const Values found = quotient(text, a, b);
    worst = std::max(worst, std::abs(found.q - compiled.difference_quotient(a, b)));
    planted = std::max(planted, std::abs(found.q - compiled.difference_quotient(a + 1e-6, b)));
    const double by_a = (compiled.difference_quotient(a + e, b) - compiled.difference_quotient(a - e, b)) / (2 * e);
    const double by_b = (compiled.difference_quotient(a, b + e) - compiled.difference_quotient(a, b - e)) / (2 * e);
    worst_slope = std::max({worst_slope, std::abs(found.by_a - by_a), std::abs(found.by_b - by_b)});
  };
  for (const double apart : {0.0, 1e-12, 1e-6, 1e-3, 0.03, 0.1, 0.3, 1.0, 4.0})
    for (int n = 0; n < 50; ++n) {
      const double a = random(-2, 2), b = a + apart;
      compare(*sine_gordon, SineGordon{1.0}, a, b);
      compare(*phi4, PhiFour{0.7}, a, b);
    }
  CHECK(worst < 2e-14);
  CHECK(worst_slope < 1e-8);
  CHECK(planted > 1e-8);
}

TEST_CASE("a density of several fields, or of t, has no difference quotient") {
  CHECK_FALSE(expression("0.5*(u_t^2 + v_t^2) - u^2*v^2", {{"u", "v"}, {}})->has_difference_quotient());
  CHECK_FALSE(expression("0.5*phi_t^2 - t*phi^2")->has_difference_quotient());
  CHECK_FALSE(expression("0.5*phi_t^2*(1 + phi^2)")->has_difference_quotient());
}
