// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "tools/figures/thinned_rows.hpp"
#include "tools/figures/trace.hpp"
#include "tools/files/fields_file.hpp"
#include "tools/files/record.hpp"
#include "tools/files/row_names.hpp"
#include "tools/files/series_file.hpp"
#include "tools/run/run_files.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The writer of a run's recorded rows: series.csv; fields.h5, and thinned rows for figures, if the scene wants them. Or, in
/// memory, to a function.
class Recorder : public RunFiles {
 public:
  /// Opens the files; those of an earlier run, `kept`, are continued from there. Throws BadScene, and changes no file,
  /// where they do not hold that much, or other values. On a lattice:
  Recorder(const Scene&, const std::filesystem::path& folder, const std::string& resolved_scene, int winding,
           const RowNames&, const std::optional<Written>& kept = {});
  /// On any sites, at these places. There are no thinned rows.
  Recorder(const Scene&, const std::filesystem::path& folder, const std::string& resolved_scene, int winding,
           const RowNames&, std::span<const double> places, const MeshOfFile&, const std::optional<Written>& kept);
  using Seen = std::function<void(const Record&, const RecordedRow&, const RecordedDatasets&)>;
  /// Writes no file: each recorded row is given to `seen`, after those that were `kept` of an earlier run.
  Recorder(const RowNames& names, Seen seen, const Written& kept)
      : names_(names), seen_(std::move(seen)), seen_records_(kept.series.size) {}

  /// A recorded row, in all of the files. `rates`: of the fields, where they are known.
  void append(const Record&, const RecordedRow&, const RecordedDatasets&, std::span<const double> rates = {},
              std::span<const double> momenta = {});
  /// A line of series.csv alone.
  void note(const Record&);
  /// A frame of fields.h5 alone. `node_times`: where sites have times of their own.
  void put(double time, const RecordedRow&, const RecordedDatasets& = {}, std::span<const double> node_times = {});
  /// The energy of a row that is not recorded.
  void watch(double time, double energy_error);
  Written flush(bool sync) override;
  void visit(SavedState&) override;
  /// Writes all buffered rows. A failure does not prevent the other files; the first one is then thrown.
  virtual void close();

  const ThinnedRows* thinned_rows() const noexcept { return thinned_rows_ ? &*thinned_rows_ : nullptr; }
  /// The momenta of the same frames, on a point; null where none were given.
  const ThinnedRows* momenta() const noexcept { return momenta_ && momenta_->frames() > 0 ? &*momenta_ : nullptr; }
  const Trace& energy_errors() const noexcept { return energy_errors_; }
  /// The largest error of the energy over the rows that were recorded or watched.
  double largest_energy_error() const noexcept { return largest_energy_error_; }

 private:
  std::vector<double> drawn(const RecordedRow&) const;

  RowNames names_;
  std::optional<FieldsFile> fields_;
  std::optional<SeriesFile> series_;  ///< there unless rows are kept in memory; made when the rows are
  Seen seen_;
  std::uint64_t seen_records_ = 0;
  std::optional<ThinnedRows> thinned_rows_, momenta_;
  Trace energy_errors_;
  double largest_energy_error_ = 0;
};

}  // namespace delf
