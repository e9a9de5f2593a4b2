// SPDX-License-Identifier: MIT
#include "jets/tables/line_basis.hpp"

#include <cmath>
#include <cstddef>

#include "jets/tables/line_rule.hpp"
#include "jets/tables/time_element.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "tests/catch.hpp"

using namespace delf;

TEST_CASE("every basis of a line sums to one, has its places, and the slopes of its values") {
  for (const NamedLineBasis& named : named_line_bases())
    for (int S = 2; S <= 12; ++S) {
      const LineBasis basis = named.make(S);
      CAPTURE(named.name, S);
      REQUIRE(basis.size() == S);
      for (const double x : {0.0, 0.11, 0.5, 0.83, 1.0}) {
        const auto phi = basis.values(x), slope = basis.slopes(x), left = basis.values(x - 1e-5),
                   right = basis.values(x + 1e-5);
        double one = 0, place = 0, rate = 0;
        for (std::size_t j = 0; j < phi.size(); ++j) {
          one += phi[j], place += phi[j] * basis.places[j], rate += slope[j] * basis.places[j];
          CHECK(std::abs((right[j] - left[j]) / 2e-5 - slope[j]) < 1e-5 * (1 + std::abs(slope[j])));
        }
        CHECK(std::abs(one - 1) < 1e-14);
        CHECK(std::abs(place - x) < 1e-14);
        CHECK(std::abs(rate - 1) < 1e-12);
      }
    }
}

TEST_CASE("bases of one size span the same polynomials: each has x to the power S - 1") {
  // of degree S − 1 the difference of order S vanishes, of degree S it does not
  for (const NamedLineBasis& named : named_line_bases()) {
    const LineBasis basis = named.make(4);
    for (std::size_t j = 0; j < 4; ++j) {
      double fourth = 0;
      const double binomial[] = {1, -4, 6, -4, 1};
      for (int i = 0; i < 5; ++i) fourth += binomial[i] * basis.values(0.2 * i)[j];
      CHECK(std::abs(fourth) < 1e-14);
    }
  }
}

TEST_CASE("bases with a node at both ends can share them, and others are refused") {
  for (const NamedLineBasis& named : named_line_bases())
    for (const int S : {2, 3, 5}) {
      CAPTURE(named.name, S);
      const LineBasis basis = named.make(S);
      const bool ends = named.name != "lagrange-gauss" && named.name != "lagrange-radau";
      CHECK(basis.has_end_nodes() == ends);
      if (!ends) CHECK_THROWS_AS(time_element(basis, gauss_rule(S), Continuity::shared), BadInput);
    }
}

TEST_CASE("a time element is exact on affine motions, shared or broken, and no point reads the broken one's vertex") {
  for (const NamedLineBasis& named : named_line_bases())
    for (const NamedLineRule& rule : named_line_rules())
      for (const int S : {2, 3, 5}) {
        CAPTURE(named.name, rule.name, S);
        const LineBasis basis = named.make(S);
        const StencilTable broken = time_element(basis, rule.make(S), Continuity::multipliers);
        CHECK(is_consistent(broken));
        CHECK(broken.pattern.size() == S + 1);
        CHECK(broken.nodes.size() == at(S + 1));
        for (const TablePoint& point : broken.points)
          for (const auto& entry : point[JetSlot::phi]) CHECK(entry.vertex > 0);
        if (!basis.has_end_nodes()) continue;
        const StencilTable shared = time_element(basis, rule.make(S), Continuity::shared);
        CHECK(is_consistent(shared));
        CHECK(shared.pattern.size() == S);
        CHECK(shared.nodes.size() == at(S - 1));
      }
}
