// SPDX-License-Identifier: MIT
#include "schemes/stepping/thread_team.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <limits>
#include <numeric>
#include <thread>

#include "schemes/stepping/flush_denormals.hpp"
#include "tests/catch.hpp"

using namespace delf;

TEST_CASE("a team does every part once, the first in the calling thread, and returns when all are done") {
  for (int threads : {1, 2, 3, 5}) {
    ThreadTeam team(threads);
    CHECK(team.size() == threads);
    for (int parts = 1; parts <= threads; ++parts) {
      CAPTURE(threads, parts);
      std::vector<int> times(threads, 0);
      std::thread::id of_first;
      bool right = true;
      for (int round = 1; round <= 300; ++round) {
        team.run(parts, [&](int part) {
          ++times[part];
          if (part == 0) of_first = std::this_thread::get_id();
        });
        for (int part = 0; part < threads; ++part) right = right && times[part] == (part < parts ? round : 0);
      }
      CHECK(right);
      CHECK(of_first == std::this_thread::get_id());
    }
  }
}

TEST_CASE("parts work at the same time, and see what was written before the round") {
  ThreadTeam team(3);
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> begun{0};
    int written = round;
    std::array<int, 3> seen{};
    team.run(3, [&](int part) {
      seen[part] = written;
      ++begun;
      while (begun < 3) std::this_thread::yield();  // would hang if one part waited for another
    });
    CHECK(seen == std::array<int, 3>{round, round, round});
  }
}

TEST_CASE("a team that has gone to sleep wakes up, and one that never worked ends") {
  ThreadTeam idle(4);
  ThreadTeam team(2);
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    std::atomic<int> done{0};
    team.run(2, [&](int part) {
      if (part == 1) std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the caller sleeps too
      ++done;
    });
    CHECK(done == 2);
  }
}

TEST_CASE("a thread that does not run holds up nobody: the calling thread does its part") {
  // It takes microseconds to wake up; until then both parts are done.
  ThreadTeam team(2);
  int by_caller = 0;
  for (int round = 0; round < 20; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    team.run(2, [&, caller = std::this_thread::get_id()](int part) {
      if (part == 1 && std::this_thread::get_id() == caller) ++by_caller;
    });
  }
  CHECK(by_caller > 0);
}

TEST_CASE("parts of other threads treat denormal numbers as the calling thread does under its guard") {
  const FlushDenormals guard;
  ThreadTeam team(3);
  std::array<double, 3> halves{};
  volatile double small = std::numeric_limits<double>::min();
  team.run(3, [&](int part) { halves[part] = small / 2; });
  CHECK(halves[1] == halves[0]);
  CHECK(halves[2] == halves[0]);
}

TEST_CASE("the count of parts can fail: a team of one does not do two") {
  // what the first case would see if parts were left out
  std::vector<int> times(2, 0);
  ThreadTeam team(2);
  team.run(1, [&](int part) { ++times[part]; });
  CHECK(times == std::vector<int>{1, 0});
}
