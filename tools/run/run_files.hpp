// SPDX-License-Identifier: MIT
#pragma once
#include "tools/files/written_part.hpp"

namespace delf {

class SavedState;

/// The files that the recorded rows of a run go to.
class RunFiles {
 public:
  /// The amount of each file that has reached the disk.
  struct Written {
    WrittenPart series, fields;
  };

  virtual ~RunFiles() = default;
  /// Writes all buffered rows, and with `sync` waits until they are on the disk.
  virtual Written flush(bool sync) = 0;
  /// Visits what is kept for figures and the summary.
  virtual void visit(SavedState&) = 0;
};

}  // namespace delf
