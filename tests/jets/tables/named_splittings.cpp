// SPDX-License-Identifier: MIT
#include "jets/tables/named_splittings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "jets/tables/pair_element.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

/// Hénon–Heiles, q″ = −∇V with V = ½|q|² + q₁²q₂ − q₂³/3: nonlinear, and its forces do not commute.
struct Point {
  long double q1 = 0.25L, q2 = 0.125L, p1 = 0.2L, p2 = -0.1L;
};
void kick(Point& y, long double h) {
  y.p1 -= h * (y.q1 + 2 * y.q1 * y.q2);
  y.p2 -= h * (y.q2 + y.q1 * y.q1 - y.q2 * y.q2);
}
Point at_2(const Splitting& splitting, int steps) {
  Point y;
  const long double h = 2.0L / steps;
  for (int n = 0; n < steps; ++n)
    for (std::size_t s = 0; s < splitting.kicks.size(); ++s) {
      kick(y, h * splitting.kicks[s]);
      if (s == splitting.drifts.size()) continue;
      y.q1 += h * splitting.drifts[s] * y.p1, y.q2 += h * splitting.drifts[s] * y.p2;
    }
  return y;
}
double distance(const Point& a, const Point& b) {
  return static_cast<double>(
      std::max(std::abs(a.q1 - b.q1) + std::abs(a.q2 - b.q2), std::abs(a.p1 - b.p1) + std::abs(a.p2 - b.p2)));
}
double order_of(const Splitting& splitting, int steps, const Point& exact) {
  return std::log2(distance(at_2(splitting, steps), exact) / distance(at_2(splitting, 2 * steps), exact));
}

}  // namespace

TEST_CASE("every named splitting is a Nystrom method of its order and no more, from both sides") {
  const Point exact = at_2(splitting_of_order(8), 256);
  for (const NamedSplitting& named : named_splittings()) {
    const Splitting splitting = named.make();
    CAPTURE(named.name);
    REQUIRE(splitting.kicks.size() == splitting.drifts.size() + 1);
    // a first and a last kick are one where steps meet
    const bool ends = splitting.kicks.front() != 0;
    CHECK(named.kicks == static_cast<int>(splitting.kicks.size()) - (ends ? 1 : 2));
    for (const auto* weights : {&splitting.kicks, &splitting.drifts}) {
      double sum = 0;
      for (std::size_t s = 0; s < weights->size(); ++s) {
        sum += (*weights)[s];
        CHECK(std::abs((*weights)[s] - (*weights)[weights->size() - 1 - s]) < 1e-15);
      }
      CHECK(std::abs(sum - 1) < 1e-14);
    }
    const int steps = named.order == 2 ? 64 : named.order == 4 ? 16 : 6;
    const double found = order_of(splitting, steps, exact);
    CAPTURE(found);
    CHECK(std::abs(found - named.order) < 0.3);
    // one weight that is off is seen
    Splitting off = splitting;
    off.kicks[1] += 1e-3, off.kicks[off.kicks.size() - 2] += 1e-3;
    if (named.order > 2) CHECK(order_of(off, steps, exact) < 1);
  }
}

TEST_CASE("a splitting without kicks at its ends has no points there, and is consistent") {
  const auto& list = named_splittings();
  const Splitting splitting = std::ranges::find(list, std::string("mclachlan-4"), &NamedSplitting::name)->make();
  const StencilTable element = splitting_element(splitting);
  CHECK(element.points.size() == 2 * splitting.drifts.size() - 2);
  CHECK(is_consistent(element));
  CHECK(is_consistent(pair_element(splitting, 2)));
  for (const TablePoint& p : element.points) CHECK((p.time > 0 && p.time < 1));
}
