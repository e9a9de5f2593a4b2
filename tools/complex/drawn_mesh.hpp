// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "lattice/space/mesh.hpp"

namespace delf {

/// A mesh as it is drawn: where parts of it are joined, cells at the seam have points of their own on the other side, copies of
/// those that they share.
struct DrawnMesh {
  std::vector<Mesh::Point> points;     ///< those of the mesh, then the copies
  std::vector<std::int32_t> of;        ///< the point of the mesh that each shows
  std::vector<std::int32_t> vertices;  ///< of the cells, as Mesh::vertices

  explicit DrawnMesh(const Mesh& mesh) : points(mesh.points), of(mesh.points.size()), vertices(mesh.vertices) {
    std::iota(of.begin(), of.end(), 0);
    std::map<std::pair<std::int32_t, Mesh::Point>, std::int32_t> copies;
    for (std::size_t n = 0; n < mesh.places.size(); ++n) {
      const auto p = mesh.vertices[n];
      if (mesh.places[n] == mesh.points[at(p)]) continue;
      const auto [copy, fresh] = copies.try_emplace({p, mesh.places[n]}, static_cast<std::int32_t>(points.size()));
      if (fresh) points.push_back(mesh.places[n]), of.push_back(p);
      vertices[n] = copy->second;
    }
  }
  /// The points that the copies show.
  std::span<const std::int32_t> copied(const Mesh& mesh) const { return std::span(of).subspan(mesh.points.size()); }
  std::span<const std::int32_t> cell(const Mesh& mesh, int c) const {
    return {vertices.data() + mesh.first[at(c)], mesh.cell(c).size()};
  }
};

}  // namespace delf
