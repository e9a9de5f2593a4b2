// SPDX-License-Identifier: MIT
#include "jets/tables/pair_element.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "jets/tables/line_rule.hpp"
#include "jets/tables/radau_element.hpp"
#include "jets/tables/space_table.hpp"
#include "jets/tables/splitting.hpp"
#include "jets/tables/table_product.hpp"
#include "jets/tables/time_element.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

/// Σ_m m²β_m (f(m) − 2f(0) + f(−m))/m² for f = x^degree: what the pairs make of f″(0).
double second_derivative(int p, int degree) {
  const auto weights = pair_weights(p);
  double sum = 0;
  for (int m = 1; m <= p; ++m) sum += weights[m - 1] * 2 * std::pow(m, degree) / (m * m);
  return sum;
}
/// One step of the pendulum q″ = −sin q by kicks and drifts.
void pendulum_step(const Splitting& splitting, double h, long double& q, long double& p) {
  for (std::size_t s = 0; s < splitting.kicks.size(); ++s) {
    p -= static_cast<long double>(splitting.kicks[s]) * h * std::sin(q);
    if (s < splitting.drifts.size()) q += static_cast<long double>(splitting.drifts[s]) * h * p;
  }
}
long double pendulum_at_1(const Splitting& splitting, int steps) {
  long double q = 0.3L, p = 1.2L;
  for (int n = 0; n < steps; ++n) pendulum_step(splitting, 1.0 / steps, q, p);
  return q;
}

}  // namespace

TEST_CASE("pairs up to p sites apart find second derivatives to order 2p, and no further") {
  for (int p = 1; p <= widest_pair; ++p) {
    CAPTURE(p);
    double total = 0;
    for (const double w : pair_weights(p)) total += w;
    CHECK(std::abs(total - 1) < 1e-14);
    CHECK(std::abs(second_derivative(p, 2) - 2) < 1e-13);
    for (int degree = 4; degree <= 2 * p; degree += 2)
      CHECK(std::abs(second_derivative(p, degree)) < 1e-12 * std::pow(p, degree));
    CHECK(std::abs(second_derivative(p, 2 * p + 2)) > 1);
  }
}

TEST_CASE(
    "the weights of splittings are palindromes, sum to 1, and make a pendulum's steps of their order and no more") {
  const long double exact = pendulum_at_1(splitting_of_order(8), 64);
  for (int order = 2; order <= highest_splitting_order; order += 2) {
    const Splitting splitting = splitting_of_order(order);
    CAPTURE(order);
    REQUIRE(splitting.kicks.size() == splitting.drifts.size() + 1);
    for (const auto* weights : {&splitting.kicks, &splitting.drifts}) {
      double sum = 0;
      for (std::size_t s = 0; s < weights->size(); ++s) {
        sum += (*weights)[s];
        CHECK(std::abs((*weights)[s] - (*weights)[weights->size() - 1 - s]) < 1e-15);
      }
      CHECK(std::abs(sum - 1) < 1e-14);
    }
    const int steps = order == 8 ? 3 : 4;
    const auto error = [&](int n) { return std::abs(static_cast<double>(pendulum_at_1(splitting, n) - exact)); };
    const double found = std::log2(error(steps) / error(2 * steps));
    CAPTURE(found);
    CHECK(found > order - 0.3);
    CHECK(found < order + 0.4);
    // one weight that is off is seen
    Splitting off = splitting;
    off.kicks[1] += 1e-4, off.kicks[off.kicks.size() - 2] += 1e-4;
    if (order > 2)
      CHECK(std::log2(std::abs(static_cast<double>((pendulum_at_1(off, steps) - exact) /
                                                   (pendulum_at_1(off, 2 * steps) - exact)))) < 1);
  }
  CHECK(splitting_of_order(3).drifts.empty());
  CHECK(splitting_of_order(10).drifts.empty());
}

TEST_CASE(
    "the element of a composition lists its rows one above the other, and weighs its points by signed fractions") {
  const Splitting splitting = splitting_of_order(8);
  const auto& fractions = splitting.drifts;
  const StencilTable element = pair_element(splitting, 3);
  CHECK(element.nodes.size() == fractions.size());
  CHECK(element.pattern.size() == static_cast<int>(4 * (fractions.size() + 1)));
  CHECK(element.points.size() == fractions.size() * 3 * 4);
  double total = 0;
  for (const TablePoint& p : element.points) total += p.weight;
  CHECK(std::abs(total - 1) < 1e-13);
  CHECK(element.nodes[3].time < element.nodes[2].time);  // the third sub-step goes back
  // A row's points weigh what its kick does: φ alone, at all vertices of node 2.
  double kick = 0;
  for (const TablePoint& p : element.points)
    for (const auto& [vertex, weight] : p[JetSlot::phi]) {
      const Site v = element.pattern.vertices[vertex];
      if (v.time == 0 && v.node == 2) kick += p.weight * weight;
    }
  CHECK(std::abs(kick - splitting.kicks[2]) < 1e-14);
  // On the affine field 2 + 3t + 5x every point finds φ_t = 3 and φ_x = 5.
  for (const TablePoint& p : element.points) {
    const auto found = [&](JetSlot slot) {
      double sum = 0;
      for (const auto& [vertex, weight] : p[slot]) {
        const Site v = element.pattern.vertices[vertex];
        sum += weight * (2 + 3 * (v.time + element.nodes[v.node].time) + 5 * v.space);
      }
      return sum;
    };
    CHECK(std::abs(found(JetSlot::phi) - (2 + 3 * p.time + 5 * p.space)) < 1e-13);
    CHECK(std::abs(found(JetSlot::phi_t) - 3) < 1e-13);
    CHECK(std::abs(found(JetSlot::phi_x) - 5) < 1e-13);
  }
}

TEST_CASE("the table of time is found again in its product with one of space") {
  const auto same = [](const StencilTable& time, const StencilTable& space) {
    const StencilTable found = at_one_site(product(time, space));
    REQUIRE(found.points.size() == time.points.size());
    REQUIRE(found.tests.size() == time.tests.size());
    CHECK(found.pattern.size() == time.pattern.size());
    double gap = 0;
    for (std::size_t q = 0; q < found.points.size(); ++q) {
      CHECK(found.points[q].time == time.points[q].time);
      gap = std::max(gap, std::abs(found.points[q].weight - time.points[q].weight));
      for (const JetSlot slot : {JetSlot::phi, JetSlot::phi_t})
        for (const auto& [of_found, of_time] :
             {std::pair{&found.points[q], &time.points[q]}, {&found.test(q), &time.test(q)}}) {
          std::vector<double> weights(at(time.pattern.size()), 0.0);
          for (const auto& [vertex, weight] : (*of_found)[slot]) weights[at(vertex)] += weight;
          for (const auto& [vertex, weight] : (*of_time)[slot]) weights[at(vertex)] -= weight;
          for (const double weight : weights) gap = std::max(gap, std::abs(weight));
        }
    }
    return gap;
  };
  const StencilTable gauss = time_element(lagrange_basis(lobatto_rule(3).points), gauss_rule(2), Continuity::shared);
  for (const StencilTable& space : {spectral_space(2), linear_space(), pair_space(pair_weights(2)), point_space()})
    for (const StencilTable& time : {gauss, radau_element(3), splitting_element(splitting_of_order(4))})
      CHECK(same(time, space) < 1e-13);
}

TEST_CASE("kernels with their processors make a pendulum's steps of their effective order, and of order 2 without") {
  // q″ = −sin q; a kick with a gradient is of F + 2g h² F′F
  const auto at_1 = [](const char* kernel, int steps, bool processed) {
    const Splitting s = processed_splitting(kernel);
    const long double h = 1.0L / steps;
    long double q = 0.3L, p = 1.2L;
    const auto kick = [&](long double b, long double gradient) {
      p -= h * b * (std::sin(q) - 2 * gradient * h * h * std::cos(q) * std::sin(q));
    };
    const auto& P = s.processor;
    for (std::size_t i = 0; processed && i < P.kicks.size(); ++i) {
      kick(P.kicks[i], 0);
      if (i < P.drifts.size()) q += h * P.drifts[i] * p;
    }
    for (int n = 0; n < steps; ++n)
      for (std::size_t i = 0; i < s.drifts.size(); ++i) {
        // the half kick that the step before leaves to this one
        kick(i == 0 ? (n == 0 && !processed ? s.kicks[0] : s.kicks[0] + s.kicks.back()) : s.kicks[i],
             n == 0 && !processed ? s.gradient / 2 : s.gradient);
        q += h * s.drifts[i] * p;
      }
    for (std::size_t i = P.kicks.size(); processed && i-- > 0;) {
      kick(-P.kicks[i], 0);
      if (i > 0) q -= h * P.drifts[i - 1] * p;
    }
    return q;
  };
  const long double exact = pendulum_at_1(splitting_of_order(8), 64);
  struct Case {
    const char* kernel;
    bool processed;
    int steps;
    double order;
  };
  for (const auto& [kernel, processed, steps, order] :
       {Case{"ti4", true, 8, 4}, {"b6", true, 4, 6}, {"ti4", false, 8, 2}, {"b6", false, 4, 2}}) {
    const long double coarse = std::abs(at_1(kernel, steps, processed) - exact),
                      fine = std::abs(at_1(kernel, 2 * steps, processed) - exact);
    const auto found = static_cast<double>(std::log2(coarse / fine));
    CAPTURE(kernel, processed, found);
    CHECK(found > order - 0.3);
    CHECK(found < order + 0.3);
  }
  CHECK(processed_splitting("b7").drifts.empty());
}
