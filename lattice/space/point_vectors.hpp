// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

#include "lattice/space/mesh.hpp"

namespace delf {

/// Vectors between points of a mesh, and their products.
inline Mesh::Point between(const Mesh::Point& a, const Mesh::Point& b) {
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}
inline double dot(const Mesh::Point& a, const Mesh::Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Mesh::Point cross(const Mesh::Point& a, const Mesh::Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Mesh::Point& a) { return std::sqrt(dot(a, a)); }

}  // namespace delf
