// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/hdf5_handle.hpp"

namespace delf {

/// The recorded rows as fields.h5:
///
///     /time   frames                       attribute units
///     /space  sites                        attribute units
///     /field  frames × sites × 1           values as they are, not reduced modulo 2π
///     /       attributes scene (the resolved scene), version, winding
///
/// Rows are written in blocks, and each block is flushed: what has been written stays readable. Throws SystemFailure.
class FieldsFile {
 public:
  FieldsFile(const std::filesystem::path&, std::span<const double> space, std::int64_t expected_frames,
             const std::string& scene, int winding);
  ~FieldsFile();

  void append(double time, std::span<const double> row);
  /// Writes what is still waiting. Until then it may be missing on the disk.
  void close();

 private:
  void write_block();
  void require(bool went_well, const char* what);

  std::filesystem::path path_;
  std::size_t sites_, frames_per_block_;
  hsize_t frames_written_ = 0;
  std::vector<double> times_, rows_;  ///< waiting
  Hdf5Handle file_, time_, field_;    ///< closed in the other order
};

}  // namespace delf
