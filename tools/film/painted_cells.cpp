// SPDX-License-Identifier: MIT
#include "tools/film/painted_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lattice/index.hpp"
#include "tools/complex/drawn_mesh.hpp"

namespace delf {
namespace {

/// A point on the screen, and how near it is to the eye.
Mesh::Point seen(const Mesh::Point& p, bool flat) {
  if (flat) return {p[0], p[1], 0};
  constexpr double about_x = 65 * std::numbers::pi / 180, about_z = 40 * std::numbers::pi / 180;
  const double x = p[0] * std::cos(about_z) + p[1] * std::sin(about_z),
               y = p[1] * std::cos(about_z) - p[0] * std::sin(about_z);
  return {x, y * std::cos(about_x) + p[2] * std::sin(about_x), p[2] * std::cos(about_x) - y * std::sin(about_x)};
}

}  // namespace

PaintedCells::PaintedCells(const Mesh& mesh, int longer_side) {
  const DrawnMesh drawn(mesh);
  const bool flat = mesh.coordinates() < 3;
  std::vector<Mesh::Point> on_screen;
  for (const Mesh::Point& p : drawn.points) on_screen.push_back(seen(p, flat));
  for (const std::size_t axis : {0UL, 1UL}) {
    const auto of_axis = [&](const Mesh::Point& p) { return p[axis]; };
    const auto [low, high] = std::ranges::minmax_element(on_screen, {}, of_axis);
    low_[axis] = (*low)[axis], high_[axis] = (*high)[axis];
  }
  const double pixel = std::max(high_[0] - low_[0], high_[1] - low_[1]) / longer_side;
  width_ = std::clamp(static_cast<int>(std::lround((high_[0] - low_[0]) / pixel)), 1, longer_side);
  height_ = std::clamp(static_cast<int>(std::lround((high_[1] - low_[1]) / pixel)), 1, longer_side);
  pixels_.resize(at(width_) * at(height_));
  std::vector<double> nearest(pixels_.size(), -std::numeric_limits<double>::infinity());

  const auto paint = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    const Mesh::Point &A = on_screen[at(a)], &B = on_screen[at(b)], &C = on_screen[at(c)];
    const double area = (B[0] - A[0]) * (C[1] - A[1]) - (B[1] - A[1]) * (C[0] - A[0]);
    if (area == 0) return;
    const auto bounds = [&](std::size_t axis, int size) {
      const auto [low, high] = std::minmax({A[axis], B[axis], C[axis]});
      return std::pair(std::clamp(static_cast<int>((low - low_[axis]) / pixel - 0.5), 0, size - 1),
                       std::clamp(static_cast<int>((high - low_[axis]) / pixel + 0.5), 0, size - 1));
    };
    const auto [left, right] = bounds(0, width_);
    const auto [bottom, top] = bounds(1, height_);
    for (int j = bottom; j <= top; ++j)
      for (int i = left; i <= right; ++i) {
        const double x = low_[0] + (i + 0.5) * pixel, y = low_[1] + (j + 0.5) * pixel;
        // barycentric coordinates; the edge itself belongs to both sides
        constexpr double edge = -1e-9;
        const double of_b = ((x - A[0]) * (C[1] - A[1]) - (y - A[1]) * (C[0] - A[0])) / area,
                     of_c = ((B[0] - A[0]) * (y - A[1]) - (B[1] - A[1]) * (x - A[0])) / area, of_a = 1 - of_b - of_c;
        if (of_a < edge || of_b < edge || of_c < edge) continue;
        const double depth = of_a * A[2] + of_b * B[2] + of_c * C[2];
        const std::size_t n = at(j) * at(width_) + at(i);
        if (depth <= nearest[n]) continue;
        nearest[n] = depth;
        pixels_[n] = {{drawn.of[at(a)], drawn.of[at(b)], drawn.of[at(c)]},
                      {static_cast<float>(of_a), static_cast<float>(of_b), static_cast<float>(of_c)}};
      }
  };
  for (int cell = 0; cell < mesh.cells(); ++cell) {
    const auto corners = drawn.cell(mesh, cell);
    for (std::size_t l = 1; l + 1 < corners.size(); ++l) paint(corners[0], corners[l], corners[l + 1]);
  }
}

std::vector<float> PaintedCells::values(std::span<const double> of_points) const {
  std::vector<float> values;
  values.reserve(pixels_.size());
  for (const Pixel& pixel : pixels_) {
    float sum = pixel.points[0] < 0 ? std::numeric_limits<float>::quiet_NaN() : 0;
    for (std::size_t l = 0; l < 3 && pixel.points[0] >= 0; ++l)
      sum += pixel.weights[l] * static_cast<float>(of_points[at(pixel.points[l])]);
    values.push_back(sum);
  }
  return values;
}

}  // namespace delf
