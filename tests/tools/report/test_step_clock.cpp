// SPDX-License-Identifier: MIT
#include <chrono>
#include <limits>
#include <memory>
#include <thread>

#include "tests/catch.hpp"
#include "tools/report/step_clock.hpp"
#include "tools/workprecision/lower_envelope.hpp"
#include "tools/workprecision/run_limit.hpp"
#include "tools/workprecision/timed_rounds.hpp"

using namespace delf;

namespace {

constexpr double waiting = 0.03;

void wait() { std::this_thread::sleep_for(std::chrono::duration<double>(waiting)); }

void work(double seconds) {
  const StepClock clock(1);
  for (const double from = clock.now(); clock.since(from) < seconds;) {
  }
}

// Each step waits for the machine and then works for a tenth of that.
struct Waiting : StartedEntry {
  std::int64_t newest_ = 0;
  std::int64_t newest() const override { return newest_; }
  void advance(std::int64_t steps, const RunLimit& limit) override {
    for (; steps > 0 && !limit.reached(); --steps, ++newest_) wait(), work(0.1 * waiting);
  }
  void copy(std::span<double>) const override {}
  double energy() const override { return 1; }
  double forces() const override { return 1; }
};

std::vector<TriedRun> run_of(std::int64_t steps) {
  std::vector<TriedRun> runs(1);
  runs[0].entry = 0;
  runs[0].resolution.steps = steps;
  return runs;
}

const std::vector<WorkPrecisionEntry> waits{
    {.name = "waits", .start = [](const Resolution&) { return std::make_unique<Waiting>(); }}};

}  // namespace

TEST_CASE("steps cost what they have of the processor, and where threads share them what passes") {
  const StepClock alone(1), shared(2);
  const double from = alone.now(), from_shared = shared.now();
  wait();
  CHECK(alone.since(from) < 0.5 * waiting);
  CHECK(shared.since(from_shared) >= 0.9 * waiting);
  work(waiting);
  CHECK(alone.since(from) >= 0.9 * waiting);
}

TEST_CASE("rounds count no time in which the machine does something else") {
  const auto late = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  std::vector<TriedRun> runs = run_of(2);
  time_in_turn(runs, waits, {3}, 1, StepClock(1), late, [] {});
  CHECK(runs[0].result.repeats == 3);
  CHECK(runs[0].result.seconds >= 0.2 * waiting);
  CHECK(runs[0].result.seconds < 1.2 * waiting);
  // the clock of the wall counts it
  time_in_turn(runs, waits, {1}, 1, StepClock(2), late, [] {});
  CHECK(runs[0].result.seconds >= 2 * waiting);
}

TEST_CASE("a run is built anew, untimed, whenever it is timed") {
  const auto late = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  std::vector<TriedRun> runs = run_of(2);
  int built = 0;
  std::vector<WorkPrecisionEntry> entries(1);
  entries[0].start = [&](const Resolution&) {
    ++built, work(2 * waiting);
    return std::make_unique<Waiting>();
  };
  time_in_turn(runs, entries, {3}, 1, StepClock(1), late, [] {});
  CHECK(built == 3);
  CHECK(runs[0].result.repeats == 3);
  CHECK(runs[0].result.seconds < 1.2 * waiting);
}

TEST_CASE("a run ends at its limit, of time that passes or of the processor's") {
  const auto now = [] { return std::chrono::steady_clock::now(); };
  std::vector<TriedRun> runs = run_of(1000000);
  std::int64_t newest = 0;
  struct Noted final : Waiting {
    std::int64_t& to;
    explicit Noted(std::int64_t& of) : to(of) {}
    ~Noted() override { to = newest_; }
  };
  const std::vector<WorkPrecisionEntry> noted{
      {.name = "noted", .start = [&](const Resolution&) { return std::make_unique<Noted>(newest); }}};
  const auto begin = now();
  time_in_turn(runs, noted, {2}, 1, StepClock(1), begin + std::chrono::milliseconds(100), [] {});
  CHECK(runs[0].result.repeats == 0);  // it was not timed to its end
  CHECK(newest > 0);
  CHECK(newest < 1000);

  const RunLimit never(now() + std::chrono::hours(1)), processor(now() + std::chrono::hours(1), 0.5 * waiting);
  wait();
  CHECK_FALSE(processor.reached());  // a busy machine takes nothing of it
  work(waiting);
  CHECK(processor.reached());
  CHECK_FALSE(never.reached());
}

TEST_CASE("runs of which a round took three times another are counted") {
  WorkPrecisionOutcome outcome;
  const auto add = [&](double least, double most, int repeats) {
    WorkPrecisionRun r;
    r.scheme = "a", r.error_linf = 1e-3, r.seconds = least, r.seconds_min = least, r.seconds_max = most;
    r.repeats = repeats;
    outcome.runs.push_back(r);
  };
  add(1, 2.9, 5), add(1, 3.1, 5), add(1, 30, 2), add(1, 1, 0);
  compare(outcome, {1e-2});
  CHECK(outcome.unsteady == 2);
}
