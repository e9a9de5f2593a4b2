// SPDX-License-Identifier: MIT
#include "tools/bench/pairing.hpp"

#include <algorithm>
#include <chrono>

namespace delf::bench {

namespace {

constexpr double chunk_seconds = 0.03;
constexpr long warming_steps = 16;  // predictors have reached their order, caches and pages are warm

double seconds(const Side& side, long steps) {
  const auto begin = std::chrono::steady_clock::now();
  side.advance(steps);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double ns_per_step(const Side& side, long steps) {
  side.restart();
  side.advance(warming_steps);
  return 1e9 * seconds(side, steps) / static_cast<double>(steps);
}

long steps_of_a_chunk(const Side& side) {
  side.restart();
  side.advance(warming_steps);
  for (long steps = 1;; steps *= 2)
    if (const double taken = seconds(side, steps); taken >= chunk_seconds / 2)
      return std::max(1L, static_cast<long>(static_cast<double>(steps) * chunk_seconds / taken) + 1);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

Pairing pair(const Side& a, const Side& b, int repeats) {
  const long steps = std::max(steps_of_a_chunk(a), steps_of_a_chunk(b));
  std::vector<double> of_a, of_b, ratios;
  for (int n = 0; n < repeats; ++n) {
    if (n % 2 == 0) of_a.push_back(ns_per_step(a, steps));
    of_b.push_back(ns_per_step(b, steps));
    if (n % 2 != 0) of_a.push_back(ns_per_step(a, steps));
    ratios.push_back(of_a.back() / of_b.back());
  }
  return {spread_of(of_a).median, spread_of(of_b).median, spread_of(ratios)};
}

Spread alone(const Side& side, int repeats) { return alone(side, repeats, steps_of_a_chunk(side)); }

Spread alone(const Side& side, int repeats, long steps) {
  std::vector<double> times;
  for (int n = 0; n < repeats; ++n) times.push_back(ns_per_step(side, steps));
  return spread_of(times);
}

}  // namespace delf::bench
