// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/space/mesh.hpp"

namespace delf {

/// A picture of a mesh: which triangle of its cells each of its pixels shows, and where in it. A plane is seen from above, a
/// surface as gnuplot has it by `set view 65,40`.
class PaintedCells {
 public:
  /// The longer side has so many pixels.
  PaintedCells(const Mesh&, int longer_side);

  int width() const { return width_; }
  int height() const { return height_; }
  /// The ends of the picture in the plane, of a surface in that of the screen.
  const std::array<double, 2>& low() const { return low_; }
  const std::array<double, 2>& high() const { return high_; }
  /// The values at its pixels, row by row from below, piecewise linear between those of points; not a number beside the mesh.
  std::vector<float> values(std::span<const double> of_points) const;

 private:
  struct Pixel {
    std::array<std::int32_t, 3> points{-1, -1, -1};
    std::array<float, 3> weights{};
  };
  int width_ = 0, height_ = 0;
  std::array<double, 2> low_{}, high_{};
  std::vector<Pixel> pixels_;
};

}  // namespace delf
