// SPDX-License-Identifier: MIT
#include "lattice/plan/block_order.hpp"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/strong_components.hpp>
#include <cstddef>

#include "lattice/index.hpp"

namespace delf {

std::vector<std::vector<int>> blocks_in_order(int n, const std::vector<std::pair<int, int>>& edges) {
  boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS> graph(edges.begin(), edges.end(), at(n));
  std::vector<int> block(n);
  const int count = boost::strong_components(
      graph, boost::make_iterator_property_map(block.begin(), boost::get(boost::vertex_index, graph)));
  // Tarjan's algorithm numbers a component after all that can be reached from it, so a block comes after those that it
  // depends on.
  std::vector<std::vector<int>> blocks(count);
  for (int u = 0; u < n; ++u) blocks[at(block[u])].push_back(u);
  return blocks;
}

}  // namespace delf
