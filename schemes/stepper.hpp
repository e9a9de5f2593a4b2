// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "jets/fibre.hpp"
#include "lattice/solve_plan.hpp"
#include "schemes/lattice_system.hpp"
#include "schemes/linear_solver.hpp"
#include "schemes/row_layout.hpp"

namespace delf {

struct StepOptions {
  double tolerance = 1e-14;  ///< of the last change, relative to the largest |y| of the last three rows
  int seed_order = 8;        ///< rows that the seed of an implicit step is extrapolated from
  int max_iterations = 50;
  Fibre fibre = Fibre::real;
  double turn = 0;           ///< φ(x + L) − φ(x)
};

/// Steps a system row by row, as its plan says. Kept are the newest rows y and their increments v_j = y_j − y_{j−1}:
/// with A₊ the coefficients of the unknown row, every step solves for w = v_{n+1} − v_n,
///
///     A₊ w = −(linear part at y_n, v_n, v_{n−1}, …) − r(0) − nonlinear part,      v += w, y += v,
///
/// differences throughout, so that rounding enters at the size of the increment and not of the field.
class Stepper {
 public:
  Stepper(const LatticeSystem&, const SolvePlan&, const StepOptions&);
  ~Stepper();
  Stepper(Stepper&&) noexcept;

  int starting_rows() const;
  /// Rows 0 … starting_rows()−1, each row[i·d + a].
  void start(const std::vector<std::vector<double>>& rows);
  /// Row 0 and φ_t there; row 1 from the equation at row 0 with y₋₁ = y₁ − 2hφ_t (second order for every scheme).
  void start_centred(const std::vector<double>& row0, const std::vector<double>& velocity);

  /// Throws NoConvergence or NotFinite and then still holds the rows that it held before.
  void step();

  std::int64_t newest() const;
  std::vector<double> row(int back) const;
  /// The residual of the field equations that were solved for the newest row: max |Σ terms| / max Σ |terms| over the
  /// sites (a vacuum has no scale of its own). Costs about a step.
  double residual() const;
  int iterations() const;   ///< of the last step: evaluations of the nonlinear part; 0 if it was solved at once

  const RowLayout& layout() const;
  /// The row `back` before the newest, and v of the newest, in the layout's order with halos.
  const double* row_data(int back, int component) const;
  const double* newest_increment(int component) const;

  bool iterates() const;  ///< a step is not one solve
  std::string solver_name() const;
  bool matrix_free() const;  ///< the constant part is one number for all sites: no matrix is allocated
  std::size_t bytes() const;
  std::string memory_report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace delf
