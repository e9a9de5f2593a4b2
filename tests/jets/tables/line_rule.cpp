// SPDX-License-Identifier: MIT
#include "jets/tables/line_rule.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include "tests/catch.hpp"

using namespace delf;

namespace {

/// Σ w x^d − ∫₀¹ x^d dx
double defect(const LineRule& rule, int degree) {
  double sum = 0;
  for (std::size_t i = 0; i < rule.points.size(); ++i) sum += rule.weights[i] * std::pow(rule.points[i], degree);
  return sum - 1.0 / (degree + 1);
}

/// Σ w C_d(x) − ∫₀¹ C_d(x) dx of the Legendre polynomial of [0, 1]: its integral vanishes for d > 0, and a rule of n points
/// misses the first that it cannot do by far more than rounding, where of a monomial it misses 4^−d.
double legendre_defect(const LineRule& rule, int degree) {
  double sum = 0;
  for (std::size_t i = 0; i < rule.points.size(); ++i)
    sum += rule.weights[i] * std::legendre(static_cast<unsigned>(degree), 2 * rule.points[i] - 1);
  return degree == 0 ? sum - 1 : sum;
}

int degree_of(const std::string& name, int n) {
  if (name == "gauss") return 2 * n - 1;
  if (name == "lobatto") return 2 * n - 3;
  if (name == "radau") return 2 * n - 2;
  return n % 2 == 1 ? n : n - 1;
}

}  // namespace

TEST_CASE("a line rule is exact to its degree and not beyond, for any number of points") {
  for (const NamedLineRule& named : named_line_rules())
    for (int n = named.fewest; n <= 20; ++n) {
      const LineRule rule = named.make(n);
      const int degree = degree_of(named.name, n);
      CAPTURE(named.name, n, degree);
      REQUIRE(rule.size() == n);
      CHECK(std::abs(std::accumulate(rule.weights.begin(), rule.weights.end(), 0.0) - 1) < 1e-15);
      for (int d = 0; d <= degree; ++d) {
        CAPTURE(d);
        CHECK(std::abs(defect(rule, d)) < 1e-15);
      }
      CHECK(std::abs(legendre_defect(rule, degree + 1)) > 1e-4);
      for (std::size_t i = 0; i < rule.points.size(); ++i) {
        CHECK((rule.points[i] >= 0 && rule.points[i] <= 1 && rule.weights[i] > 0));
        CHECK((i == 0 || rule.points[i] > rule.points[i - 1]));
      }
    }
}

TEST_CASE("the ends that a line rule has: Lobatto and Clenshaw-Curtis both, Radau the left one") {
  for (const NamedLineRule& named : named_line_rules()) {
    const LineRule rule = named.make(5);
    CAPTURE(named.name);
    const bool both = named.name == "lobatto" || named.name == "clenshaw-curtis";
    CHECK((rule.points.front() == 0) == (both || named.name == "radau"));
    CHECK((rule.points.back() == 1) == both);
  }
}
