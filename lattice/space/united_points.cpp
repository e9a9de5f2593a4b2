// SPDX-License-Identifier: MIT
#include "lattice/space/united_points.hpp"

#include <algorithm>
#include <numeric>

namespace delf {

UnitedPoints::UnitedPoints(std::size_t points) : first_(points) {
  std::iota(first_.begin(), first_.end(), std::size_t{0});
}

std::size_t UnitedPoints::first(std::size_t p) {
  while (first_[p] != p) p = first_[p] = first_[first_[p]];
  return p;
}

void UnitedPoints::unite(std::size_t p, std::size_t q) {
  const auto [low, high] = std::minmax({first(p), first(q)});
  first_[high] = low;
}

MeshOfFirstPoints::MeshOfFirstPoints(const Mesh& given, UnitedPoints& united)
    : mesh{.dimension = given.dimension,
           .points = {},
           .vertices = {},
           .cell_lines = given.cell_lines,
           .cell_tags = given.cell_tags},
      number(given.points.size()) {
  mesh.first = given.first;
  for (std::size_t p = 0; p < given.points.size(); ++p) {
    if (const std::size_t first = united.first(p); first != p) {
      number[p] = number[first];
      continue;
    }
    number[p] = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.push_back(given.points[p]);
    if (p < given.point_lines.size()) mesh.point_lines.push_back(given.point_lines[p]);
    mesh.point_tags.push_back(given.point_number(p));
  }
}

}  // namespace delf
