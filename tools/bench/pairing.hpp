// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <vector>

namespace delf::bench {

/// Something that can be stepped: `restart` puts it back to where it began, `advance` takes so many steps.
struct Side {
  std::function<void()> restart;
  std::function<void(long)> advance;
};

/// The middle and the range of some repetitions.
struct Spread {
  double median = 0, least = 0, most = 0;
};
Spread spread_of(std::vector<double> values);

struct Pairing {
  double a = 0, b = 0;  ///< medians: ns for each step
  Spread ratio;         ///< of a/b, repetition by repetition
};

/// A and B in turn. In every repetition both start anew, warm up, and take the same number of steps, so that they pass
/// through the same fields; a chunk lasts 30 ms or more for the faster one. The side that begins changes with every
/// repetition. A ratio is taken within its repetition, where the machine's speed is likely to be the same.
Pairing pair(const Side& a, const Side& b, int repeats);

/// One side alone: ns for each step, of so many after each restart, or as many as last 30 ms.
Spread alone(const Side& side, int repeats, long steps);
Spread alone(const Side& side, int repeats);

}  // namespace delf::bench
