// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/files/rows_file.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The rows that a run starts from: those of a known state, or those of a file. Throws BadScene.
class InitialRows {
 public:
  explicit InitialRows(const Scene&);

  int winding() const;
  /// Gives a problem the slopes that its clamped walls keep: those of row 0, where no key says them.
  void keep_slopes(Problem&) const;
  /// The gain of the fields around a circle: 2π·winding + gain.
  double monodromy() const;
  StartRule rule() const;
  std::string description() const;
  /// Throws BadScene if these rows have other fields than the simulation.
  void check(const Simulation&) const;
  /// The fields of row 0, for when there is nothing else to show.
  std::vector<double> row0() const;
  void start(Simulation&) const;
  /// The state, or null if the rows come from a file.
  const State* state() const { return state_.get(); }
  /// The solution to compare with, or null.
  const State* exact() const { return state_ && state_->exact() ? state_.get() : nullptr; }

 private:
  using Writer = void (State::*)(double, const Lattice&, std::span<double>) const;
  /// A row of all components from what the state gives at their nodes; time fractions count only `with_times`.
  std::vector<double> section(const Simulation&, Writer, int row, bool with_times) const;
  std::vector<double> section(const Simulation&, int row) const;
  std::vector<double> slopes(bool left) const;
  std::vector<double> slaved_in_file(const Simulation&, int row) const;
  std::optional<double> step_in_file(int row) const;
  void read_file();
  void require_same_space() const;
  int winding_of_file() const;
  void require_closed() const;
  /// The rows have a step of their own, and the run another one: the row then starts by its values and rates.
  void take_own_step();
  /// The column of each field in the file.
  std::vector<std::size_t> columns(const Simulation&) const;
  std::vector<double> in_order(const Simulation&, const std::vector<double>& row) const;
  void require_positions(const Simulation&) const;
  std::vector<double> file_row(const Simulation&, int row) const;
  void start_by_rates(Simulation&) const;
  void start_by_own_step(Simulation&, const std::vector<std::vector<double>>& rows) const;
  /// Row 0 and the momenta there, of a file that has them.
  void start_momenta(Simulation&) const;
  std::vector<double> values(Writer, double time, const Lattice&) const;

  const Scene& scene_;
  std::unique_ptr<State> state_;  ///< one of these two
  std::unique_ptr<RowsFile> file_;
  int winding_ = 0;                 ///< of the rows in a file
  std::optional<double> own_step_;  ///< of rows in a file that start by their values and rates
};

}  // namespace delf
