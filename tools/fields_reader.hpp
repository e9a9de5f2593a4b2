// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/hdf5_handle.hpp"

namespace delf {

/// Rows of a fields.h5, to start from. Throws BadInput for a file that is no such thing (key initial.file) or has no
/// such frame (key initial.frame).
class FieldsReader {
 public:
  explicit FieldsReader(const std::filesystem::path&);

  int sites() const noexcept { return sites_; }
  int frames() const noexcept { return frames_; }
  /// The time of a frame, if the file has /time.
  std::optional<double> time(int frame) const;
  std::vector<double> row(int frame) const;
  /// What the field gains around the circle, in units of 2π, if the file says so.
  std::optional<int> winding() const;

 private:
  Hdf5Handle file_, field_;
  int frames_ = 0, sites_ = 0;
};

}  // namespace delf
