// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

namespace delf {

/// In which slot of a ring of `held` rows a row lies: row modulo held, without a division for a row that is near the one
/// asked for before.
class RingSlots {
 public:
  explicit RingSlots(int held = 1) : held_(held) {}

  int held() const { return held_; }
  [[gnu::always_inline]] void at(std::int64_t row) {
    const std::int64_t by = row - row_;
    row_ = row;
    if (by == 1) slot_ = slot_ + 1 == held_ ? 0 : slot_ + 1;  // as from step to step
    else if (by != 0) find(by);
  }
  /// Of the row `back` before; −held < back < held.
  int operator()(int back) const {
    const int slot = slot_ - back;
    return slot < 0 ? slot + held_ : slot >= held_ ? slot - held_ : slot;
  }
  int slot() const { return slot_; }
  /// The slot of the row before the one in `slot`.
  int before(int slot) const { return slot == 0 ? held_ - 1 : slot - 1; }

 private:
  [[gnu::noinline]] void find(std::int64_t by) {
    if (by > -held_ && by < held_) slot_ = (*this)(-static_cast<int>(by));
    else slot_ = static_cast<int>((row_ % held_ + held_) % held_);
  }

  int held_, slot_ = 0;
  std::int64_t row_ = 0;
};

}  // namespace delf
