// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/problem.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

class Evolution;
class SavedState;
class FieldTheory;
struct RowDensity;

/// A scheme on a lattice, stepping. Rows are in the order of sites, row[i·C + c], values as they are (not reduced modulo
/// 2π). Of the C components the first are the fields at the vertices; nodes inside cells and multipliers follow.
class Simulation {
 public:
  /// Throws BadInput for what cannot be built or planned. Allocates everything that steps need.
  explicit Simulation(const Problem&);
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  const std::vector<Component>& components() const;
  int count(Role) const;  ///< components of this role

  // The objects of checks: the equations with their plan and rows, the theory, and the scheme's symmetries of it.
  const Evolution& evolution() const;
  const FieldTheory& theory() const;
  const std::vector<LinearSymmetry>& symmetries() const;

  /// The number of rows that a start needs: 2 for every scheme of Marsden–Patrick–Shkoller.
  int starting_rows() const;
  /// Rows 0, 1, …, starting_rows() − 1, of all components; the multipliers' entries are not read.
  /// `density` of the rows that a run back repeats, where steps are reversible.
  void start(const std::vector<std::vector<double>>& rows, std::optional<double> density = {});
  /// Row 0 and φ_t there: row 1 solves the field equation at row 0 with y₋₁ = y₁ − 2hφ_t.
  void start_centred(std::span<const double> row0, std::span<const double> velocity);

  /// Row 0 and φ_t there, of all components (at a = 0 of their cells' time): row 1 by the discrete Legendre transform of
  /// an element scheme. Throws BadInput for other schemes.
  void start_legendre(std::span<const double> row0, std::span<const double> velocity);

  /// Starts from the momenta at row 0 themselves, of all components [i·C + c]; those of multipliers and inner nodes are
  /// not read. For schemes that start_legendre() is for. `density` of the rows that a run back repeats, where steps are
  /// reversible.
  void start_momenta(std::span<const double> row0, std::span<const double> momenta,
                     std::optional<double> density = {});

  /// One step. Throws NoConvergence or NotFinite; the rows held are then still the last good ones. Throws
  /// std::logic_error before a start.
  /// A row that is not to be `looked_at` costs an explicit step, or one through long rows, less memory traffic: the row
  /// before it is written over, and residual() and monitors() are not to be had.
  void step(bool looked_at = true);
  /// One step of this length, where steps are reversible: it leaves their density alone.
  void step_by(double time_step);
  /// Takes `count` steps as step(false) does, for less where rows outgrow the cache.
  void steps(int count);

  /// Saves or restores all that the next steps depend on: they have the same bits then. What is restored was made for
  /// the same problem, and needs no start.
  void visit(SavedState&);

  /// Index of the newest row.
  std::int64_t newest() const;
  /// t of the newest rows, and beyond them as if the last step went on.
  double time(std::int64_t row) const;
  /// The density ρ of the last reversible step, and that of the newest row (schemes/stepping/step_density.hpp).
  std::optional<double> step_density() const;
  RowDensity row_density() const;
  /// The components of one role of the row `back` rows before the newest, back < starting_rows(): out[i·count + a].
  /// Multipliers and inner nodes are those that were found together with the row.
  void copy_row(int back, std::span<double> out, Role = Role::field) const;
  /// The fields that a run records at that row: as copy_row() gives them, or, where rows are those of a kernel, with
  /// the processor undone.
  void observe(int back, std::span<double> out) const;
  /// Rows are those of a kernel. The checks and the form formula are for these.
  bool is_processed() const;
  /// The momenta at the row `back` rows before the newest, of all components, [i·C + c]: the half of the field equation
  /// there (schemes/system/momenta.hpp). Throws BadInput for a scheme without a Lagrangian.
  std::vector<double> momenta(int back = 0) const;

  /// The data sets that the method declares for fields.h5 (schemes/methods/method_registry.hpp).
  struct DatasetInfo {
    std::string name, meaning;
    std::vector<std::string> components;  ///< names of the values at a site
  };
  std::vector<DatasetInfo> datasets() const;
  /// Dataset `which` of the row `back` rows before the newest, [i · components + a].
  std::vector<double> dataset(std::size_t which, int back = 0) const;

  /// k Σ (φ_t ∂ℓ/∂φ_t − ℓ) and −k Σ φ_x ∂ℓ/∂φ_t over the symmetric rectangle's jets of the last two rows; not a
  /// number where the sites move.
  struct Monitors {
    double energy, momentum, charge;
    double constraint = 0;              ///< max |G| over the constraints that the last step solved
    std::vector<double> conserved;      ///< of conserved_names(): Noether's sums over a cut between two rows
    std::vector<double> conserved_scale;  ///< the sums of the absolute values of their terms
    std::vector<double> of_method;        ///< of monitor_names()
  };
  Monitors monitors() const;
  /// Noether's conserved quantities of the symmetries that the theory declares (5.7).
  const std::vector<std::string>& conserved_names() const;
  /// The monitors that the method declares.
  std::vector<std::string> monitor_names() const;

  int iterations() const;        ///< of the last step; 0 when it was explicit
  double residual() const;       ///< of the last step's equations, relative to the sum of absolute values
  const char* solve_kind() const;      ///< explicit, chain, cyclic-band or sparse
  std::string solve_summary() const;   ///< the plan in words, one line
  std::string plan_report() const;     ///< what `delf plan` prints
  /// Allocated now for rows, matrices, work space, and monitors once they are asked for.
  std::size_t bytes() const;
  /// The questions asked of rows while a run goes on: monitors() and residual().
  struct Looks {
    bool monitors = true, residual = true;
  };
  /// The value of bytes() at the end of a run that starts, takes some twenty steps or more, and asks this of its rows.
  /// Memory that depends on the data is not foreseen: the sparse LU of a slab that nothing else solves, and full Newton
  /// steps, which keep nothing.
  std::size_t bytes_of_run(Looks) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace delf
