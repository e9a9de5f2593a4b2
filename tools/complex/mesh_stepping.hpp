// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "tools/complex/mesh_recorder.hpp"
#include "tools/run/row_loop.hpp"

namespace delf {

/// The rows of a field on a mesh, as its scene wants them: of all sites at once, or of cells that take their own steps between
/// rows.
class MeshStepping : public RowLoop {
 public:
  void run(MeshRecorder&, Checkpoints&);
  /// Steps to the end, or until it is interrupted, and records nothing.
  MeshRow last_row();
  /// How it is solved, and what it costs.
  virtual void describe(Outcome&) const = 0;

 protected:
  MeshStepping(const ComplexScene&, Outcome&);

  const ComplexScene& c_;

 private:
  void make_first_rows() override;
  std::int64_t newest_row() const override = 0;
  double time(std::int64_t row) const override = 0;
  void step(bool looked_at) override = 0;
  void record(std::int64_t row) override;
  void watch() override;
  void visit_rows(SavedState&) override;
  void finish() override;

  /// The first rows.
  virtual void begin() = 0;
  /// The newest row; or row 0 where that is held still.
  virtual MeshRow row(std::int64_t) = 0;
  virtual void visit_fields(SavedState&) = 0;
  /// Where the field chooses the steps, the shortest of those that the start tells.
  virtual std::optional<double> first_lengths() const { return {}; }
  /// Of the given values and rates, where that is not the energy of row 0 by definition; else not a number.
  virtual double energy_of_start() const { return Outcome::unknown; }

  void judge(const MeshRow&) const;

  Outcome& outcome_;
  MeshRecorder* recorder_ = nullptr;
};

/// Of a scene whose time is rows or cells.
std::unique_ptr<MeshStepping> make_mesh_stepping(const ComplexScene&, Outcome&);

/// Rows 0 and 1, from the scene's fields and rates.
void start(const ComplexScene&, Simulation&);

/// h_K of asynchronous cells: lattice.courant times the shortest edge of each.
std::vector<double> cell_steps(const ComplexScene&);

}  // namespace delf
