// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace delf {

/// Threads that work on parts of the same rows, or of the same level, step after step. Between two steps they wait a
/// moment awake, then asleep. A thread that has done its own part takes parts that nobody has begun: where other programs
/// keep a thread from running, the others do its work instead of waiting for it.
class ThreadTeam {
 public:
  /// The calling thread is one of the `threads`. They share so many parts at most: by default one each.
  explicit ThreadTeam(int threads, int most_parts = 0);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }
  /// Calls part(0) … part(parts − 1), each once, at the same time as far as threads are awake, part(0) here; returns when
  /// all are done. Parts do not throw, and treat denormal numbers as zero.
  void run(int parts, const std::function<void(int)>& part);

 private:
  void work(int which);
  /// Does the parts that nobody has begun in this round, from those of thread `which` on and round the end.
  void do_parts(int which, std::uint32_t round);
  bool begin(int part, std::uint32_t round);

  std::vector<std::thread> workers_;
  std::vector<std::atomic<std::uint32_t>> begun_;  ///< the round in which each part was last begun
  std::atomic<std::uint32_t> round_{0}, unfinished_{0};
  std::atomic<bool> over_{false};
  const std::function<void(int)>* part_ = nullptr;  ///< read by who has begun a part: then run() is not over
};

}  // namespace delf
