// SPDX-License-Identifier: MIT
#include "lattice/plan/assignment.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::pick;

namespace {

Weight sum(const std::vector<Weight>& weights, const std::vector<int>& column) {
  const int size = static_cast<int>(column.size());
  Weight total;
  for (int r = 0; r < size; ++r) total = total + weights[r * size + column[r]];
  return total;
}

std::vector<Weight> random_weights(std::mt19937& random, int size) {
  std::vector<Weight> weights(size * size);
  for (Weight& w : weights)
    if (pick(random, 0, 2) > 0) w = {1, pick(random, -3, 3), pick(random, -5, 0)};
  return weights;
}

std::vector<int> by_trying_all(const std::vector<Weight>& weights, int size) {
  std::vector<int> column(size), best;
  std::iota(column.begin(), column.end(), 0);
  do
    if (best.empty() || sum(weights, best) < sum(weights, column)) best = column;
  while (std::ranges::next_permutation(column).found);
  return best;
}

/// Row by row, the best column that is left.
std::vector<int> greedy(const std::vector<Weight>& weights, int size) {
  std::vector<int> column;
  for (int r = 0; r < size; ++r) {
    int best = -1;
    for (int c = 0; c < size; ++c)
      if (std::ranges::find(column, c) == column.end() &&
          (best < 0 || weights[r * size + best] < weights[r * size + c]))
        best = c;
    column.push_back(best);
  }
  return column;
}

}  // namespace

TEST_CASE("the assignment is the best of all permutations, and a greedy one is not") {
  std::mt19937 random(1);
  int greedy_failed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int size = pick(random, 1, 6);
    const auto weights = random_weights(random, size);
    const auto found = best_assignment(size, weights);
    auto columns = found;
    std::ranges::sort(columns);
    for (int c = 0; c < size; ++c) REQUIRE(columns[c] == c);
    const Weight best = sum(weights, by_trying_all(weights, size));
    CHECK(sum(weights, found) == best);
    greedy_failed += sum(weights, greedy(weights, size)) != best;
  }
  CHECK(greedy_failed > 50);
}

TEST_CASE("as many allowed pairs as can be come before any number of rows") {
  // (0,0) alone is worth 100 rows, (0,1) and (1,0) together −2, but they are two pairs
  CHECK(best_assignment(2, {{1, 100, 0}, {1, -1, 0}, {1, -1, 0}, {}}) == std::vector<int>{1, 0});
}
