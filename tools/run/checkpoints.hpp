// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "schemes/stepping/saved_state.hpp"
#include "tools/report/due.hpp"

namespace delf {

/// The head of a checkpoint, which describes its run before the state itself.
struct CheckpointHead {
  std::string version, instructions;
  std::string scene;  ///< the text of scene.ini
  std::string name;   ///< of the scene
  std::vector<std::string> warnings;
  std::int64_t row = 0;  ///< the newest

  void visit(SavedState& state) {
    state("version", version), state("instructions", instructions);
    state("scene", scene), state("name", name), state("warnings", warnings), state("row", row);
  }
};

/// The instruction set that this program was compiled for, and what of it this processor has: other ones round otherwise.
std::string instruction_set();

/// The checkpoints of a run, one every so many seconds and where they are asked for.
class Checkpoints {
 public:
  static constexpr auto file_name = "checkpoint";

  /// 0 seconds: none at all.
  Checkpoints(const std::filesystem::path& folder, CheckpointHead head, double seconds);
  /// Those of a run in memory, where they are asked for: the last one takes the place of the one before.
  explicit Checkpoints(std::string& memory) : due_(0), wanted_(true), memory_(&memory) {}

  bool due(std::int64_t row) { return due_.at(row); }
  /// `state` hands over what follows the head. A failure is reported once, and the run goes on.
  void write(std::int64_t row, const std::function<void(SavedState&)>& state);
  bool wanted() const { return wanted_; }

 private:
  std::filesystem::path path_;
  CheckpointHead head_;
  Due due_;
  bool wanted_, reported_ = false;
  std::string* memory_ = nullptr;
};

}  // namespace delf
