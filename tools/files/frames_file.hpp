// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace delf {

inline constexpr auto frames_file_name = "frames.h5";

/// A data set of fields.h5, frames × sites × components, or frames × sites, and the names of its components in frames.h5.
struct SharedRows {
  std::string data_set;
  std::vector<std::string> components;
  bool has_components = true;  ///< else it has two axes, and one name
};

/// Further parts of frames.h5.
struct FurtherFrames {
  bool together = false;  ///< /NAME/all of frames × sites
  std::string
      moving;  ///< the data set of positions, frames × sites, of which /places has (x, t) of each site and frame
  std::span<const std::int32_t>
      copies;  ///< sites that each /NAME/FRAME has once more behind all: those of a mesh at its seam
};

/// frames.h5 beside a fields.h5: each component in each frame as a data set of its own, /NAME/FRAME. They are virtual, some
/// bytes each, and read fields.h5. The readers of XDMF in ParaView agree on whole data sets only: two of three read no part
/// of a larger one. Throws SystemFailure.
void write_frames_file(const std::filesystem::path& folder, const std::vector<SharedRows>&, std::size_t frames,
                       std::size_t sites, const FurtherFrames& further = {});

}  // namespace delf
