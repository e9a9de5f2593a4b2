// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lattice/space/mesh.hpp"

namespace delf {

/// Which points of a mesh are one: sets of them, each known by its first point.
class UnitedPoints {
 public:
  explicit UnitedPoints(std::size_t points);
  /// The first point of the set that p is in.
  std::size_t first(std::size_t p);
  void unite(std::size_t p, std::size_t q);

 private:
  std::vector<std::size_t> first_;
};

/// A mesh whose sets of points are one point each, where the first of them stands, with its numbers and lines; cells and parts
/// are still to be listed.
struct MeshOfFirstPoints {
  MeshOfFirstPoints(const Mesh&, UnitedPoints&);

  Mesh mesh;
  std::vector<std::int32_t> number;  ///< of each point of the given mesh
};

}  // namespace delf
