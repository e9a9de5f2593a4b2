// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <string>

#include "lattice/space/mesh.hpp"

namespace delf {

/// Two parts of a boundary that are one.
struct JoinedParts {
  std::string part, with;
};
/// The mesh whose space goes on from one part of its boundary to another: each point of `part` is the one of `with` that a
/// translation takes it to, the same for all of them. Points that are one have the place of the first of them, and cells keep
/// their corners (Mesh::places). Throws BadInput "boundary.PART" for parts that are no copies of each other, and where cells
/// would have too few points between them.
Mesh joined(const Mesh&, std::span<const JoinedParts>);

}  // namespace delf
