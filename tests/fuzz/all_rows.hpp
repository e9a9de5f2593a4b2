// SPDX-License-Identifier: MIT
#pragma once
#include "tools/files/rows_file.hpp"

namespace delf::fuzz {

/// Reads all that a file of rows says.
inline void read_all(const RowsFile& file) {
  file.winding();
  for (int frame = 0; frame < file.frames(); ++frame) file.time(frame), file.row(frame), file.momenta(frame);
}

}  // namespace delf::fuzz
