// SPDX-License-Identifier: MIT
#include "lattice/complex/matching.hpp"

#include <algorithm>
#include <limits>

#include "lattice/index.hpp"

namespace delf {
namespace {

using Index = std::int32_t;

class HopcroftKarp {
 public:
  explicit HopcroftKarp(const Incidence& graph) : graph_(graph) {
    matching_.column_of.assign(graph.rows(), -1);
    matching_.row_of.assign(graph.columns, -1);
  }

  Matching run() {
    // From the last row to the first, each takes its last free column: beside a right wall a row has one column less, and
    // one that comes after its neighbours would find none.
    for (Index r = graph_.rows() - 1; r >= 0; --r) {
      const auto row = graph_.row(r);
      for (auto c = row.rbegin(); c != row.rend(); ++c)
        if (matching_.row_of[*c] < 0) {
          match(r, *c);
          break;
        }
    }
    while (find_layers())
      for (Index r = 0; r < graph_.rows(); ++r)
        if (matching_.column_of[r] < 0) augment(r);
    return std::move(matching_);
  }

 private:
  static constexpr Index unreached = std::numeric_limits<Index>::max();

  void match(Index r, Index c) { matching_.column_of[r] = c, matching_.row_of[c] = r; }

  // How many pairs an alternating path needs from a free row to each row; whether a free column is reached.
  bool find_layers() {
    layer_.assign(graph_.rows(), unreached);
    next_.assign(graph_.rows(), 0);
    std::vector<Index> queue;
    for (Index r = 0; r < graph_.rows(); ++r)
      if (matching_.column_of[r] < 0) layer_[r] = 0, queue.push_back(r);
    bool reached = false;
    for (std::size_t q = 0; q < queue.size(); ++q)
      for (const Index c : graph_.row(queue[q])) {
        const Index r = matching_.row_of[c];
        if (r < 0) reached = true;
        else if (layer_[r] == unreached) layer_[r] = layer_[queue[q]] + 1, queue.push_back(r);
      }
    return reached;
  }

  // A path of growing layers to a free column, depth first; every entry is tried once between two searches of layers.
  void augment(Index start) {
    std::vector<Index> path{start};
    while (!path.empty()) {
      const Index r = path.back();
      const auto row = graph_.row(r);
      if (next_[r] == static_cast<Index>(row.size())) {
        path.pop_back();
        continue;
      }
      const Index c = row[next_[r]++], further = matching_.row_of[c];
      if (further < 0) {
        for (const Index p : path) match(p, graph_.row(p)[next_[p] - 1]);
        return;
      }
      if (layer_[further] == layer_[r] + 1) path.push_back(further);
    }
  }

  const Incidence& graph_;
  Matching matching_;
  std::vector<Index> layer_, next_;
};

/// The rows that alternating paths reach from some rows.
std::vector<Index> reached_rows(const Incidence& graph, const std::vector<Index>& row_of, std::vector<Index> rows) {
  std::vector<char> seen(graph.rows(), 0);
  for (const Index r : rows) seen[r] = 1;
  for (std::size_t q = 0; q < rows.size(); ++q)
    for (const Index c : graph.row(rows[q]))
      if (const Index r = row_of[c]; r >= 0 && !seen[r]) seen[r] = 1, rows.push_back(r);
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::vector<Index> unmatched(const std::vector<Index>& partner) {
  std::vector<Index> free;
  for (std::size_t i = 0; i < partner.size(); ++i)
    if (partner[i] < 0) free.push_back(static_cast<Index>(i));
  return free;
}

}  // namespace

Incidence Incidence::transposed() const {
  Incidence t{.columns = rows(), .first = std::vector<std::int64_t>(at(columns) + 1, 0), .entries = {}};
  for (const Index c : entries) ++t.first[at(c) + 1];
  for (std::size_t i = 1; i < t.first.size(); ++i) t.first[i] += t.first[i - 1];
  t.entries.resize(entries.size());
  std::vector<std::int64_t> next(t.first.begin(), t.first.end() - 1);
  for (Index r = 0; r < rows(); ++r)
    for (const Index c : row(r)) t.entries[next[c]++] = r;
  return t;
}

bool Matching::is_perfect() const { return unmatched(column_of).empty() && unmatched(row_of).empty(); }

Matching largest_matching(const Incidence& graph) { return HopcroftKarp(graph).run(); }

IllPosed ill_posed_parts(const Incidence& graph, const Matching& matching) {
  return {reached_rows(graph, matching.row_of, unmatched(matching.column_of)),
          reached_rows(graph.transposed(), matching.column_of, unmatched(matching.row_of))};
}

}  // namespace delf
