// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/numbers/dual.hpp"
#include "tests/catch.hpp"
#include "tests/jets/expressions/random_expression.hpp"

using namespace delf;
using namespace delf::expressions;
using delf::testing::many;
using delf::testing::Random;
using delf::testing::random_expression;

namespace {

constexpr int n = 5;
const Names names{{{"phi", 0}, {"phi_t", 1}, {"phi_x", 2}, {"x", 3}, {"t", 4}}, {{"c", 0.3}}};
using Point = std::array<double, n>;

template <class T>
T value(const Evaluation& evaluation, const Point& at) {
  return evaluation.operator()<T>([&](int v) { return T(at[v]); });
}
double off(double a, double b) { return std::abs(a - b) / (1 + std::abs(a) + std::abs(b)); }

}  // namespace

TEST_CASE("symbolic derivatives of ten thousand random expressions are those of automatic differentiation") {
  using Number = Dual<Dual<double, n>, n>;
  Random random(31);
  double first = 0, second = 0, planted = 0;
  for (int sample = 0; sample < many; ++sample) {
    const std::string text = random_expression(random, 3);
    Graph graph;
    const int root = parse(graph, text, names, "test");
    Point at;
    for (double& x : at) x = random(-1, 1);
    const Number by_duals = Evaluation(graph, root).operator()<Number>([&](int v) {
      return Number::variable(Dual<double, n>::variable(at[v], v), v);
    });
    const int a = random.pick(0, n - 1), b = random.pick(0, n - 1);
    const int slope = graph.differentiate(root, a);
    const double g = value<double>(Evaluation(graph, slope), at);
    const double H = value<double>(Evaluation(graph, graph.differentiate(slope, b)), at);
    const double g_duals = by_duals.derivative(a).value, H_duals = by_duals.derivative(a).derivative(b);
    INFO(text << " by " << a << ", " << b);
    if (!(off(g, g_duals) < 1e-11 && off(H, H_duals) < 1e-10)) CHECK((g == g_duals && H == H_duals));
    first = std::max(first, off(g, g_duals)), second = std::max(second, off(H, H_duals));
    planted = std::max(planted, off(g, by_duals.derivative((a + 1) % n).value));
  }
  CHECK(first < 1e-11);
  CHECK(second < 1e-10);
  CHECK(planted > 0.1);  // the derivative by another variable is found
}

TEST_CASE("symbolic derivatives of random expressions are those of differences") {
  Random random(32);
  double worst = 0;
  for (int sample = 0; sample < many; ++sample) {
    const std::string text = random_expression(random, 3);
    Graph graph;
    const int root = parse(graph, text, names, "test");
    Point at;
    for (double& x : at) x = random(-1, 1);
    const int a = random.pick(0, n - 1);
    const Evaluation f(graph, root), slope(graph, graph.differentiate(root, a));
    const auto shifted = [&](double by) {
      Point there = at;
      there[a] += by;
      return value<double>(f, there);
    };
    // f′ = (8 (f₁ − f₋₁) − (f₂ − f₋₂))/12ε + O(ε⁴)
    const double e = 1e-3;
    const double difference = (8 * (shifted(e) - shifted(-e)) - (shifted(2 * e) - shifted(-2 * e))) / (12 * e);
    INFO(text << " by " << a);
    const double here = off(value<double>(slope, at), difference);
    if (!(here < 1e-6)) CHECK(here < 1e-6);
    worst = std::max(worst, here);
  }
  CHECK(worst < 1e-6);
}

TEST_CASE("an evaluation uses places again, and not too early") {
  // u is read by three nodes, the last of them the root
  Graph graph;
  const int u = parse(graph, "let u = sin(phi); (u*phi_t + cos(u))*(u + exp(u*phi_x)) - u", names, "test");
  const Point at{0.4, -0.7, 0.2, 0, 0};
  const double s = std::sin(0.4);
  CHECK(value<double>(Evaluation(graph, u), at) ==
        Approx((s * -0.7 + std::cos(s)) * (s + std::exp(s * 0.2)) - s).epsilon(1e-15));
  CHECK(Evaluation(graph, u).reads(1));
  CHECK_FALSE(Evaluation(graph, u).reads(3));
  CHECK(value<double>(Evaluation(graph, graph.constant(2.5)), at) == 2.5);
}
