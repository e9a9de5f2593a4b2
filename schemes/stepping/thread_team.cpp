// SPDX-License-Identifier: MIT
#include "schemes/stepping/thread_team.hpp"

#include <algorithm>
#include <chrono>

#include "lattice/index.hpp"
#include "schemes/stepping/flush_denormals.hpp"

namespace delf {
namespace {

// Longer than what a thread does alone between two parts of a long row; a thread that waits awake for longer takes a core
// from the one that it waits for, where there are more threads than cores.
constexpr std::chrono::microseconds awake{10};
constexpr int looks_between_clocks = 16;

/// Returns when `value` is no longer `old`.
void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  const auto until = std::chrono::steady_clock::now() + awake;
  do {
    for (int look = 0; look < looks_between_clocks; ++look) {
      if (value.load(std::memory_order_acquire) != old) return;
#if defined(__SSE2__)
      _mm_pause();
#endif
    }
  } while (std::chrono::steady_clock::now() < until);
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

ThreadTeam::ThreadTeam(int threads, int most_parts) : begun_(at(std::max(threads, most_parts))) {
  for (int which = 1; which < threads; ++which) workers_.emplace_back([this, which] { work(which); });
}

ThreadTeam::~ThreadTeam() {
  over_ = true;
  ++round_;
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadTeam::run(int parts, const std::function<void(int)>& part) {
  if (parts == 1) return part(0);
  const std::uint32_t round = round_.load(std::memory_order_relaxed) + 1;
  part_ = &part;
  unfinished_.store(static_cast<std::uint32_t>(parts), std::memory_order_relaxed);
  // Part 0 is the caller's, and those from `parts` on are nobody's.
  begun_[0].store(round, std::memory_order_relaxed);
  for (auto none = begun_.begin() + parts; none != begun_.end(); ++none) none->store(round, std::memory_order_relaxed);
  round_.store(round, std::memory_order_release);
  round_.notify_all();
  part(0);
  unfinished_.fetch_sub(1, std::memory_order_acq_rel);
  do_parts(0, round);
  for (std::uint32_t left; (left = unfinished_.load(std::memory_order_acquire)) != 0;) await_change(unfinished_, left);
}

void ThreadTeam::do_parts(int which, std::uint32_t round) {
  const int most = static_cast<int>(begun_.size());
  for (int n = 0; n < most; ++n) {
    const int part = (which * most / size() + n) % most;
    if (!begin(part, round)) continue;
    (*part_)(part);
    if (unfinished_.fetch_sub(1, std::memory_order_acq_rel) == 1) unfinished_.notify_all();
  }
}

/// One thread alone can begin a part in a round, and none in a round that is over: all its parts have been begun then.
bool ThreadTeam::begin(int part, std::uint32_t round) {
  std::atomic<std::uint32_t>& begun = begun_[part];
  std::uint32_t last = begun.load(std::memory_order_relaxed);
  return last == round - 1 && begun.compare_exchange_strong(last, round, std::memory_order_acq_rel);
}

void ThreadTeam::work(int which) {
  const FlushDenormals guard;
  for (std::uint32_t seen = 0;;) {
    await_change(round_, seen);
    seen = round_.load(std::memory_order_acquire);
    if (over_) return;
    do_parts(which, seen);
  }
}

}  // namespace delf
