// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "tools/complex/complex_scene.hpp"

namespace delf {

/// The cells as /cells of fields.h5 has them: the points of each, or the sites of each stencil, −1 where it has fewer.
struct ListedCells {
  explicit ListedCells(const ComplexScene&);
  int corners = 0;  ///< columns
  std::vector<std::int32_t> points;
};

/// Whether there is a fields.xdmf: XDMF takes two or three coordinates, of space, or t, x and y of a finite complex.
bool has_xdmf(const ComplexScene&);

/// Writes fields.xdmf, by which ParaView opens the frames of fields.h5 at these times, and frames.h5, which has them one by one.
void write_mesh_xdmf(const ComplexScene&, const std::filesystem::path& folder, std::span<const double> times);

}  // namespace delf
