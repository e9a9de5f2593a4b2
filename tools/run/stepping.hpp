// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/methods/own_energy.hpp"
#include "tools/measure/measures.hpp"
#include "tools/run/checkpoints.hpp"
#include "tools/run/outcome.hpp"
#include "tools/run/progress.hpp"
#include "tools/run/recorder.hpp"
#include "tools/run/section.hpp"
#include "tools/run/warnings.hpp"
#include "tools/scene/initial_rows.hpp"

namespace delf {

/// "2", or how many of the requested threads share a step, and why not more; empty if one is requested.
std::string threads_in_words(const Simulation&, int asked);

/// Steps a simulation through its scene, and records: rows 0, every, 2·every, … and the last one, whichever becomes the
/// last. The outcome receives the cost and the results, also when steps fail.
class Stepping {
 public:
  /// `own`: the energy of the scheme's own rows, if it has one: the last of names.further and of the conserved sums.
  Stepping(const Scene&, const InitialRows&, Simulation&, const RowNames&, const std::optional<OwnEnergy>& own,
           Outcome&);

  /// Gives the simulation its first rows. Throws BadScene; a numerical failure is reported by run().
  void start();
  /// Saves or restores all that the rest of the run depends on; what is restored needs no start.
  void visit(SavedState&);
  /// Until the end, or an interruption, with checkpoints on the way and at the end. Throws NumericalFailure, with the step, after recording the last good row.
  void run(Recorder&, Checkpoints&);
  /// The points of output.section; null without it.
  const Section* section() const { return section_ ? &*section_ : nullptr; }
  /// The fields of the last row.
  const std::vector<double>& last_row() const { return row_[Role::field]; }

 private:
  void record_and_step();
  void step_until(std::int64_t row, Progress&);
  void count_step();
  void note_length();
  void save();
  void record(std::int64_t row);
  void judge(double residual) const;
  bool varies() const;
  void measure(const Record&, int back);
  void fail(const NumericalFailure&);
  bool to_be_recorded(std::int64_t row) const;
  bool is_over() const;
  void close_outcome();
  void measure_error();
  std::vector<double> phase_point(int back) const;
  void monitor(const Simulation::Monitors&, Record&);
  Simulation::Monitors monitors() const;

  const Scene& scene_;
  const InitialRows& initial_;
  Simulation& simulation_;
  Outcome& outcome_;
  Recorder* recorder_ = nullptr;
  Checkpoints* checkpoints_ = nullptr;
  Due rows_due_{10};         ///< recorded rows reach the disk after so many seconds
  std::int64_t saved_ = -1;  ///< row of the last checkpoint
  const RowNames& names_;
  const std::optional<OwnEnergy>& own_energy_;
  Warnings warnings_;
  Measures measures_;
  RecordedRow row_;
  RecordedDatasets datasets_;
  std::optional<Section> section_;
  bool started_ = false;
  std::int64_t newest_ = 0, recorded_ = -1;
  double iterations_ = 0;
  int last_iterations_ = 0;
};

}  // namespace delf
