// SPDX-License-Identifier: MIT
#include "lattice/space/mesh_refinement.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace delf {

Mesh refined(const Mesh& mesh) {
  Mesh fine{.dimension = mesh.dimension, .points = mesh.points, .vertices = {}};
  const auto add_middle = [&](std::span<const std::int32_t> of) {
    Mesh::Point middle{};
    for (const auto p : of)
      for (std::size_t c = 0; c < 3; ++c) middle[c] += mesh.points[p][c] / static_cast<double>(of.size());
    fine.points.push_back(middle);
    return static_cast<std::int32_t>(fine.points.size()) - 1;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
  const auto middle_of = [&](std::int32_t a, std::int32_t b) {
    const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), 0);
    if (is_new) found->second = add_middle(std::array{a, b});
    return found->second;
  };
  for (int c = 0; c < mesh.cells(); ++c) {
    const auto corners = mesh.cell(c);
    const std::size_t n = corners.size();
    std::array<std::int32_t, 4> side{};  // from corner l to the next
    for (std::size_t l = 0; l < (n == 2 ? 1 : n); ++l) side[l] = middle_of(corners[l], corners[(l + 1) % n]);
    if (n == 2) {
      fine.add_cell(std::array{corners[0], side[0]}), fine.add_cell(std::array{side[0], corners[1]});
    } else if (n == 3) {
      for (std::size_t l = 0; l < 3; ++l) fine.add_cell(std::array{corners[l], side[l], side[(l + 2) % 3]});
      fine.add_cell(std::array{side[0], side[1], side[2]});
    } else {
      const std::int32_t centre = add_middle(corners);
      for (std::size_t l = 0; l < 4; ++l) fine.add_cell(std::array{corners[l], side[l], centre, side[(l + 3) % 4]});
    }
  }
  for (const Mesh::Part& part : mesh.parts) {
    Mesh::Part halves{part.name, {}};
    for (const auto& [a, b] : part.sides) {
      const std::int32_t middle = a == b ? a : middle_of(a, b);
      halves.sides.push_back({a, middle});
      if (a != b) halves.sides.push_back({middle, b});
    }
    fine.parts.push_back(std::move(halves));
  }
  return fine;
}

}  // namespace delf
