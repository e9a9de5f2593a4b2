// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "schemes/complex/slab_energy.hpp"
#include "schemes/verify/check.hpp"
#include "tools/complex/mesh_figures.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/run/recorder.hpp"

namespace delf {

/// A row of a mesh, and what is said of it.
struct MeshRow {
  std::int64_t row = 0;
  double time = 0;
  std::span<const double> values;  ///< [i·d + a], until the next step
  double energy = 0;
  int iterations = 0;
  double residual = 0;
  std::span<const double> node_times = {};  ///< of asynchronous cells
  std::vector<Balance> momenta = {};        ///< of the theory's symmetries: what a cut behind the row holds
  double constraint = Outcome::unknown;     ///< the largest |G|
  /// Those found with the row: of the row before, or of a field at rest its own. Empty: none yet, or no constraint.
  std::span<const double> multipliers = {};
  double work = 0;  ///< of the boundary up to the row, where it is driven or something flows in
};

/// The recorder of a run on a mesh: its files are those of any run, with the cells in fields.h5 and fields.xdmf beside it,
/// which ParaView opens. The outcome takes the energies and residuals of the rows from it.
class MeshRecorder final : public Recorder {
 public:
  MeshRecorder(const ComplexScene&, const std::filesystem::path& folder, Outcome&,
               const std::optional<Written>& kept = {});

  /// Of rows of a finite complex series.csv has a line for each slab in place of the row's.
  void record(const MeshRow&, std::span<const SlabEnergy> slabs = {});
  /// A row that is measured and not recorded.
  void watch(const MeshRow&);
  void visit(SavedState&) override;
  void close() override;
  const MeshFilm& frames() const { return frames_; }

 private:
  void require_finite(const MeshRow&) const;
  /// Maxima of the run; returns the energy error.
  double take(const MeshRow&);
  void note(const MeshRow&);

  const ComplexScene& c_;
  std::filesystem::path folder_;
  Outcome& outcome_;
  MeshFilm frames_;
  std::vector<double> times_;  ///< of the frames of fields.h5
  /// Where the boundary works: a run may begin at rest, and its energy is nothing to compare with then.
  double largest_gap_ = 0, largest_energy_ = 0;
};

}  // namespace delf
