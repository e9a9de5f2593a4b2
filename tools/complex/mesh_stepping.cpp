// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_stepping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "schemes/stepping/saved_state.hpp"
#include "tools/complex/mesh_warnings.hpp"
#include "tools/run/tiny_steps.hpp"

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

// To measure a row costs some eight explicit steps.
WatchedRows watched_rows(const ComplexScene& c) {
  constexpr std::int64_t apart = 384, most_values = 1024;
  return {most_values / (c.sites() * static_cast<std::int64_t>(c.fields.size())), apart, c.scene.initial.seed};
}

}  // namespace

MeshStepping::MeshStepping(const ComplexScene& c, MeshEvolution& evolution, Outcome& outcome)
    : RowLoop(c.scene, outcome, watched_rows(c)), c_(c), evolution_(evolution), outcome_(outcome) {
  for (const LinearSymmetry& s : c.theory->symmetries())
    outcome.conserved.push_back({s.name, Outcome::unknown, Outcome::unknown, Outcome::unknown});
}

/// What the run is measured by is of row 0, recorded or not.
void MeshStepping::make_first_rows() {
  evolution_.start();
  if (const auto shortest = evolution_.first_lengths()) refuse_tiny_steps(c_.scene, *shortest, "<phi_t^2>");
  const MeshRow first = evolution_.row(0);
  outcome_.energy_initial = first.energy;
  for (std::size_t n = 0; n < first.momenta.size(); ++n)
    outcome_.conserved[n].take(first.momenta[n].sum, first.momenta[n].absolute);
}

void MeshStepping::visit_rows(SavedState& state) {
  const Checksum mesh = checksum_of(c_);
  Checksum saved = mesh;
  state("mesh", saved);
  if (saved != mesh)
    throw c_.scene.settings.error("lattice.mesh",
                                  "is another mesh than the run began with; put that back, or begin anew");
  evolution_.visit(state);
  state("largest energy error", outcome_.energy_error_max);
}

void MeshStepping::run(MeshRecorder& recorder, Checkpoints& checkpoints) {
  recorder_ = &recorder;
  RowLoop::run(recorder, checkpoints);
}

double MeshStepping::time(std::int64_t row) const {
  if (row == 0) return 0;
  return evolution_.time() + static_cast<double>(row - evolution_.newest()) * evolution_.last_step();
}

void MeshStepping::record(std::int64_t row) {
  const MeshRow now = evolution_.row(row);
  judge(now);
  recorder_->record(now);
}

void MeshStepping::watch() {
  const MeshRow now = evolution_.row(newest());
  judge(now);
  recorder_->watch(now);
}

void MeshStepping::judge(const MeshRow& row) const {
  // of asynchronous steps there is no residual, nor of the rows that a step has left that failed
  if (c_.time == MeshTime::cells || (std::isnan(row.residual) && !outcome_.failure.empty())) return;
  if (!is_solution(row.residual, c_.scene.problem.tolerance))
    throw NoConvergence(
        fmt::format("step {}, t = {:.6g}: the residual of the field equations is {:.2g} of their terms; "
                    "reduce lattice.courant or lattice.time_step",
                    row.row, row.time, row.residual));
}

// A newest row that is not recorded is no result.
void MeshStepping::finish() {
  if (recorded() != c_.scene.last_row(newest())) return;
  const std::span<const double> last = evolution_.row(recorded()).values;
  measure_error(c_, last, outcome_.time, outcome_);
  if (started())
    std::ranges::move(warnings_of_rows(c_, outcome_, evolution_.energy_of_start(), recorder_->energy_errors(), last),
                      std::back_inserter(outcome_.warnings));
}

}  // namespace delf
