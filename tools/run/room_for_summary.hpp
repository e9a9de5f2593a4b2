// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

namespace delf {

/// Room for summary.json in a folder of results, whatever else fills the disk: write_text_file() takes it.
class RoomForSummary {
 public:
  /// Throws SystemFailure.
  explicit RoomForSummary(const std::filesystem::path& folder);
  ~RoomForSummary();
  RoomForSummary(const RoomForSummary&) = delete;
  RoomForSummary& operator=(const RoomForSummary&) = delete;

 private:
  void give_up();
  std::filesystem::path part_;
};

}  // namespace delf
