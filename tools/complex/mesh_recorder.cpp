// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/theories/theory_on_space.hpp"
#include "tools/complex/mesh_files.hpp"
#include "tools/run/stepping.hpp"

namespace delf {
namespace {

/// The columns of recorded rows. Without multipliers, where the theory has some, they are 0.
RowNames names_of(const ComplexScene& c) {
  RowNames names;
  names.of[Role::field].clear();
  for (const auto& field : c.fields) names.of[Role::field].push_back(field.name);
  for (const Component& multiplier : multipliers_of(*c.theory)) names.of[Role::multiplier].push_back(multiplier.name);
  if (c.theory->constraint()) names.further.emplace_back("constraint");
  if (!c.is_one_problem())
    for (const LinearSymmetry& s : c.theory->symmetries()) names.further.push_back(s.name);
  if (c.boundary_works()) names.further.emplace_back(energy_less_work);
  return names;
}

MeshOfFile mesh_of_file(const ComplexScene& c, const ListedCells& cells) {
  return {c.coordinates(), cells.points, cells.corners, c.time == MeshTime::cells};
}

}  // namespace

MeshRecorder::MeshRecorder(const ComplexScene& c, const std::filesystem::path& folder, Outcome& outcome,
                           const std::optional<Written>& kept)
    : Recorder(c.scene, folder, resolved_text(c), 0, names_of(c), c.places(), mesh_of_file(c, ListedCells(c)), kept),
      c_(c),
      folder_(folder),
      outcome_(outcome),
      frames_(c) {}

void MeshRecorder::record(const MeshRow& r, std::span<const SlabEnergy> slabs) {
  require_finite(r);
  ++outcome_.records;
  if (std::isnan(outcome_.energy_initial)) outcome_.energy_initial = slabs.empty() ? r.energy : slabs.front().energy;
  if (slabs.empty()) note(r);
  MeshRow line = r;
  for (const SlabEnergy& slab : slabs) ++line.row, line.time = slab.time, line.energy = slab.energy, note(line);
  RecordedRow row;
  row[Role::field].assign(r.values.begin(), r.values.end());
  row[Role::multiplier].assign(r.multipliers.begin(), r.multipliers.end());
  if (c_.theory->constraint()) row[Role::multiplier].resize(c_.space->multipliers_of_row(), 0.0);
  put(r.time, row, {}, r.node_times);
  times_.push_back(r.time);
  if (c_.scene.figures) frames_.add(r.row, r.time, r.values);
  if (!c_.boundary_works()) outcome_.energy_error_max = largest_energy_error();
}

void MeshRecorder::watch(const MeshRow& r) {
  require_finite(r);
  Recorder::watch(r.time, take(r));
  if (!c_.boundary_works()) outcome_.energy_error_max = largest_energy_error();
}

void MeshRecorder::require_finite(const MeshRow& r) const {
  if (c_.stencils && !std::ranges::all_of(r.values, [](double y) { return std::isfinite(y); }))
    throw NotFinite("a value is not finite; use smaller data, or a finer complex");
  if (!c_.stencils && !std::isfinite(r.energy))
    throw NotFinite(
        fmt::format("row {}, t = {:.6g}: the energy is not finite; use smaller fields or steps", r.row, r.time));
}

double MeshRecorder::take(const MeshRow& r) {
  Outcome& o = outcome_;
  if (std::isfinite(r.residual)) o.residual_max = std::max(o.residual_max, r.residual);
  else if (c_.time == MeshTime::cells) o.residual_max = r.residual;  // of asynchronous steps it is not measured
  if (c_.theory->constraint() && !(r.constraint <= o.constraint_max)) o.constraint_max = r.constraint;
  for (std::size_t n = 0; n < r.momenta.size(); ++n) o.conserved[n].take(r.momenta[n].sum, r.momenta[n].absolute);
  if (!c_.boundary_works())
    return o.energy_initial == 0 ? Outcome::unknown : (r.energy - o.energy_initial) / std::abs(o.energy_initial);
  const double left = r.energy - r.work, gap = left - o.energy_initial;
  largest_gap_ = std::max(largest_gap_, std::abs(gap));
  largest_energy_ = std::max({largest_energy_, std::abs(o.energy_initial), std::abs(r.energy)});
  Conserved& kept = o.conserved.back();
  kept.take(left, 0);
  kept.error_max = o.energy_error_max = largest_gap_ == 0 ? 0 : largest_gap_ / largest_energy_;
  return gap == 0 ? 0 : gap / largest_energy_;
}

void MeshRecorder::note(const MeshRow& r) {
  outcome_.energy_final = r.energy;
  Record record{r.row, r.time, r.energy, take(r), Outcome::unknown, Outcome::unknown, r.iterations, r.residual, {}};
  if (c_.theory->constraint()) record.further.push_back(r.constraint);
  for (const Balance& momentum : r.momenta) record.further.push_back(momentum.sum);
  if (c_.boundary_works()) record.further.push_back(r.energy - r.work);
  Recorder::note(record);
}

void MeshRecorder::visit(SavedState& state) {
  Recorder::visit(state);
  state("times of frames", times_);
  frames_.visit(state);
  if (c_.boundary_works()) state("largest gap", largest_gap_), state("largest energy", largest_energy_);
}

void MeshRecorder::close() {
  Recorder::close();
  if (c_.scene.fields && has_xdmf(c_)) write_mesh_xdmf(c_, folder_, times_);
}

}  // namespace delf
