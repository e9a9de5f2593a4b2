// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace delf {
namespace {

std::vector<std::string> further_columns(const ComplexScene& c) {
  std::vector<std::string> names;
  if (c.theory->constraint()) names.emplace_back("constraint");
  if (!c.is_one_problem())
    for (const LinearSymmetry& s : c.theory->symmetries()) names.push_back(s.name);
  return names;
}

}  // namespace

MeshRecorder::MeshRecorder(const ComplexScene& c, const std::filesystem::path& folder, Outcome& outcome,
                           const std::optional<Written>& kept)
    : c_(c), outcome_(outcome), film_(c) {
  const std::filesystem::path series = folder / "series.csv";
  if (kept) require_part(series, kept->series);
  const std::int64_t expected = c.scene.every > 0 ? c.scene.steps / c.scene.every + 2 : 1;
  if (c.scene.fields)
    files_.emplace(c, folder, expected, c.time == MeshTime::cells, kept ? kept->fields : WrittenPart{});
  if (kept) series_.emplace(series, kept->series);
  else series_.emplace(series, further_columns(c));
}

void MeshRecorder::record(const MeshRow& r, std::span<const SlabEnergy> slabs) {
  Outcome& o = outcome_;
  require_finite(r);
  if (c_.stencils && !std::ranges::all_of(r.values, [](double y) { return std::isfinite(y); }))
    throw NotFinite("a value is not finite; use smaller data, or a finer complex");
  ++o.records;
  if (std::isnan(o.energy_initial)) o.energy_initial = slabs.empty() ? r.energy : slabs.front().energy;
  if (slabs.empty()) note(r);
  MeshRow line = r;
  for (const SlabEnergy& slab : slabs) ++line.row, line.time = slab.time, line.energy = slab.energy, note(line);
  if (files_) files_->append(r.time, r.values, r.multipliers, r.node_times);
  if (c_.scene.figures) film_.add(r.row, r.time, r.values);
}

void MeshRecorder::watch(const MeshRow& r) {
  require_finite(r);
  take(r);
}

void MeshRecorder::require_finite(const MeshRow& r) const {
  if (c_.stencils || std::isfinite(r.energy)) return;
  throw NotFinite(
      fmt::format("row {}, t = {:.6g}: the energy is not finite; use smaller fields or steps", r.row, r.time));
}

double MeshRecorder::take(const MeshRow& r) {
  Outcome& o = outcome_;
  const double error =
      o.energy_initial == 0 ? Outcome::unknown : (r.energy - o.energy_initial) / std::abs(o.energy_initial);
  if (std::isfinite(error)) energy_errors_.append(r.time, error);
  if (!(std::abs(error) <= o.energy_error_max)) o.energy_error_max = std::abs(error);
  if (std::isfinite(r.residual)) o.residual_max = std::max(o.residual_max, r.residual);
  else if (c_.time == MeshTime::cells) o.residual_max = r.residual;  // of asynchronous steps it is not measured
  if (c_.theory->constraint() && !(r.constraint <= o.constraint_max)) o.constraint_max = r.constraint;
  for (std::size_t n = 0; n < r.momenta.size(); ++n) o.conserved[n].take(r.momenta[n].sum, r.momenta[n].absolute);
  return error;
}

void MeshRecorder::note(const MeshRow& r) {
  outcome_.energy_final = r.energy;
  const double error = take(r);
  Record record{r.row, r.time, r.energy, error, Outcome::unknown, Outcome::unknown, r.iterations, r.residual, {}};
  if (c_.theory->constraint()) record.further.push_back(r.constraint);
  for (const Balance& momentum : r.momenta) record.further.push_back(momentum.sum);
  series_->append(record);
}

RunFiles::Written MeshRecorder::flush(bool sync) {
  Written written;
  if (files_) written.fields = files_->flush(sync);
  written.series = series_->flush(sync);
  return written;
}

void MeshRecorder::visit(SavedState& state) {
  if (files_) files_->visit(state);
  energy_errors_.visit(state);
  film_.visit(state);
}

void MeshRecorder::close() {
  series_->close();
  if (files_) files_->close();
}

}  // namespace delf
