// SPDX-License-Identifier: MIT
#pragma once
#include <cstring>
#include <string>
#include <string_view>

#include "schemes/stepping/saved_state.hpp"

namespace delf {

/// Appends the saved state of a run to bytes in memory.
class StateWriter final : public SavedState {
 public:
  explicit StateWriter(std::string& bytes) : bytes_(bytes) {}
  bool restores() const override { return false; }

 private:
  void transfer(void* bytes, std::size_t count) override { bytes_.append(static_cast<const char*>(bytes), count); }
  std::uint64_t most_items() const override { return 0; }

  std::string& bytes_;
};

/// Reads it again. Throws BadInput where there are too few bytes.
class StateReader final : public SavedState {
 public:
  explicit StateReader(std::string_view bytes) : left_(bytes) {}
  bool restores() const override { return true; }

 private:
  void transfer(void* bytes, std::size_t count) override {
    if (count > left_.size()) throw BadInput("", "the saved state of the run is not whole");
    if (count > 0) std::memcpy(bytes, left_.data(), count);  // an empty vector has no address
    left_.remove_prefix(count);
  }
  std::uint64_t most_items() const override { return left_.size(); }

  std::string_view left_;
};

}  // namespace delf
