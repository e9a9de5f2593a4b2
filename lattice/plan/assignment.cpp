// SPDX-License-Identifier: MIT
#include "lattice/plan/assignment.hpp"

#include <limits>

namespace delf {

// Minimises Σ cost, cost = −weight, by one shortest augmenting path for each row. Reduced costs
// cost(r, c) − u(r) − v(c) stay ≥ 0, and are 0 on the matching. Column 0 is where a path starts.
std::vector<int> best_assignment(int size, const std::vector<Weight>& weights) {
  constexpr Weight infinite{std::numeric_limits<long long>::max() / 4, 0, 0};
  std::vector<Weight> u(size + 1), v(size + 1);
  std::vector<int> row_of(size + 1, 0), previous(size + 1, 0);

  for (int row = 1; row <= size; ++row) {
    row_of[0] = row;
    int column = 0;
    std::vector<Weight> distance(size + 1, infinite);
    std::vector<char> done(size + 1, false);
    do {
      done[column] = true;
      const int r = row_of[column];
      Weight shortest = infinite;
      int next = 0;
      for (int c = 1; c <= size; ++c) {
        if (done[c]) continue;
        const Weight reduced = Weight{} - weights[(r - 1) * size + c - 1] - u[r] - v[c];
        if (reduced < distance[c]) distance[c] = reduced, previous[c] = column;
        if (distance[c] < shortest) shortest = distance[c], next = c;
      }
      for (int c = 0; c <= size; ++c)
        if (done[c])
          u[row_of[c]] = u[row_of[c]] + shortest, v[c] = v[c] - shortest;
        else
          distance[c] = distance[c] - shortest;
      column = next;
    } while (row_of[column] != 0);

    while (column != 0) {
      row_of[column] = row_of[previous[column]];
      column = previous[column];
    }
  }

  std::vector<int> column_of(size);
  for (int c = 1; c <= size; ++c) column_of[row_of[c] - 1] = c - 1;
  return column_of;
}

}  // namespace delf
