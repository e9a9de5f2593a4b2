// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "schemes/equation_terms.hpp"
#include "schemes/linear_solver.hpp"
#include "schemes/row_kernel.hpp"
#include "schemes/row_sum.hpp"
#include "schemes/section_rows.hpp"

namespace delf {

/// The field equations of one slab, evaluated for whole rows: y_{n+1} = y_n + v_n + w is the unknown row.
class RowEquations {
 public:
  /// `history`: how many rows the equations of a slab read before the unknown one. Throws NoConvergence if the constant
  /// part of the equations is singular.
  RowEquations(const LatticeSystem&, const SolvePlan&, SectionRows&, int history);

  /// Which terms of the equations: those of rows up to n, outputs that read row n+1, and w itself.
  enum Part { known = 1, fresh = 2, unknown = 4 };

  /// Evaluates the nonlinear outputs that read row n+1, or those that do not.
  void evaluate_outputs(std::int64_t n, bool reading_unknown_row);

  /// Evaluates the outputs that read rows up to n only and that no earlier step had to evaluate.
  void evaluate_known_outputs(std::int64_t n);

  void clear();
  /// E += the given parts.
  void add(std::int64_t n, int parts) { add(n, parts, false); }
  /// Remembers E, and starts from it again.
  void keep();
  void restore();
  /// w = −A₊⁻¹ E
  void solve(std::int64_t n);

  double* w(int a) { return w_.row(a); }
  /// max |E| / max Σ |terms| over the sites, for the rows as they are (row n+1 included). Leaves nothing changed that a
  /// step reads.
  double residual(std::int64_t n);
  /// Outputs are the whole residual: w must be corrected by −A₊⁻¹E instead of set to it.
  bool correction_form() const { return equations_.correction_form; }

  const LinearSolver& solver() const { return *solver_[0]; }
  bool matrix_free() const { return !solver_[1] && solver_[0]->bytes() == 0; }
  std::size_t output_bytes() const, matrix_bytes() const, work_bytes() const;

 private:
  /// The rows out_c of one family: a ring over the anchors' rows.
  struct Outputs {
    const StencilFamily* family;
    const RowKernel* kernel;
    RowBuffer ring;
    int oldest = 0, newest = 0;         ///< anchors' rows that equations use, from n
    int first_time = 0, last_time = 0;  ///< of the pattern
    std::vector<int> absent;            ///< slots whose stencil leaves the lattice

    bool reads_unknown_row(int age) const { return age + kernel->outputs_read_until() >= 1; }
    double* row(std::int64_t anchor_row, int c);
  };

  void add(std::int64_t n, int parts, bool measure);
  void build_outputs();
  void build_solvers();
  void build_marks();
  void evaluate(Outputs&, std::int64_t anchor_row, std::int64_t oldest, std::int64_t newest);
  bool belongs(const Term&, int parts) const;
  const double* row_of(const Term&, std::int64_t n);
  void add_at_exceptional_sites(std::int64_t n, int parts, bool measure);
  int slot_beside(int site, int shift) const;

  const LatticeSystem& system_;
  SectionRows& rows_;
  const RowLayout& layout_;
  int d_, history_;
  bool bricks_;
  AssembledEquations equations_;
  std::vector<Outputs> outputs_;
  std::unique_ptr<LinearSolver> solver_[2];  ///< of even and odd unknown rows; the second only if bricks differ
  RowBuffer w_, E_, kept_, absolute_, positions_, signs_;
  std::vector<double> exceptional_, kept_exceptional_;  ///< E at exceptional sites: passes over rows overwrite it there
  RowSum sum_;
  std::vector<const double*> slab_rows_, solver_in_;
  std::vector<double*> slab_out_, solver_out_;
};

}  // namespace delf
