// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/solvers/row_layout.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// S¹: wrapping says which way round only while differences on a stencil stay well below π. Tests the stencils whose top
/// row is `newest`, from their first vertex to each other; throws NotFinite with the site of the first one that fails.
/// rows[back·d + a]: component a so many rows before the newest.
void check_wrapped_differences(const LatticeSystem&, const RowLayout&, const std::vector<const double*>& rows,
                               std::int64_t newest);

}  // namespace delf
