// SPDX-License-Identifier: MIT
#pragma once
#include "tools/scene/initial_rows.hpp"
#include "tools/run/outcome.hpp"
#include "tools/run/progress.hpp"
#include "tools/run/recorder.hpp"

namespace delf {

/// "2", or how many of the threads that are asked for share a step, and why not more; empty if one is asked for.
std::string threads_in_words(const Simulation&, int asked);

/// Steps a simulation through its scene, and records: rows 0, every, 2·every, … and the last one, whichever becomes the
/// last. What the steps cost and gave is told to the outcome, also when they fail.
class Stepping {
 public:
  Stepping(const Scene&, const InitialRows&, Simulation&, const RowNames&, Outcome&);

  /// Gives the simulation its first rows. Throws BadScene; if the numerics fail, run() tells it.
  void start();
  /// Until the end, or an interruption. Throws NumericalFailure, with the step, after recording the last good row.
  void run(Recorder&);

 private:
  void record_and_step();
  void step_until(std::int64_t row, Progress&);
  void count_steps(int count);
  void record(std::int64_t row);
  void fail(const NumericalFailure&);
  bool to_be_recorded(std::int64_t row) const;
  std::int64_t next_record() const;
  void close_outcome();
  void measure_error();
  void monitor(const Simulation::Monitors&, Record&);

  const Scene& scene_;
  const InitialRows& initial_;
  Simulation& simulation_;
  Outcome& outcome_;
  Recorder* recorder_ = nullptr;
  const RowNames& names_;
  std::vector<double> row_, inner_, multiplier_;
  bool started_ = false;
  std::int64_t newest_ = 0, recorded_ = -1;
  double iterations_ = 0;
  int last_iterations_ = 0;
};

}  // namespace delf
