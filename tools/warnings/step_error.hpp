// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/rows/initial_rows.hpp"

namespace delf {

class SavedState;

/// The angle by which the motion of the first rows turns in a step, θ² = Σ|y₊ − 2y + y₋|²/Σ|y − y₋|²: ωh of an oscillation. A
/// scheme of order 2 loses a phase of some θ³/12 in a step.
class TurnOfStep {
 public:
  static constexpr std::int64_t rows = 64;
  void see(std::span<const double> row);
  double value() const;
  void visit(SavedState&);

 private:
  std::vector<double> last_, change_;
  double changes_ = 0, second_ = 0;
};

/// The distance of a run from one of steps half as long in time, on copies that begin where it began: the phase that a
/// step loses adds up from step to step, and no energy shows it.
struct StepError {
  double error;     ///< the largest |φ_h − φ_{h/2}| so far, over the range of the field
  double time;      ///< until when
  double at_end;    ///< the same in proportion at the end of the run; `error` where the copies go as far
};

/// Finds it from as many steps as take a few hundredths of the run's time, or of a millisecond's work in a short run.
/// Nothing where the rows tell none: they come from a file, their sites move, the field chooses the steps, or half a
/// step cannot be solved. `last_row`: of the fields, at row `steps`.
std::optional<StepError> step_error(const Scene&, const InitialRows&, const Simulation&, std::int64_t steps,
                                    std::span<const double> last_row);

}  // namespace delf
