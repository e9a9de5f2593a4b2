// SPDX-License-Identifier: MIT
#include "lattice/space/mesh_topology.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "lattice/index.hpp"

namespace delf {
namespace {

/// Sets of points, joined two by two.
class Parts {
 public:
  explicit Parts(std::size_t points) : parent_(points), there_(points, 0) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  void join(std::int32_t a, std::int32_t b) {
    there_[a] = there_[b] = 1;
    parent_[root(at(a))] = root(at(b));
  }
  /// The number of sets among the points that were joined with any.
  int count() {
    int sets = 0;
    for (std::size_t p = 0; p < parent_.size(); ++p) sets += there_[p] && root(p) == p;
    return sets;
  }

 private:
  std::size_t root(std::size_t p) {
    while (parent_[p] != p) p = parent_[p] = parent_[parent_[p]];
    return p;
  }
  std::vector<std::size_t> parent_;
  std::vector<char> there_;
};

}  // namespace

MeshTopology topology(const Mesh& mesh) {
  Parts pieces(mesh.points.size()), curves(mesh.points.size());
  std::vector<std::pair<std::int32_t, std::int32_t>> sides;
  std::vector<char> used(mesh.points.size(), 0);
  for (int c = 0; c < mesh.cells(); ++c) {
    const auto corners = mesh.cell(c);
    for (std::size_t n = 0; n < corners.size(); ++n) {
      const auto a = corners[n], b = corners[(n + 1) % corners.size()];
      used[a] = 1;
      pieces.join(a, b);
      if (mesh.dimension > 1) sides.push_back(std::minmax(a, b));
    }
  }
  MeshTopology found{.pieces = pieces.count()};
  found.euler = static_cast<int>(std::ranges::count(used, 1));
  if (mesh.dimension == 1) {
    found.euler -= mesh.cells();
    found.boundaries = static_cast<int>(boundary_points(mesh).size());
    return found;
  }
  std::ranges::sort(sides);
  for (std::size_t n = 0, end = 0; n < sides.size(); n = end) {
    while (end < sides.size() && sides[end] == sides[n]) ++end;
    --found.euler;
    if (end - n == 1) curves.join(sides[n].first, sides[n].second);
  }
  found.euler += mesh.cells();
  found.boundaries = curves.count();
  return found;
}

std::string in_words(const MeshTopology& found, int dimension) {
  const auto counted = [](int n, const char* one, const char* several) {
    return (n == 0 ? "no" : std::to_string(n)) + " " + (n == 1 ? one : several);
  };
  return "Euler characteristic " + std::to_string(found.euler) + ", " +
         (dimension == 1 ? counted(found.boundaries, "end", "ends")
                         : counted(found.boundaries, "boundary curve", "boundary curves")) +
         (found.pieces > 1 ? ", in " + std::to_string(found.pieces) + " pieces" : "");
}

}  // namespace delf
