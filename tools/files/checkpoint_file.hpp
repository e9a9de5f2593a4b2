// SPDX-License-Identifier: MIT
#pragma once
#include <boost/crc.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "schemes/stepping/saved_state.hpp"

namespace delf {

/// Writes the saved state of a run. The file is made beside the one of that name, reaches the disk, and then takes its
/// place; the one before is kept as NAME.previous. It ends with a checksum (CRC-32) of all before it.
class CheckpointWriter final : public SavedState {
 public:
  /// Throws SystemFailure, as all that writes.
  explicit CheckpointWriter(const std::filesystem::path&);
  ~CheckpointWriter() override;
  bool restores() const override { return false; }
  /// Puts the checkpoint in its place. A writer that is not closed has changed nothing.
  void close();

 private:
  void transfer(void* bytes, std::size_t count) override;
  std::uint64_t most_items() const override { return 0; }
  [[noreturn]] void fail() const;

  std::filesystem::path path_, part_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  boost::crc_32_type sum_;
};

/// Reads it again. Throws BadInput for what is no such file, or a damaged one: it is read whole before anything is made of
/// it.
class CheckpointReader final : public SavedState {
 public:
  explicit CheckpointReader(const std::filesystem::path&);
  bool restores() const override { return true; }

 private:
  void transfer(void* bytes, std::size_t count) override;
  std::uint64_t most_items() const override { return left_; }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::uint64_t left_ = 0;  ///< bytes before the checksum
};

}  // namespace delf
