// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lattice/space/mesh.hpp"

namespace delf {

Mesh graded_interval(double length, int points, double ratio) {
  Mesh mesh{.dimension = 1, .points = {{0, 0, 0}}, .vertices = {}};
  double cell = 1, end = 0;
  for (std::int32_t n = 1; n < points; ++n, cell *= ratio) {
    mesh.points.push_back({end += cell, 0, 0});
    mesh.add_cell(std::array{n - 1, n});
  }
  for (Mesh::Point& p : mesh.points) p[0] *= length / end;
  mesh.parts = {{"left", {{0, 0}}}, {"right", {{points - 1, points - 1}}}};
  return mesh;
}

Mesh rectangle_mesh(double width, double height, int nx, int ny, bool quadrilaterals) {
  Mesh mesh;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.points.push_back({width * i / nx, height * j / ny, 0});
  mesh.parts = {{"left", {}}, {"right", {}}, {"bottom", {}}, {"top", {}}};
  for (std::int32_t j = 0; j < ny; ++j)
    for (const std::int32_t i : {0, nx})
      mesh.parts[i ? 1 : 0].sides.push_back({j * (nx + 1) + i, (j + 1) * (nx + 1) + i});
  for (const std::int32_t j : {0, ny})
    for (std::int32_t i = 0; i < nx; ++i)
      mesh.parts[j ? 3 : 2].sides.push_back({j * (nx + 1) + i, j * (nx + 1) + i + 1});
  for (std::int32_t j = 0; j < ny; ++j)
    for (std::int32_t i = 0; i < nx; ++i) {
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, d = a + nx + 1, c = d + 1;
      if (quadrilaterals) {
        mesh.add_cell(std::array{a, b, c, d});
      } else if ((i + j) % 2 == 0) {
        mesh.add_cell(std::array{a, b, c});
        mesh.add_cell(std::array{a, c, d});
      } else {
        mesh.add_cell(std::array{a, b, d});
        mesh.add_cell(std::array{b, c, d});
      }
    }
  return mesh;
}

namespace {

Mesh::Point on_sphere(Mesh::Point p) {
  const double r = std::hypot(p[0], p[1], p[2]);
  return {p[0] / r, p[1] / r, p[2] / r};
}

}  // namespace

Mesh icosahedral_sphere(int level) {
  // Corners of three golden rectangles, (0, ±1, ±g) and its rotations; faces counterclockwise from outside.
  const double g = (1 + std::sqrt(5.0)) / 2;
  Mesh mesh{.points = {{-1, g, 0},
                       {1, g, 0},
                       {-1, -g, 0},
                       {1, -g, 0},
                       {0, -1, g},
                       {0, 1, g},
                       {0, -1, -g},
                       {0, 1, -g},
                       {g, 0, -1},
                       {g, 0, 1},
                       {-g, 0, -1},
                       {-g, 0, 1}},
            .vertices = {}};
  for (Mesh::Point& p : mesh.points) p = on_sphere(p);
  std::vector<std::array<std::int32_t, 3>> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int n = 0; n < level; ++n) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [known, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::int32_t>(mesh.points.size()));
      if (is_new) {
        const Mesh::Point p = mesh.points[a], q = mesh.points[b];
        mesh.points.push_back(on_sphere({p[0] + q[0], p[1] + q[1], p[2] + q[2]}));
      }
      return known->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  for (const auto& face : faces) mesh.add_cell(face);
  return mesh;
}

}  // namespace delf
