// SPDX-License-Identifier: MIT
#pragma once
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/figures/trace.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/warnings/energy_warnings.hpp"
#include "tools/warnings/step_error.hpp"
#include "tools/warnings/work_in_time.hpp"

namespace delf {

/// Finds why a run that ended well may be wrong all the same: too coarse for its state, beyond the linear limit of its
/// scheme, off its energy or its exact solution, solved at a thousand times the cost. It uses what the state, the theory
/// and the recorded rows say anyway; a step costs nothing more.
class Warnings {
 public:
  Warnings(const Scene&, const InitialRows&, const Simulation&);

  /// A recorded row of the fields, with the monitors of the method.
  void see(double time, std::span<const double> fields, std::span<const double> monitors);
  /// The fields of a row before TurnOfStep::rows, recorded or not.
  void see_early(std::span<const double> fields) { turn_.see(fields); }
  void visit(SavedState&);
  /// The work of a density that reads t, up to the last recorded row.
  const WorkInTime& work() const { return work_; }
  /// One line each, with a remedy, after the last row.
  std::vector<std::string> of(const Outcome&, const Trace& energy_errors, std::span<const double> last_row) const;

 private:
  Found narrow_pulse() const;
  Found linear_limit(const Outcome&) const;
  Found spurious_mode(std::span<const double> last_row) const;
  Found energy(const Outcome&) const;
  Found error(const Outcome&) const;
  Found ends(const Outcome&) const;
  Found driven_off_constraint(const Outcome&) const;
  Found without_solution() const;
  Found pinned(const Outcome&, std::span<const double> last_row) const;
  Found phase(const Outcome&, std::span<const double> last_row) const;
  std::vector<std::string> grown() const;
  std::vector<std::string> continued(const Outcome&) const;

  std::string finer() const;
  std::string finer_or_why_not(const Outcome&, double energy_of_start) const;
  int nodes_in_cell() const;
  double monodromy() const;
  double centre(std::span<const double> fields) const;
  double exact_centre(double time) const;

  const Scene& scene_;
  const InitialRows& initial_;
  const Simulation& simulation_;
  double width_ = std::numeric_limits<double>::infinity();  ///< of the narrowest pulse of the state
  double late_ = std::numeric_limits<double>::infinity();   ///< a pulse that still moves has moved since then
  bool has_pulse_ = false;                                  ///< of which the exact solution knows where it is
  // All below is a function of the recorded rows alone, so that a run that goes further warns as one without a break.
  struct Moment {
    double time = 0, value = 0;
  };
  std::vector<Moment> centres_;  ///< of the pulse in the recorded rows
  /// The largest value of each monitor, and the values that were 1 % larger than all of those before.
  std::vector<Moment> largest_;
  std::vector<std::vector<Moment>> rises_;
  TurnOfStep turn_;
  WorkInTime work_;
};

}  // namespace delf
