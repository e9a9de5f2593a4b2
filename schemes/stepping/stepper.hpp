// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/stepping/step_method.hpp"

namespace delf {

/// Steps a system as its plan says: by whole rows where every unknown of a slab lies in one row and the equations have
/// a regular constant part (RowStepper), slab by slab otherwise (SlabStepper).
class Stepper {
 public:
  /// Throws BadInput for a component that cannot be stepped.
  Stepper(const LatticeSystem&, const SolvePlan&, const StepOptions&);

  int starting_rows() const { return report_.starting_rows; }
  /// Rows 0 … starting_rows()−1, each row[i·C + c] of all C components; what is not known yet (multipliers) is not
  /// read.
  void start(const std::vector<std::vector<double>>& rows);
  /// Row 0 and φ_t there; row 1 from the equation at row 0 with y₋₁ = y₁ − 2hφ_t (second order for every scheme).
  void start_centred(const std::vector<double>& row0, const std::vector<double>& velocity);
  /// Row 0 and the momenta of its vertices: row 1 from the discrete Legendre transform p₀ = −∂L/∂y₀.
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta);
  /// Throws BadInput for a starting row that has not as many values as a row of the section.
  void require_row(std::size_t values) const;

  /// Throws NoConvergence or NotFinite and then still holds the rows that it held before; std::logic_error before a start.
  /// If the new row is not to be `looked_at`, an explicit step, or one through long rows, may write it over the old
  /// one: there is then no row before it (std::logic_error), and no residual (NaN).
  void step(bool looked_at = true) {
    require_start();
    method_->step(looked_at);
  }

  /// Takes `count` steps as step(false) does. If one of them throws, newest() is the row before.
  void steps(int count) {
    for (; count > 0; --count) step(false);
  }

  /// Saves or restores all that the next steps depend on: they have the same bits then. A stepper that is restored was
  /// made for the same equations, and needs no start.
  void visit(SavedState&);

  std::int64_t newest() const { return method_->state().newest; }
  /// The number of rows by which each component's newest known row is behind the newest row of fields.
  std::vector<int> behind() const {
    std::vector<int> rows = report_.behind;
    rows.resize(components_, 0);
    return rows;
  }
  /// The newest row, or one before it: fields at that row, multipliers and inner nodes as they were found with it.
  std::vector<double> row(int back) const { return method_->row(back); }
  /// Rows are those of a kernel: a processor makes them of φ and φ_t at the start.
  bool is_processed() const { return processed_; }
  /// The fields and, unless null, their rates [i·d + a] at the newest row or one before it, the processor undone on a copy. For
  /// is_processed() alone.
  void observe(int back, std::vector<double>& fields, std::vector<double>* rates) const {
    method_->observe(back, fields, rates);
  }
  /// The newest rows, every component at its own row: for checks.
  Window window(int rows) const { return method_->window(rows); }
  /// The residual of the field equations that were solved for the newest row: max |Σ terms| / max Σ |terms| over the
  /// sites (a vacuum has no scale of its own). Costs about a step, and the first of them rows to work in.
  double residual() const { return method_->residual(); }
  /// The momenta at the newest row, [i·C + c], of a stepper that has them itself; empty: they are halves of equations.
  std::vector<double> own_momenta() const { return method_->own_momenta(); }
  /// The time at which each site was updated last; empty: that of the newest row.
  std::span<const double> site_times() const { return method_->site_times(); }
  /// The number of updates of cells with steps of their own; 0 where all sites step together.
  std::int64_t updates() const { return method_->state().updates; }
  /// The number of newest rows that are held: less than two after a step that is not checked, or that failed then.
  int held() const { return method_->state().held; }
  /// The evaluations of the nonlinear part in the last step; 0 if it was solved at once.
  int iterations() const { return method_->state().iterations; }
  /// The reason for which the last step was solved by continuation, if it was.
  Continued continued() const { return method_->state().continued; }

  /// The layout of rows by lanes with halos; null when stepped slab by slab.
  const RowLayout* layout() const { return report_.layout; }
  /// The newest pair of rows by lanes: of each component the row before the newest, then of each the newest, and of
  /// each the increment from one to the other, all with the pack after the end.
  void newest_pair(const double** rows) const { method_->newest_pair(rows); }

  bool iterates() const { return report_.iterates; }        ///< a step is not one solve
  bool matrix_free() const { return report_.matrix_free; }  ///< one number for all sites: no matrix is allocated
  /// The stepper as it is now: its solver, its memory, and what residual() adds if that is asked for. Memory that
  /// depends on the data is not foreseen: see Simulation::bytes_of_run.
  StepReport report(bool residual) const { return method_->report(residual); }
  std::size_t bytes() const { return report(false).bytes; }

 private:
  void require_start() const {
    if (!started_) throw std::logic_error("a step needs rows to go on from: call start() first");
  }

  std::unique_ptr<StepMethod> method_;
  StepReport report_;  ///< what does not change
  std::size_t components_, row_size_;
  bool processed_, started_ = false;
};

}  // namespace delf
