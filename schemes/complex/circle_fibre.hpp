// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "lattice/space/mesh.hpp"

namespace delf {

/// A field of angles on a mesh, by the representatives modulo 2π that make it continuous: from there on differences are
/// those of real numbers. Throws NotFinite where points of a cell are more than 0.9 π apart, and BadInput where the field
/// winds around a hole of the mesh, so that no real numbers are continuous.
std::vector<double> lifted(const Mesh&, std::vector<double> angles);

/// Whether differences within cells, and of each point from the row before, still tell which way round the field went.
/// Throws NotFinite with the first point where they do not.
void check_wrapped_differences(const Mesh&, std::span<const double> row, std::span<const double> before);

}  // namespace delf
