// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "jets/symmetry.hpp"
#include "lattice/complex/mesh.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/complex/space_tables.hpp"

namespace delf {

class SavedState;

/// A mesh of space and a density on it, with what rows of any steps have in common.
struct CellSpace {
  /// Throws BadInput for a density that has no form on cells.
  CellSpace(Mesh, std::shared_ptr<const BatchDensity>, bool fixed_boundary);

  int sites() const { return static_cast<int>(mesh.points.size()); }

  Mesh mesh;
  std::shared_ptr<const BatchDensity> density;
  SpaceTables tables;
  std::vector<double> masses;  ///< A_i
  std::vector<char> fixed;     ///< [i]: a point of the boundary that keeps its value
};

/// The sites of the mesh at some times, row after row: site i of row j has the number j·N + i. Stencils of motion join rows;
/// those of sites and cells lie in a row, and have the mean of the steps below and above it,
///
///     S = Σ_j Σ_i A_i h_j T((y_i^{j+1} − y_i^j)/h_j) + Σ_j ½(h_{j−1} + h_j) V(y^j),
///
/// where the first and the last row have half a step. Rows 0 and 1 are data, and equations hold from row 1 to the last but
/// one.
class SpaceRows {
 public:
  SpaceRows(const CellSpace&, std::span<const double> times);
  /// The mesh alone, for problems without time: S = Σ V(y), data on the fixed boundary.
  explicit SpaceRows(const CellSpace&);

  const ComplexSystem& system() const { return system_; }
  int rows() const { return rows_; }
  /// The stencils that join a row and the next one.
  std::vector<std::int32_t> motion(int row) const;
  /// Of the stencils in a row.
  void set_row_measure(int row, double measure) {
    system_.set_part(part_of_row_[static_cast<std::size_t>(row)], measure, 1);
  }
  /// Of the stencils that join a row and the next one.
  void set_motion(int row, double measure, double time_step) {
    system_.set_part(part_of_motion_[static_cast<std::size_t>(row)], measure, time_step);
  }

 private:
  void add_row(int part);
  void set_times(std::span<const double> times);

  const CellSpace& space_;
  ComplexSystem system_;
  int rows_ = 0;
  int site_ = 0, site_table_ = 0, motion_ = 0;
  std::vector<int> gradient_;         ///< family by number of corners
  std::vector<int> gradient_tables_;  ///< by cell
  std::vector<int> part_of_row_, part_of_motion_, first_of_motion_;
};

/// Steps a field on an irregular space, row by row, each a complex of three rows whose plan is found once.
class SpaceEvolution {
 public:
  SpaceEvolution(const CellSpace&, double time_step, ComplexSolver::Options = {});

  /// Row 0 and its rate, by the discrete Legendre transform: ∂T/∂φ_t(φ_t) A = A ∂T/∂φ_t((y¹ − y⁰)/h) − ½h ∂V/∂y⁰.
  /// The first step may have a length of its own, as any other.
  void start(std::span<const double> values, std::span<const double> rates,
             std::optional<double> time_step = std::nullopt);
  /// One step, of another length if it is given.
  void step(std::optional<double> time_step = std::nullopt);

  /// Saves or restores what further steps depend on; what is restored needs no start.
  void visit(SavedState&);

  /// Exchanges the last two rows: further steps, of the same lengths, go back.
  void turn_back();

  std::int64_t newest() const { return newest_; }
  double time() const { return time_; }
  double time_step() const { return h_; }
  /// Between the last two rows.
  double last_step() const { return before_; }
  /// The newest row, or the one `back` rows before: 0 or 1.
  std::span<const double> row(int back = 0) const;
  const ComplexPlan& plan() const { return solver_->plan(); }
  bool is_direct() const { return solver_->is_direct(); }
  const ComplexSolver::Report& report() const { return report_; }
  std::size_t bytes() const;

  /// Σ_i A_i [φ_t ∂T/∂φ_t − T] − ½[V(row) + V(row before)], at the half step between the last two rows.
  double energy() const;
  /// Σ_i A_i ∂T/∂φ_t · ξ(φ_i) between the last two rows, which natural boundaries and closed surfaces keep where ξ is a
  /// symmetry of the density: its sum, and that of its absolute terms.
  Balance momentum(const LinearSymmetry&) const;
  /// Of the equations behind the newest row: see largest_residual().
  double residual() const;
  /// The longest step that a linear wave can take, 2/ω of the fastest mode about φ = 0; none if nothing oscillates.
  std::optional<double> largest_step() const;

 private:
  void set_steps(const std::array<double, 3>& now);
  void take(double below, double above, double row_measure);

  const CellSpace& space_;
  double h_, before_, time_ = 0;
  std::int64_t newest_ = 0;
  SpaceRows rows_;
  mutable SpaceRows energy_rows_;  ///< two rows, measured for energies
  std::unique_ptr<ComplexSolver> solver_;
  std::array<double, 3> steps_{};  ///< below and above, and the row's measure, that the solver has been made for
  std::vector<double> y_;
  ComplexSolver::Report report_;
};

}  // namespace delf
