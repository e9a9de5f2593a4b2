// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "lattice/index.hpp"
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
  // Two faces are a square of points, diamond[y][x], with (0, 0), (n, 0), (n, n) and (0, n) counterclockwise from outside.
  using Diamond = std::vector<std::vector<std::int32_t>>;
  std::vector<Diamond> diamonds{{{0, 11}, {5, 4}},  {{0, 5}, {1, 9}}, {{0, 1}, {7, 8}}, {{0, 7}, {10, 6}},
                                {{0, 10}, {11, 2}}, {{3, 9}, {4, 5}}, {{3, 8}, {9, 1}}, {{3, 6}, {8, 7}},
                                {{3, 2}, {6, 10}},  {{3, 4}, {2, 11}}};
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
    for (Diamond& coarse : diamonds) {
      const std::size_t size = 2 * coarse.size() - 1;
      Diamond fine(size, std::vector<std::int32_t>(size));
      for (std::size_t y = 0; y < size; ++y)
        for (std::size_t x = 0; x < size; ++x)
          fine[y][x] = y % 2 && x % 2   ? middle(coarse[y / 2][x / 2 + 1], coarse[y / 2 + 1][x / 2])
                       : y % 2 || x % 2 ? middle(coarse[y / 2][x / 2], coarse[(y + 1) / 2][(x + 1) / 2])
                                        : coarse[y / 2][x / 2];
      coarse = std::move(fine);
    }
  }
  // Points are numbered along the rows of diamonds, and the two poles last. Each diamond has two of its sides: those that
  // leave its pole along x, in the north, or along y.
  std::vector<std::int32_t> order;
  for (const Diamond& points : diamonds) {
    const std::size_t south = points[0][0] == 0 ? 0 : 1;
    for (std::size_t y = south; y + 1 < points.size() + south; ++y)
      for (std::size_t x = 1 - south; x < points.size() - south; ++x) order.push_back(points[y][x]);
  }
  order.insert(order.end(), {0, 3});
  std::vector<std::int32_t> number(order.size());
  const std::vector<Mesh::Point> as_found = mesh.points;
  for (std::size_t n = 0; n < order.size(); ++n)
    number[at(order[n])] = static_cast<std::int32_t>(n), mesh.points[n] = as_found[at(order[n])];
  for (const Diamond& points : diamonds)
    for (std::size_t y = 0; y + 1 < points.size(); ++y)
      for (std::size_t x = 0; x + 1 < points.size(); ++x) {
        const std::int32_t a = number[at(points[y][x])], b = number[at(points[y][x + 1])],
                           c = number[at(points[y + 1][x + 1])], d = number[at(points[y + 1][x])];
        mesh.add_cell(std::array{a, b, d});
        mesh.add_cell(std::array{b, c, d});
      }
  return mesh;
}

}  // namespace delf
