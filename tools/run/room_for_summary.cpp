// SPDX-License-Identifier: MIT
#include "tools/run/room_for_summary.hpp"

#include <string>

#include "tools/files/text_file.hpp"

namespace delf {

RoomForSummary::RoomForSummary(const std::filesystem::path& folder) : part_(folder / "summary.json.part") {
  try {
    TextFile room(part_);
    room.write(std::string(1 << 14, ' '));
    room.close();
  } catch (...) {
    give_up();
    throw;
  }
}

RoomForSummary::~RoomForSummary() { give_up(); }

void RoomForSummary::give_up() {
  std::error_code none;
  std::filesystem::remove(part_, none);
}

}  // namespace delf
