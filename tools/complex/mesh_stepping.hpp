// SPDX-License-Identifier: MIT
#pragma once
#include "tools/complex/mesh_evolution.hpp"
#include "tools/complex/mesh_recorder.hpp"
#include "tools/run/row_loop.hpp"

namespace delf {

/// The rows of a field on a mesh, as its scene wants them.
class MeshStepping final : public RowLoop {
 public:
  MeshStepping(const ComplexScene&, MeshEvolution&, Outcome&);

  void run(MeshRecorder&, Checkpoints&);

 private:
  void make_first_rows() override;
  std::int64_t newest_row() const override { return evolution_.newest(); }
  double time(std::int64_t row) const override;
  std::optional<double> own_length() const override { return evolution_.own_length(); }
  void step(bool looked_at) override { evolution_.step(looked_at); }
  int iterations() const override { return evolution_.iterations(); }
  void record(std::int64_t row) override;
  void watch() override;
  void visit_rows(SavedState&) override;
  void finish() override;

  void judge(const MeshRow&) const;

  const ComplexScene& c_;
  MeshEvolution& evolution_;
  Outcome& outcome_;
  MeshRecorder* recorder_ = nullptr;
};

}  // namespace delf
