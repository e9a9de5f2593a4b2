// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

#include "tools/complex/mesh_evolution.hpp"
#include "tools/complex/mesh_recorder.hpp"
#include "tools/run/checkpoints.hpp"
#include "tools/run/due.hpp"
#include "tools/run/progress.hpp"

namespace delf {

/// Steps a field on a mesh through its scene, and records rows 0, every, 2·every, … and the last one.
class MeshStepping {
 public:
  MeshStepping(const ComplexScene&, MeshEvolution&, MeshOutcome&);

  /// Saves or restores all that the rest of the run depends on. Throws BadScene if the mesh is another.
  void visit(SavedState&);
  /// Until the end, or an interruption, with checkpoints on the way and at the end.
  void run(MeshRecorder&, Checkpoints&);

 private:
  void step_until(std::int64_t row, Progress&);
  void save();
  void record(std::int64_t row);
  bool is_over() const;
  bool to_be_recorded(std::int64_t row) const;

  const ComplexScene& c_;
  MeshEvolution& evolution_;
  MeshOutcome& outcome_;
  MeshRecorder* recorder_ = nullptr;
  Checkpoints* checkpoints_ = nullptr;
  Due rows_due_{10};         ///< recorded rows reach the disk after so many seconds
  std::int64_t saved_ = -1;  ///< row of the last checkpoint
  bool started_ = false;
  std::int64_t recorded_ = -1;
  double iterations_ = 0;
};

}  // namespace delf
