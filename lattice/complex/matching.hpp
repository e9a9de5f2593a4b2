// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/index.hpp"

namespace delf {

/// A bipartite graph by rows: which columns each row contains, each once.
struct Incidence {
  int columns = 0;
  std::vector<std::int64_t> first{0};
  std::vector<std::int32_t> entries;

  int rows() const { return static_cast<int>(first.size()) - 1; }
  std::span<const std::int32_t> row(int r) const {
    const std::size_t i = r;
    return {entries.data() + first[i], at(first[i + 1] - first[i])};
  }
  Incidence transposed() const;
};

/// A matching with as many pairs as there can be.
struct Matching {
  std::vector<std::int32_t> column_of, row_of;  ///< −1: unmatched

  bool is_perfect() const;
};

/// Hopcroft and Karp (SIAM J. Comput. 2, 1973): O(entries · √rows), from a greedy start that takes the last column of a
/// row that is free.
Matching largest_matching(const Incidence&);

/// What is ill-posed, after Dulmage and Mendelsohn (Canad. J. Math. 10, 1958): whatever an alternating path reaches from
/// an unmatched row, or from an unmatched column. Both are the same for every largest matching.
struct IllPosed {
  std::vector<std::int32_t> rows;     ///< more equations than the unknowns that they contain
  std::vector<std::int32_t> columns;  ///< more unknowns than the equations that contain them
};
IllPosed ill_posed_parts(const Incidence&, const Matching&);

}  // namespace delf
