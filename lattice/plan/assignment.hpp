// SPDX-License-Identifier: MIT
#pragma once
#include <compare>
#include <vector>

namespace delf {

/// The weight of a pair, compared lexicographically: first the number of allowed pairs, at any cost of the rest.
struct Weight {
  long long allowed = 0;   ///< 1 if the pair may be matched
  long long rows = 0;      ///< σ
  long long nearness = 0;  ///< to choose among equals

  friend constexpr auto operator<=>(const Weight&, const Weight&) = default;
  friend constexpr Weight operator+(Weight a, Weight b) {
    return {a.allowed + b.allowed, a.rows + b.rows, a.nearness + b.nearness};
  }
  friend constexpr Weight operator-(Weight a, Weight b) {
    return {a.allowed - b.allowed, a.rows - b.rows, a.nearness - b.nearness};
  }
};

/// The column of each row in a perfect matching of a complete bipartite graph whose weights have the largest sum;
/// `weights` is size × size, row by row. O(size³), by the Hungarian method.
///
/// Boost's maximum_weighted_matching would do the same, but up to 1.86 it returns wrong matchings or never returns on
/// some graphs (boostorg/graph #223, #399).
std::vector<int> best_assignment(int size, const std::vector<Weight>& weights);

}  // namespace delf
