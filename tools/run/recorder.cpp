// SPDX-License-Identifier: MIT
#include "tools/run/recorder.hpp"

#include <algorithm>
#include <cmath>

#include "schemes/stepping/saved_state.hpp"

namespace delf {
namespace {

std::vector<double> positions_of(const Lattice& lattice) {
  std::vector<double> positions;
  for (int i = 0; i < lattice.sites(); ++i) positions.push_back(lattice.position(i));
  return positions;
}

}  // namespace

Recorder::Recorder(const Scene& scene, const std::filesystem::path& folder, const std::string& resolved_scene,
                   int winding, const RowNames& names, const std::optional<Written>& kept)
    : Recorder(scene, folder, resolved_scene, winding, names, positions_of(scene.problem.lattice), {}, kept) {
  if (!scene.figures) return;
  thinned_rows_.emplace(scene.problem.lattice, names.drawn().size());
  if (scene.problem.lattice.space() == Space::point)
    momenta_.emplace(scene.problem.lattice, names.of[Role::field].size());
}

Recorder::Recorder(const Scene& scene, const std::filesystem::path& folder, const std::string& resolved_scene,
                   int winding, const RowNames& names, std::span<const double> places, const MeshOfFile& mesh,
                   const std::optional<Written>& kept)
    : names_(names) {
  const std::filesystem::path series = folder / "series.csv";
  if (kept) require_part(series, kept->series);
  const std::int64_t expected = scene.every == 0 ? 1 : scene.steps / scene.every + 2;
  if (scene.fields)
    fields_.emplace(folder / "fields.h5", places, expected, resolved_scene, winding, names, mesh,
                    kept ? kept->fields : WrittenPart{});
  if (kept) series_.emplace(series, kept->series);
  else series_.emplace(series, names.further);
}

void Recorder::append(const Record& record, const RecordedRow& row, const RecordedDatasets& datasets,
                      std::span<const double> rates, std::span<const double> momenta) {
  if (seen_) seen_(record, row, datasets), ++seen_records_;
  note(record);
  put(record.time, row, datasets);
  if (thinned_rows_)
    thinned_rows_->append(record.time, drawn(row), names_.drawn_mesh() ? std::span<const double>() : rates);
  if (momenta_ && !momenta.empty()) momenta_->append(record.time, momenta);
}

void Recorder::note(const Record& record) {
  if (series_) series_->append(record);
  watch(record.time, record.energy_error);
}

void Recorder::put(double time, const RecordedRow& row, const RecordedDatasets& datasets,
                   std::span<const double> node_times) {
  if (fields_) fields_->append(time, row, datasets, node_times);
}

void Recorder::watch(double time, double energy_error) {
  if (std::isfinite(energy_error)) energy_errors_.append(time, energy_error);
  const double error = std::abs(energy_error);
  if (std::isnan(error) || error > largest_energy_error_) largest_energy_error_ = error;  // not a number stays so
}

/// The fields, and the positions of sites that move.
std::vector<double> Recorder::drawn(const RecordedRow& row) const {
  const auto& mesh = names_.mesh;
  if (!mesh || mesh->role == Role::field) return row[Role::field];
  const std::size_t fields = names_.of[Role::field].size(), step = names_.of[mesh->role].size();
  std::vector<double> all;
  for (std::size_t i = 0; i * fields < row[Role::field].size(); ++i) {
    for (std::size_t a = 0; a < fields; ++a) all.push_back(row[Role::field][i * fields + a]);
    all.push_back(row[mesh->role][i * step + mesh->index]);
  }
  return all;
}

RunFiles::Written Recorder::flush(bool sync) {
  Written written;
  written.series.size = seen_records_;
  if (fields_) written.fields = fields_->flush(sync);
  if (series_) written.series = series_->flush(sync);
  return written;
}

void Recorder::visit(SavedState& state) {
  energy_errors_.visit(state);
  state("largest energy error", largest_energy_error_);
  for (auto* frames : {&thinned_rows_, &momenta_})
    if (*frames) (*frames)->visit(state);
}

void Recorder::close() {
  for (auto* frames : {&thinned_rows_, &momenta_})
    if (*frames) (*frames)->finish();
  try {
    if (fields_) fields_->close();
  } catch (...) {
    if (series_) series_->close();
    throw;
  }
  if (series_) series_->close();
}

}  // namespace delf
