// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// A run at the edge of what schemes are made for.
struct StressCase {
  std::string group;   ///< "fast kink"
  std::string name;    ///< "kink, v = 0.999, k gamma = 2"
  std::string scheme;  ///< as of named_schemes()
  Problem problem;
  StateRequest state;  ///< its theory, mass, lambda and components are the problem's
  std::int64_t steps = 0;
  double patience = 1;  ///< times the budget
  /// Beyond these a run that stays finite is wrong: the error in units of the largest |φ| of the solution, the energy
  /// relative to its first value, the largest |φ| relative to its first value (waves and noise only).
  double error_bound = 0.1, energy_bound = 0.1, growth_bound = std::numeric_limits<double>::infinity();
};

enum class StressVerdict {
  stable,     ///< finite, and within the bounds
  unstarted,  ///< its first rows took longer than there was time for
  wrong,      ///< finite, and out of the bounds
  diverged,   ///< delf said that a value is not finite, or |φ| has grown 10⁶-fold
  refused,    ///< delf said that it cannot
  // what must not be:
  unsolved,  ///< a step was taken for solved, and its equations are not
  silent,    ///< a row holds what is not a number, and nothing was said
  failed,    ///< something was thrown that is no answer of delf
  crashed,   ///< the process ended
  hung       ///< it had to be ended in a step that took a hundred thousand times as long as those before
};
const char* to_string(StressVerdict);
inline bool must_not_be(StressVerdict v) { return v >= StressVerdict::unsolved; }

struct StressResult {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  StressVerdict verdict = StressVerdict::stable;
  std::string reason;  ///< in words; empty if stable
  double error_linf = unknown, energy_error_max = unknown, residual_max = unknown;
  double diverged_at = unknown, cut_at = unknown;  ///< times
  std::int64_t steps = 0;                          ///< taken
  double seconds = 0;
};

/// The keys of a scene that is this stress case, `delf run` being given all of them.
std::vector<Setting> keys_of(const StressCase&);

/// Steps it here, for at most `budget` seconds and a step, and catches everything that is thrown. `report` is called
/// with what there is so far, before the first step and some fifty times on the way.
StressResult run_stress_case(const StressCase&, double budget,
                             const std::function<void(const StressResult&)>& report = {});
/// Runs the case in a process of its own, so that a crash or a hang is a verdict too. A step that outlasts the budget
/// by another budget and a second is ended, and the result is what was reported before it.
StressResult run_stress_case_apart(const StressCase&, double budget);

}  // namespace delf
