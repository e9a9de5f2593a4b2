// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

#include "schemes/system/lattice_system.hpp"
#include "schemes/stepping/rows/section_rows.hpp"

namespace delf {

/// S¹: wrapping says which way round only while differences on a stencil stay well below π. Looks at the stencils whose top
/// row is the newest, from their first vertex to each other; throws NotFinite with the site of the first one that is not.
void check_wrapped_differences(const LatticeSystem&, SectionRows&, std::int64_t newest);

}  // namespace delf
