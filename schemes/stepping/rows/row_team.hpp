// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace delf {

/// Threads that work on parts of the same rows, step after step. Between two steps they wait a moment awake, then
/// asleep.
class RowTeam {
 public:
  /// The calling thread is one of the `threads`.
  explicit RowTeam(int threads);
  ~RowTeam();
  RowTeam(const RowTeam&) = delete;
  RowTeam& operator=(const RowTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }
  /// Calls part(0) … part(parts − 1) at the same time, parts ≤ size(), part(0) here; returns when all are done. Parts
  /// do not throw, and treat denormal numbers as zero.
  void run(int parts, const std::function<void(int)>& part);

 private:
  void work(int which);

  std::vector<std::thread> workers_;
  std::atomic<std::uint32_t> round_{0}, unfinished_{0};
  std::atomic<bool> over_{false};
  const std::function<void(int)>* part_ = nullptr;
  int parts_ = 0;
};

}  // namespace delf
