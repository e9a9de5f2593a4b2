// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_team.hpp"

#include <algorithm>

#include "schemes/stepping/flush_denormals.hpp"

namespace delf {
namespace {

// Some ten microseconds: longer than what a thread does alone between two parts of a long row.
constexpr int looks_before_sleep = 4000;

/// Returns when `value` is no longer `old`.
void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  for (int look = 0; look < looks_before_sleep; ++look) {
    if (value.load(std::memory_order_acquire) != old) return;
#if defined(__SSE2__)
    _mm_pause();
#endif
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

RowTeam::RowTeam(int threads) {
  for (int which = 1; which < threads; ++which) workers_.emplace_back([this, which] { work(which); });
}

RowTeam::~RowTeam() {
  over_ = true;
  ++round_;
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void RowTeam::run(int parts, const std::function<void(int)>& part) {
  if (parts == 1) return part(0);
  part_ = &part;
  parts_ = parts;
  unfinished_.store(static_cast<std::uint32_t>(workers_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  part(0);
  for (std::uint32_t left; (left = unfinished_.load(std::memory_order_acquire)) != 0;) await_change(unfinished_, left);
}

void RowTeam::work(int which) {
  const FlushDenormals guard;
  for (std::uint32_t seen = 0;;) {
    await_change(round_, seen);
    ++seen;
    if (over_) return;
    if (which < parts_) (*part_)(which);
    if (unfinished_.fetch_sub(1, std::memory_order_acq_rel) == 1) unfinished_.notify_all();
  }
}

}  // namespace delf
