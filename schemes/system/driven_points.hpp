// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/space/mesh_space.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The points of a mesh whose values follow data; none on lattices.
std::span<const MeshSpace::AtPoint> driven_points(const LatticeSystem&);
/// The places of their fields in a row, i·C + c.
std::vector<int> places_of_driven_points(const LatticeSystem&);
/// Something flows in at the boundary of a mesh.
bool has_flux_of_mesh(const LatticeSystem&);
/// Gives them their values in a row, y[i·C + c], a node inside the step at its time.
void set_driven_points(const LatticeSystem&, std::int64_t row, std::span<double> y);

}  // namespace delf
