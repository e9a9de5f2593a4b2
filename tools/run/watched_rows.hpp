// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>

namespace delf {

/// The rows whose energy and residual are measured although they are not recorded: the first ones all, later one drawn at
/// random from every block of `apart` rows. Records at even distances may miss every extreme of a motion whose period they
/// divide; drawn rows do not. A function of the row and the seed alone, so that a run in parts watches the same rows.
class WatchedRows {
 public:
  /// Rows 1 … `first`, and one of every `apart` behind.
  WatchedRows(std::int64_t first, std::int64_t apart, std::uint64_t seed)
      : first_(first), apart_(std::max<std::int64_t>(1, apart)), seed_(seed) {}

  bool contains(std::int64_t row) const { return next(row - 1) == row; }
  /// The next watched row behind this one.
  std::int64_t next(std::int64_t row) const {
    if (row < first_ || apart_ == 1) return row + 1;
    const std::int64_t block = (row + 1) / apart_;
    for (std::int64_t b = block;; ++b)
      if (const std::int64_t watched = of_block(b); watched > row) return watched;
  }
  /// Says which rows a maximum of a run is over, if every `recorded` is recorded (0: the last alone).
  std::string in_words(std::int64_t steps, std::int64_t recorded) const;

 private:
  /// The row that is drawn of a block, by the mixing function of SplitMix64.
  std::int64_t of_block(std::int64_t block) const {
    std::uint64_t z = seed_ * 0xd1342543de82ef95U + (static_cast<std::uint64_t>(block) + 1) * 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return block * apart_ + static_cast<std::int64_t>((z ^ (z >> 31)) % static_cast<std::uint64_t>(apart_));
  }

  std::int64_t first_, apart_;
  std::uint64_t seed_;
};

}  // namespace delf
