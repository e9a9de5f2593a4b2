// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/solvers/linear_solver.hpp"
#include "schemes/solvers/row_sum.hpp"
#include "schemes/stepping/rows/row_operations.hpp"
#include "schemes/system/equation_terms.hpp"

namespace delf {

/// The rows that steps read and make, all in the lanes' layout, in one table of pointers: terms of equations name a row by
/// its number there. A ring of rows has the newest first, `width` rows each; a step makes number 0 of each ring, and the
/// oldest takes its place for the next step. A copy of the table has pointers of its own to the same rows.
class RowTable {
 public:
  struct Ring {
    int first = 0, held = 0, width = 1;
    int row(int back, int a = 0) const { return first + back * width + a; }
  };
  /// `held` = 0: a place for a row that is elsewhere.
  Ring add(const RowLayout& layout, int held, int width = 1);
  /// The oldest row becomes number 0; or number 0 the oldest.
  void advance(const Ring& ring);
  void go_back(const Ring& ring);
  double*& operator[](int row) { return rows_[row]; }
  double* operator[](int row) const { return rows_[row]; }
  const double* const* data() const { return rows_.data(); }
  /// Points at the rows of another table, which keeps them.
  void point_as(const RowTable& other) { rows_ = other.rows_; }
  void reserve(int rows) { rows_.resize(std::max(rows_.size(), at(rows))); }

 private:
  std::vector<double*> rows_;
  std::vector<std::shared_ptr<RowBuffer>> memory_;
};

/// One source term of a family, g_c of a group, along whole rows: hk weight · g adds to the equations.
struct SourceRow {
  int family, group, component;       ///< component: which of the group's outputs
  RowTable::Ring ring;                ///< number 0 is that of the newest anchors, `newest` rows after row n
  int newest = 0, oldest = 0;         ///< anchors' rows that equations read, from n
  int lowest = 0, highest = 0;        ///< shifts at which equations read it
  bool reads_unknown = false;         ///< number 0 depends on row n + 1
  bool is_local = false;              ///< is needed at its own site, in this step alone: no row of it is kept
  int outputs = 1;                    ///< of its group; of these, this is number `component`
  int left = 0, right = 0;            ///< shifts at which it reads rows itself
  bool reads_back = false;            ///< it reads rows before n too
  int first_pack = 0, last_pack = 0;  ///< equations read it in these packs: all, or those near a wall
  int stride = 1;                     ///< of bricks, those of the row before stand elsewhere: 2
  int correction = -1;                ///< row of δ, by which the last evaluation has changed it
};

/// The field equations of one slab for whole rows. With y_{n+1} = y_n + v_n + w,
///
///     A₊ w = −(linear part at y_n, v_n, v_{n−1}, …) − r(0) − Σ hk weight · g,
///
/// A₊ constant and factored once; differences throughout, so that rounding enters at the size of the increment. All sums
/// are laid out here, once; a step evaluates them.
class RowEquations {
 public:
  /// Throws NoConvergence if the constant part of the equations is singular. Source terms are kept for so many past
  /// rows, if steps extrapolate them.
  RowEquations(const LatticeSystem&, const SolvePlan&, const RowLayout&, RowTable&, int history, int source_rows);

  const RowTable::Ring& y() const { return y_; }
  const RowTable::Ring& v() const { return v_; }
  const std::vector<SourceRow>& sources() const { return sources_; }
  bool iterates() const { return iterates_; }                                ///< some source term depends on row n + 1
  bool reads_increments_beside() const { return reads_increments_beside_; }  ///< at shifts: v needs halos
  /// The solver of the step from row n: on brick walls those from even and from odd rows may differ.
  const LinearSolver& solver(std::int64_t n) const { return solver_[1] ? *solver_[n & 1] : *solver_[0]; }
  int reach() const { return reach_; }  ///< so many sites to either side right sides read y

  /// The right side of component a, times the solver's scale, for the packs from … to, into w.
  void right_side(const RowTable&, std::int64_t n, int a, Solving, int from, int to, double* w) const;
  /// The right sides of all components, w[a], and at walls.
  void right_sides(const RowTable&, std::int64_t n, Solving, int from, int to, double* const* w) const;
  /// The right side of a component as a sum of rows, for all packs; null for bricks, whose packs take turns.
  const RowSum* right_side(int a, Solving solving) const { return bricks_ ? nullptr : &sum_of(a, 0, solving); }
  /// The prediction of number 0 of a source row's ring.
  const RowSum& prediction(const SourceRow& row, int predicted_from) const {
    return predictions_[&row - sources_.data()][predicted_from];
  }
  /// The step reads rows n and v_n alone, and the source terms at row n + 1 nothing before row n.
  bool reads_newest_alone() const;
  /// Near them the equations are others.
  bool has_walls() const { return !equations_.exceptional.empty(); }

  /// g_c of a group of a family for the packs from … to, of the anchors `back` rows before the newest: out[c], where
  /// pack v stands at layout.at(v).
  void evaluate(const RowTable&, std::int64_t n, const SourceRow& first_of_group, int back, int from, int to,
                double* const* out) const;
  /// The largest change of each source row by a change of 1 in y_{n+1} everywhere, max Σ_j W_j |∂g/∂m_j|: W_j is
  /// what the weights of row n + 1 in its quadrature value m_j sum to. With quadrature values up to `size`; and on the way
  /// from row n to row n + 1, at the row y_n + s v_n + s² (v_{n+1} − v_n).
  std::vector<double> slopes_within(double size, std::int64_t n) const;
  std::vector<double> slopes_at(const RowTable&, std::int64_t n, double s) const;
  /// max |E| / max Σ |terms| at row n + 1 as it stands, source terms evaluated there.
  double residual(RowTable, std::int64_t n);
  std::size_t residual_bytes() const;  ///< that residual() will have allocated
  std::size_t matrix_bytes() const { return solver_[0]->bytes() + (solver_[1] ? solver_[1]->bytes() : 0); }
  std::size_t work_bytes() const { return positions_.bytes() + measured_rows_.bytes(); }

 private:
  struct Inputs {
    const StencilFamily* family = nullptr;
    std::vector<RowSum> values;               ///< of number 0
    std::vector<RowSum::OneRow> single_rows;  ///< those that are one row, which need not be formed
    std::vector<double> unknown;              ///< W_j, of each value
    int outputs = 1, formed = 0;              ///< of the group; values that are formed
    double time = 0, space = 0;
  };
  /// Visits the quadrature values of the packs from … to in batches: visit(batch, the place of its first pack, packs).
  template <class Visit>
  void for_each_batch(const double* const* rows, std::int64_t anchors, const SourceRow&, int from, int to, Visit) const;
  void add_slopes(const SourceRow&, const JetBatch&, double* slopes) const;
  void build_rows(RowTable&, int source_rows);
  void find_packs(SourceRow&, bool everywhere) const;
  Inputs make_inputs(const SourceTerms::Group&, SourceRow&);
  void build_sums();
  void build_solvers();
  int known_row(const Term&) const;
  int measured_row(const Term&) const;
  const SourceRow& source_of(const Term&) const;
  int measured_count() const;
  bool brick_exists(const Term&, int equation_shift, int parity) const;
  void add_sources(RowSum&, const Term&, double coefficient, Solving) const;
  std::size_t index_of(int a, int parity) const { return at(bricks_ ? 2 * a + parity : a); }
  const RowSum& sum_of(int a, int parity, Solving solving) const {
    return (solving == Solving::correction ? correction_ : known_)[index_of(a, parity)];
  }
  double value_at(const SiteEquation&, const RowTable&, std::int64_t n, const Solving*, double* absolute) const;
  double scale_of(int a) const { return has_walls() ? 1 : solver_[0]->right_side_scale(a); }

  const LatticeSystem& system_;
  const RowLayout& layout_;
  int d_, reach_ = 0;
  bool bricks_;
  SteppedEquations equations_;
  RowTable::Ring y_, v_;
  double wall_scale_ = 0;  ///< of the equation v = 0 of a fixed wall, beside those of the bulk in one matrix
  bool iterates_ = false, reads_increments_beside_ = false;
  int measured_ = 0;  ///< in the table: w, and source terms at row n + 1, as residual() finds them
  std::vector<SourceRow> sources_;
  std::vector<Inputs> inputs_;                    ///< of each source row that is the first of its group
  int most_rows_;                                 ///< that predictions are made from
  std::vector<RowSum> known_, correction_, all_;  ///< of each component and parity
  std::vector<std::vector<RowSum>> predictions_;  ///< [source row][rows that they are made from]
  std::unique_ptr<LinearSolver> solver_[2];       ///< the second only if bricks of odd rows differ
  RowBuffer positions_, measured_rows_;
};

}  // namespace delf
