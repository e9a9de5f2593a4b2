// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "lattice/index.hpp"
#include "schemes/families/equidistribution.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The constraint of a mesh at its rows, and what is known of the mesh by it.
struct MeshConstraint {
  int d = 1;
  MeshMonitor monitor = {};
  double stable_step = std::numeric_limits<double>::infinity();  ///< h of a cell of width 1, by the linear theory
  double delay = 0;                                              ///< τ in τ X_t = G; 0: G = 0
  /// The density on a row of the moving cells: a row as mechanics.
  std::shared_ptr<const StencilFamily> row = {};

  /// The distance of the fields of a row, y[i·stride + a], from having no mesh, as a part of the length: cells with
  /// α² Δφ² + δ² = c, c ≥ α² max Δφ², fill the length if and only if
  ///
  ///     m = X_max − α Σ_e √(max Δφ² − Δφ_e²) > 0
  ///
  /// Nothing for other monitors than arclength.
  std::optional<double> margin(std::span<const double> y, std::size_t stride, double length) const {
    if (monitor.kind != MeshMonitor::Kind::arclength) return std::nullopt;
    const auto rise = [&](std::size_t i) {
      double square = 0;
      for (std::size_t a = 0; a < at(d); ++a) square += std::pow(y[(i + 1) * stride + a] - y[i * stride + a], 2);
      return square;
    };
    double most = 0, filled = 0;
    for (std::size_t i = 0; (i + 1) * stride < y.size(); ++i) most = std::max(most, rise(i));
    for (std::size_t i = 0; (i + 1) * stride < y.size(); ++i) filled += std::sqrt(most - rise(i));
    return 1 - monitor.alpha * filled / length;
  }
};

/// The one of some families; null: they hold no mesh.
inline const MeshConstraint* find_mesh(std::span<const std::shared_ptr<const StencilFamily>> families) {
  for (const auto& family : families)
    if (const MeshConstraint* mesh = family->mesh_constraint()) return mesh;
  return nullptr;
}

}  // namespace delf
