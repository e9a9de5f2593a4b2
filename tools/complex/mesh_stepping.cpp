// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_stepping.hpp"

#include <algorithm>
#include <chrono>

#include "schemes/stepping/saved_state.hpp"
#include "tools/run/interrupt.hpp"
#include "tools/run/seconds_since.hpp"

namespace delf {
namespace {

/// Of points and cells.
Checksum checksum_of(const ComplexScene& c) {
  Checksum sum;
  sum.add(c.places());
  const auto& vertices = c.space->mesh.vertices;
  sum.add(std::vector<double>(vertices.begin(), vertices.end()));
  return sum;
}

}  // namespace

MeshStepping::MeshStepping(const ComplexScene& c, MeshEvolution& evolution, MeshOutcome& outcome)
    : c_(c), evolution_(evolution), outcome_(outcome) {
  for (const LinearSymmetry& s : c.theory->symmetries())
    outcome.conserved.push_back({s.name, Outcome::unknown, Outcome::unknown, Outcome::unknown});
}

void MeshStepping::visit(SavedState& state) {
  started_ = true;  // there are no checkpoints before
  const Checksum mesh = checksum_of(c_);
  Checksum saved = mesh;
  state("mesh", saved);
  if (saved != mesh)
    throw c_.scene.settings.error("lattice.mesh",
                                  "is another mesh than the run began with; put that back, or begin anew");
  state("recorded", recorded_), state("iterations", iterations_);
  evolution_.visit(state);
  outcome_.visit(state);
  state("largest energy error", outcome_.energy_error_max);
}

/// A checkpoint of the newest row, before this is recorded as the last one: a run that is resumed may go on from it.
void MeshStepping::save() {
  saved_ = evolution_.newest();
  if (!checkpoints_->wanted()) return;
  Recorder::Written written = recorder_->flush(true);
  checkpoints_->write(saved_, [&](SavedState& state) {
    state("written", written);
    visit(state);
    recorder_->visit(state);
  });
}

void MeshStepping::run(MeshRecorder& recorder, Checkpoints& checkpoints) {
  recorder_ = &recorder, checkpoints_ = &checkpoints;
  if (!started_) evolution_.start();
  started_ = true;
  if (is_over()) save();
  for (std::int64_t row = recorded_ + 1; row <= c_.scene.last_row(evolution_.newest()); ++row)
    if (to_be_recorded(row)) record(row);
  Progress progress(c_.scene.steps);
  while (!is_over() && !Interrupt::asked()) {
    step_until(c_.scene.next_record(evolution_.newest()), progress);
    if (is_over()) save();
    if (to_be_recorded(evolution_.newest())) record(evolution_.newest());
  }
  if (!is_over()) {
    outcome_.status = "interrupted";
    if (saved_ != evolution_.newest()) save();
  }
  if (recorded_ != c_.scene.last_row(evolution_.newest())) record(c_.scene.last_row(evolution_.newest()));
  if (evolution_.iterates() && outcome_.steps_taken > 0)
    outcome_.iterations_mean = iterations_ / static_cast<double>(outcome_.steps_taken);
  measure_error(c_, evolution_.row(recorded_).values, outcome_.time, outcome_);
}

void MeshStepping::step_until(std::int64_t row, Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  while (evolution_.newest() < row && !is_over() && !Interrupt::asked()) {
    if (checkpoints_->due(evolution_.newest())) save();
    if (rows_due_.at(evolution_.newest())) recorder_->flush(false), rows_due_.restart();
    evolution_.step();
    ++outcome_.steps_taken;
    if (evolution_.iterates()) {
      iterations_ += evolution_.iterations();
      outcome_.iterations_max = std::max(outcome_.iterations_max, evolution_.iterations());
    }
    progress.at(std::min(evolution_.newest(), c_.scene.steps));
  }
  outcome_.seconds += seconds_since(begin);
}

// Steps that the field chooses end by time, and their number is a guess.
bool MeshStepping::is_over() const { return c_.scene.is_over(evolution_.newest(), evolution_.time()); }

bool MeshStepping::to_be_recorded(std::int64_t row) const {
  return c_.scene.is_recorded(row, evolution_.newest(), evolution_.time());
}

void MeshStepping::record(std::int64_t row) {
  const MeshRow now = evolution_.row(row);
  recorder_->record(now);
  recorded_ = outcome_.steps = row, outcome_.time = now.time;
}

}  // namespace delf
