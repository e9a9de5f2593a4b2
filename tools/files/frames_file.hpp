// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
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

/// frames.h5 beside a fields.h5: each component in each frame as a data set of its own, /NAME/FRAME, and, with `together`,
/// /NAME/all of frames × sites. They are virtual, some bytes each, and read fields.h5. The readers of XDMF in ParaView
/// agree on whole data sets only: two of three read no part of a larger one. `moving`: the data set of positions, frames ×
/// sites, that /places has beside the times, (x, t) for each site of each frame. Throws SystemFailure.
void write_frames_file(const std::filesystem::path& folder, const std::vector<SharedRows>&, std::size_t frames,
                       std::size_t sites, bool together = false, const std::string& moving = {});

}  // namespace delf
