// SPDX-License-Identifier: MIT
#include "lattice/site_set.hpp"

#include <algorithm>
#include <random>
#include <set>

#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::pick;

TEST_CASE("a set of sites finds what it holds, in rows with and without gaps, and nothing else") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Site> sites;
    for (int n = pick(random, 0, 40); n > 0; --n) sites.push_back({pick(random, -3, 3), pick(random, -4, 4)});
    const std::set<Site> sorted(sites.begin(), sites.end());

    const SiteSet set(sites);
    REQUIRE(set.size() == sorted.size());
    CHECK(std::ranges::equal(set.sites(), sorted));
    for (int j = -5; j <= 5; ++j)
      for (int i = -6; i <= 6; ++i) {
        REQUIRE(set.contains({j, i}) == sorted.contains({j, i}));
        if (set.contains({j, i})) REQUIRE(set.sites()[set.index({j, i})] == Site{j, i});
      }
  }
}

TEST_CASE("sites as far apart as integers go do not overflow") {
  const SiteSet set({{0, -2000000000}, {0, 2000000000}, {-2000000000, 0}});
  CHECK(set.contains({0, 2000000000}));
  CHECK_FALSE(set.contains({0, 0}));
}
