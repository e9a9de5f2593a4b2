// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>

#include "schemes/complex/slab_energy.hpp"
#include "tools/complex/mesh_evolution.hpp"
#include "tools/complex/mesh_figures.hpp"
#include "tools/complex/mesh_files.hpp"
#include "tools/figures/trace.hpp"
#include "tools/files/series_file.hpp"
#include "tools/run/run_files.hpp"

namespace delf {

/// Where the recorded rows of a mesh go: series.csv; fields.h5 and the film for figures, if the scene wants them; and what
/// the outcome says of energies and residuals.
class MeshRecorder final : public RunFiles {
 public:
  /// With `kept`, the files of an earlier run are gone on with from there: see Recorder.
  MeshRecorder(const ComplexScene&, const std::filesystem::path& folder, Outcome&,
               const std::optional<Written>& kept = {});

  /// Of rows of a finite complex series.csv has a line for each slab in place of the row's.
  void record(const MeshRow&, std::span<const SlabEnergy> slabs = {});
  /// A row that is measured and not recorded.
  void watch(const MeshRow&);
  Written flush(bool sync) override;
  void visit(SavedState&) override;
  void close();
  const MeshFilm& film() const { return film_; }
  const Trace& energy_errors() const { return energy_errors_; }

 private:
  void require_finite(const MeshRow&) const;
  /// Maxima of the run; returns the energy error.
  double take(const MeshRow&);
  void note(const MeshRow&);

  const ComplexScene& c_;
  Outcome& outcome_;
  MeshFilm film_;
  Trace energy_errors_;
  std::optional<SeriesFile> series_;  ///< always there
  std::optional<MeshFiles> files_;
};

}  // namespace delf
