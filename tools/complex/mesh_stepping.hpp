// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <vector>

#include "schemes/simulation.hpp"
#include "schemes/system/mesh_energy.hpp"
#include "schemes/system/mesh_work.hpp"
#include "tools/complex/mesh_recorder.hpp"
#include "tools/run/row_loop.hpp"

namespace delf {

class Stepper;

/// The rows of a field on a mesh, as its scene wants them.
class MeshStepping final : public RowLoop {
 public:
  /// The scene's time is rows or cells.
  MeshStepping(const ComplexScene&, Outcome&);

  void run(MeshRecorder&, Checkpoints&);
  /// Steps to the end, or until it is interrupted, and records nothing.
  MeshRow last_row();
  /// How it is solved, and what it costs.
  void describe(Outcome&) const;

 private:
  void make_first_rows() override;
  void step(bool looked_at) override;
  void record(std::int64_t row) override;
  void watch() override;
  void visit_rows(SavedState&) override;
  void finish() override;

  const Stepper& stepper() const;
  const RowTimes& steps() const;
  std::int64_t newest_row() const { return simulation_.newest(); }
  double last_step() const { return steps().step(newest_row() - 1); }
  /// The newest row; or row 0 where that is held still.
  MeshRow row(std::int64_t);
  void start_rows();
  void add_work();
  void check_angles();
  /// The energy of the given values and rates, where that is not the energy of row 0 by definition; else not a number.
  double energy_of_start() const;
  double energy_of_row(const std::vector<double>& p, double t);
  double energy_between();
  std::vector<double> momenta(int back) const;
  Balance sum(const LinearSymmetry&, const std::vector<double>& p) const;
  std::span<const double> multipliers();
  void judge(const MeshRow&) const;

  const ComplexScene& c_;
  Outcome& outcome_;
  Simulation simulation_;
  MeshEnergy energy_;
  std::optional<MeshWork> work_;   ///< of a boundary that does any
  double work_of_first_step_ = 0;  ///< at its middle
  std::vector<double> values_, before_, multipliers_;
  MeshRecorder* recorder_ = nullptr;
};

/// Rows 0 and 1, from the scene's fields and rates.
void start(const ComplexScene&, Simulation&);

}  // namespace delf
