// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace delf {

inline constexpr auto frames_file_name = "frames.h5";

/// frames.h5 beside a fields.h5: each component of /field in each frame as a data set of its own, /NAME/FRAME. They are
/// virtual, some bytes each, and read fields.h5. The readers of XDMF in ParaView agree on whole data sets only: two of
/// three read no part of a larger one. A frame has behind its sites copies of some, those of a mesh that is joined at a seam.
/// Throws SystemFailure.
void write_frames_file(const std::filesystem::path& folder, const std::vector<std::string>& components,
                       std::size_t frames, std::size_t sites, std::span<const std::int32_t> copies = {});

}  // namespace delf
