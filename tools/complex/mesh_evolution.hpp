// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "schemes/verify/check.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/complex/mesh_summary.hpp"

namespace delf {

class Simulation;

class SavedState;

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
};

/// How a field goes on over a mesh, row after row: with all sites at once, or with cells that take their own steps between
/// rows.
class MeshEvolution {
 public:
  virtual ~MeshEvolution() = default;
  /// The first rows.
  virtual void start() = 0;
  virtual std::int64_t newest() const = 0;
  virtual double time() const = 0;       ///< of the newest row
  virtual double last_step() const = 0;  ///< between the last two rows
  /// Where steps have lengths of their own, that of the last.
  virtual std::optional<double> own_length() const { return {}; }
  /// Where the field chooses them, the shortest of those that the start tells.
  virtual std::optional<double> first_lengths() const { return {}; }
  /// Of the given values and rates, where that is not the energy of row 0 by definition; else not a number.
  virtual double energy_of_start() const { return Outcome::unknown; }
  /// To the next row; row() is for one that is checked.
  virtual void step(bool looked_at = true) = 0;
  /// Of Newton's method in the last step; 0 if it is one solve.
  virtual int iterations() const { return 0; }
  /// The newest row; or row 0 where that is held still.
  virtual MeshRow row(std::int64_t) = 0;
  /// Saves or restores what the rest of the run depends on; what is restored needs no start.
  virtual void visit(SavedState&) = 0;
  /// How it is solved, and what it costs.
  virtual void describe(Outcome&) const = 0;
};

/// Rows 0 and 1, from the scene's fields and rates.
void start(const ComplexScene&, Simulation&);

/// Of a scene whose time is rows or cells.
std::unique_ptr<MeshEvolution> make_mesh_evolution(const ComplexScene&);

}  // namespace delf
