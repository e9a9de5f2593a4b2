// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/files/row_names.hpp"

namespace delf {

/// fields.xdmf and surface.xdmf beside the fields.h5 of a lattice, by which ParaView opens it as a series of rows, and as a
/// surface over x and t; and frames.h5, which both read. Nodes inside the cells, multipliers and traces are fields, too; sites that move are at their
/// places. They point into fields.h5, and copy nothing. Throws SystemFailure, and BadInput for a file without rows.
void write_lattice_xdmf(const std::filesystem::path& folder, const RowNames&);

}  // namespace delf
