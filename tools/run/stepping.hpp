// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/methods/energies.hpp"
#include "schemes/modified_energy.hpp"
#include "schemes/system/end_work.hpp"
#include "tools/measure/measures.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/run/recorder.hpp"
#include "tools/run/row_loop.hpp"
#include "tools/run/section.hpp"
#include "tools/warnings/warnings.hpp"

namespace delf {

/// "2", or how many of the requested threads share a step, and why not more; empty if one is requested.
std::string threads_in_words(const Simulation&, int asked);

/// The energy less the work that driven ends do, and the density where it reads t: the last of names.further and of the
/// conserved sums, where there are such ends.
inline constexpr auto energy_less_work = "energy_less_work";

/// The columns of output.modified; a point has no momentum.
std::vector<std::string> names_of_modified(const Scene&);

/// The rows of a simulation, as its scene wants them.
class Stepping final : public RowLoop {
 public:
  /// `modified`: the energy, and in space the momentum, of output.modified; `own`: the energy of the scheme's own rows, if it
  /// has one. They are the last of names.further and of the conserved sums, in this order.
  Stepping(const Scene&, const InitialRows&, Simulation&, const RowNames&,
           const std::optional<ModifiedEnergy>& modified, const std::optional<OwnEnergy>& own, Outcome&);

  void run(Recorder&, Checkpoints&);
  /// The points of output.section; null without it.
  const Section* section() const { return section_ ? &*section_ : nullptr; }
  /// The fields of the last row.
  const std::vector<double>& last_row() const { return row_[Role::field]; }

 private:
  void make_first_rows() override;
  void step(bool looked_at) override;
  bool looks_at_all() const override { return section_ || (measures_.sees_steps() && simulation_.is_processed()); }
  void record(std::int64_t row) override;
  void watch() override;
  bool record_start() override;
  void visit_rows(SavedState&) override;
  void finish() override;

  double energy_error(double energy) const;  ///< relative to row 0; of driven ends less their work
  double energy_gained(double energy) const;
  void add_work();
  void take(const Simulation::Monitors&, double residual);
  void judge(const Simulation::Monitors&, double residual) const;
  void require_energy(double energy) const;
  bool varies() const;
  void see_step(int back);
  void measure(const Record&, int back);
  void measure_error();
  std::vector<double> rates(int back) const;
  void warn_of_alias();
  std::vector<double> phase_point(int back) const;
  std::vector<double> drawn_momenta(int back) const;
  void put(const Simulation::Monitors&, Record&) const;
  Simulation::Monitors monitors() const;

  const Scene& scene_;
  const InitialRows& initial_;
  Simulation& simulation_;
  Outcome& outcome_;
  Recorder* recorder_ = nullptr;
  const RowNames& names_;
  const std::optional<ModifiedEnergy>& modified_;
  const std::optional<OwnEnergy>& own_energy_;
  Warnings warnings_;
  Measures measures_;
  RecordedRow row_;
  RecordedDatasets datasets_;
  std::optional<Section> section_;
  std::optional<EndWork> work_;             ///< where an end is driven
  std::optional<WorkInTime> density_work_;  ///< there too, of all rows
  std::vector<double> seen_;                ///< a row that is not recorded
  bool starts_again_ = false;               ///< the data of row 0 are recorded after steps
};

}  // namespace delf
