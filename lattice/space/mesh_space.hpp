// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "lattice/space/given_in_time.hpp"
#include "lattice/space/mesh.hpp"

namespace delf {

/// A mesh as the space of a lattice: its points are the sites of a row.
struct MeshSpace {
  Mesh mesh;
  std::vector<char> fixed;  ///< [site]: the site keeps its value, and has no equation

  struct AtPoint {
    std::int32_t point;
    std::shared_ptr<const GivenInTime> given;
  };
  /// Fixed sites whose values follow data, each once.
  std::vector<AtPoint> driven = {};
  /// What flows in at sites that are free, ∫ f N_i ds over the boundary: the action has Σ_i ∫ f_i·φ_i dt besides.
  std::vector<AtPoint> fluxes = {};

  /// The boundary does work on the fields.
  bool boundary_works() const { return !(driven.empty() && fluxes.empty()); }
};

}  // namespace delf
