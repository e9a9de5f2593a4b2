// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>

#include "schemes/simulation.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/progress.hpp"
#include "tools/run/checkpoints.hpp"
#include "tools/run/run_files.hpp"
#include "tools/run/watched_rows.hpp"

namespace delf {

/// True if a row solves its equations, whose residual is relative to their terms; otherwise rounding or an overflow has
/// taken it, and it is no result. A residual that is not a number is that of no solution.
bool is_solution(double residual, double tolerance);

/// Steps a field through its scene, on a lattice or on a mesh, and records rows 0, every, 2·every, … and the last one,
/// whichever becomes the last. Energy and residual are measured at these and at the watched rows. Checkpoints are written
/// on the way and at the end. When a step fails, the last good row is recorded; the outcome says the rest.
class RowLoop {
 public:
  virtual ~RowLoop() = default;

  /// The first rows; or those of the run whose checkpoint this is, and how much of its files there was. Throws BadScene; a
  /// numerical failure is what run() ends with.
  std::optional<RunFiles::Written> begin(SavedState* checkpoint);
  /// Until the end, an interruption or a failure. Throws NumericalFailure, with the step, after the last good row is
  /// recorded.
  void run(RunFiles&, Checkpoints&);

 protected:
  /// The simulation is there before the first row.
  RowLoop(const Scene&, Outcome&, const Simulation&, const WatchedRows&);

  /// True if there are rows to step from.
  bool started() const { return started_; }
  std::int64_t newest() const { return newest_; }
  std::int64_t recorded() const { return recorded_; }
  /// The iterations of the newest step; 0 if it is one solve.
  int last_iterations() const { return last_iterations_; }

 private:
  void start();
  /// Saves or restores all that the rest of the run depends on; what is restored needs no start.
  void visit(SavedState&);
  virtual void make_first_rows() = 0;
  /// A row that is not checked is neither recorded nor the last.
  virtual void step(bool looked_at) = 0;
  virtual bool looks_at_all() const { return false; }
  /// A row that was made is recorded; or throws NumericalFailure, if it is no result.
  virtual void record(std::int64_t row) = 0;
  /// The newest row is measured as if it were recorded; or throws NumericalFailure, if it is no result.
  virtual void watch() = 0;
  /// Records the data of row 0 where no row was recorded before one that is no result; returns true if it can.
  virtual bool record_start() { return false; }
  virtual void visit_rows(SavedState&) = 0;
  /// The results, after the last row, however the run ends.
  virtual void finish() = 0;

  void record_and_step();
  void step_until(std::int64_t row, Progress&);
  void note_length();
  double time(std::int64_t row) const;
  void save();
  void put(std::int64_t row);
  void fail(const NumericalFailure&);
  bool is_due(std::int64_t row) const;
  void find_next_watched();
  template <class Look>
  void require_result(const Look&) const;
  bool is_over() const;
  void close();

  const Scene& scene_;
  Outcome& outcome_;
  const Simulation& simulation_;
  const WatchedRows watched_;
  RunFiles* files_ = nullptr;
  Checkpoints* checkpoints_ = nullptr;
  Due rows_due_{10};         ///< recorded rows reach the disk after so many seconds
  std::int64_t saved_ = -1;  ///< row of the last checkpoint
  std::int64_t next_watched_ = 0;
  bool started_ = false;
  std::int64_t newest_ = 0, recorded_ = -1;
  double iterations_ = 0;  ///< of all steps
  int last_iterations_ = 0;
};

}  // namespace delf
