// SPDX-License-Identifier: MIT
#include "tools/workprecision/timed_rounds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "lattice/error.hpp"

namespace delf {

namespace {

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

}  // namespace

std::vector<int> shared_repeats(const std::vector<double>& cost, int repeats, double seconds) {
  // a run that takes t is timed limit/t times
  const auto counts = [&](double limit) {
    std::vector<int> n;
    for (const double t : cost)
      n.push_back(static_cast<int>(std::clamp(std::floor(limit / t), 1.0, static_cast<double>(repeats))));
    return n;
  };
  const auto total = [&](const std::vector<int>& n) {
    return std::inner_product(n.begin(), n.end(), cost.begin(), 0.0);
  };
  if (cost.empty()) return {};
  double low = 0, high = repeats * std::ranges::max(cost) * (1 + 1e-9);
  if (total(counts(high)) <= seconds) return counts(high);
  for (int bisection = 0; bisection < 60; ++bisection) {
    const double middle = 0.5 * (low + high);
    (total(counts(middle)) <= seconds ? low : high) = middle;
  }
  return counts(low);
}

void time_in_turn(std::vector<TriedRun>& runs, const std::vector<WorkPrecisionEntry>& entries,
                  const std::vector<int>& repeats, std::uint64_t seed, const StepClock& clock,
                  std::chrono::steady_clock::time_point until, const std::function<void()>& at) {
  const RunLimit limit(until);
  std::vector<std::vector<double>> seconds(runs.size());
  std::mt19937_64 random(seed);
  const int rounds = repeats.empty() ? 0 : std::ranges::max(repeats);
  for (int round = 0; round < rounds && !limit.reached(); ++round) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < runs.size(); ++i)
      if (repeats[i] > round) order.push_back(i);
    std::ranges::shuffle(order, random);
    for (const std::size_t i : order) {
      if (limit.reached()) break;
      const auto started = entries[runs[i].entry].start(runs[i].resolution);
      const double from = clock.now();
      started->advance(runs[i].resolution.steps - started->newest(), limit);
      const double taken = clock.since(from);
      if (started->newest() != runs[i].resolution.steps) break;
      seconds[i].push_back(taken);
      at();
    }
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (seconds[i].empty()) continue;
    WorkPrecisionRun& run = runs[i].result;
    run.repeats = static_cast<int>(seconds[i].size());
    run.seconds = median(seconds[i]);
    run.seconds_min = std::ranges::min(seconds[i]);
    run.seconds_max = std::ranges::max(seconds[i]);
  }
}

}  // namespace delf
