// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lattice/space/mesh.hpp"

namespace delf {

/// Visits every pair (p, q), q < p, of points no further apart than `near`, in the order of p, until the visitor says no.
/// Points lie in buckets of some `near`: the time is that of the points and the pairs.
void each_close_pair(std::span<const Mesh::Point> points, double near,
                     const std::function<bool(std::size_t, std::size_t)>& visit);

/// Two points of a mesh at one place, as those of a seam that is there twice: nearer than 1e-6 of the shortest side of
/// theirs. The later one stands first.
std::optional<std::pair<std::size_t, std::size_t>> coincident_points(const Mesh&);

/// The mesh with points no further apart than `near` made one, which stands where the first of them does.
Mesh merged(const Mesh&, double near);

}  // namespace delf
