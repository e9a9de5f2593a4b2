// SPDX-License-Identifier: MIT
#include "lattice/plan/sigma_method.hpp"

#include <random>

#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::pick;

TEST_CASE("the simple pendulum has the offsets c = (0, 0, 2), d = (2, 2, 0) of Pryce, example 1") {
  // f₁ = ẍ + xλ, f₂ = ÿ + yλ − g, f₃ = x² + y² − L²
  enum { x, y, lambda };
  const auto pendulum =
      analyse(3, {{0, x, 2}, {0, x, 0}, {0, lambda, 0}, {1, y, 2}, {1, lambda, 0}, {2, x, 0}, {2, y, 0}});
  REQUIRE(pendulum.solvable());
  CHECK(pendulum.c == std::vector<int>{0, 0, 2});
  CHECK(pendulum.d == std::vector<int>{2, 2, 0});
}

TEST_CASE("an unknown that no equation contains, and an equation that is left over for it, are named") {
  const auto analysis = analyse(3, {{0, 0, 1}, {1, 0, 0}, {1, 1, 1}, {2, 1, 0}});
  CHECK_FALSE(analysis.solvable());
  CHECK(analysis.unmatched_unknowns == std::vector<int>{2});
  CHECK(analysis.unmatched_equations.size() == 1);
}

TEST_CASE("offsets obey d_u − c_e ≥ σ(e, u), equal on the matching, from both sides") {
  std::mt19937 random(2);
  int solvable = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const int size = pick(random, 1, 7);
    std::vector<Occurrence> occurrences;
    for (int n = 3 * size; n > 0; --n)
      occurrences.push_back({pick(random, 0, size - 1), pick(random, 0, size - 1), pick(random, -2, 2), 0});
    StructuralAnalysis analysis = analyse(size, occurrences);
    if (!analysis.solvable()) continue;
    ++solvable;

    const auto obeyed = [&] {
      for (const Occurrence& o : occurrences)
        if (analysis.d[o.unknown] - analysis.c[o.equation] < o.time) return false;
      for (int e = 0; e < size; ++e) {
        const Occurrence& solved = occurrences[analysis.match[e]];
        if (solved.equation != e || analysis.d[solved.unknown] - analysis.c[e] != solved.time) return false;
      }
      return true;
    };
    CHECK(obeyed());
    for (const int d : analysis.d) CHECK(d >= 0);

    const std::vector<int> least = analysis.d;
    lower_offsets(analysis, occurrences, std::vector<int>(size, 20));
    CHECK(obeyed());
    for (int u = 0; u < size; ++u) CHECK((least[u] <= analysis.d[u] && analysis.d[u] <= 20));

    // the check can fail: one unknown moved to an earlier row
    analysis.d[pick(random, 0, size - 1)] -= 1;
    CHECK_FALSE(obeyed());
  }
  CHECK(solvable > 50);
}
