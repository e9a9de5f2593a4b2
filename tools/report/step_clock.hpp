// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// The cost of steps: the time that this thread had a processor, so that other work of the machine is not counted.
/// Where run.threads share the steps, it is the time that passes.
class StepClock {
 public:
  explicit StepClock(int threads);
  /// Seconds since some moment.
  double now() const;
  /// Seconds from `from` to now, without those of reading the clock; above 0.
  double since(double from) const;

 private:
  bool of_thread_;
  double reading_;  ///< what reading it takes, measured once
};

/// "processor time" or "wall time".
const char* time_of_steps(int threads);

}  // namespace delf
