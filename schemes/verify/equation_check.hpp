// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/assembled_row.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// The distance that values may have from those that were computed, by their format and the last digits of steps.
struct ValueError {
  /// A step rounds the sum that gives a row, and a row is rounded again when it is stored.
  double relative = 2 * std::numeric_limits<double>::epsilon();
  double absolute = 0;
  int digits = 0;  ///< significant ones of a text; 0: all
  /// The error of values whose largest is `y`.
  double of(double y) const;
};

/// The field equations (5.2) at every site where there is one, row after row: in the bulk, at natural ends, and of
/// constraints. Relative to Σ_a |∂E/∂y_a y_a| where the field is largest near the row: what is summed in the end are
/// values times coefficients, and where the field rests, or in a vacuum, the sum has no scale of its own.
class EquationCheck {
 public:
  /// Rows 0 … data_rows − 1 are data, which a run was started from: equations that read no later row were never solved,
  /// and are not asked.
  /// `values` of a format that is coarser than double precision: |E| that it explains is below the tolerance.
  EquationCheck(const LatticeSystem&, const SolvePlan&, double tolerance, int data_rows = 0,
                const std::optional<ValueError>& values = {});

  /// Rows before and after a row that its equations read.
  int reach() const { return reach_; }
  /// Looks at one row of a window that holds reach() rows before and after it.
  void at(const Window&, std::int64_t row);

  /// The residuals of the last row: |E| relative to the row, [i·C + c]; not a number where there is no equation.
  const std::vector<double>& newest() const { return newest_; }
  /// E itself, [i·C + c], whether it is an equation there or not.
  const std::vector<LatticeSystem::Value>& sums() const { return values_; }
  /// Σ_a |∂E/∂y_a| δ_a at a row and site: the bound of |E| where each value is off by δ, and E of the right values is 0.
  double error_at(const Window&, std::int64_t row, int site, int component, const ValueError&) const;
  /// Σ_a |∂E/∂y_a y_a| of that row, where the field is largest: what `newest` is relative to.
  double scale() const { return scale_; }
  std::int64_t rows() const { return rows_; }
  double tolerance() const { return tolerance_; }

  std::vector<Check> checks() const;

 private:
  enum Sort { bulk, natural_end, constraint };
  struct Seen {
    Check check;
    std::int64_t failures = 0, first_row = 0, last_row = 0;
    int first_site = 0, last_site = 0;
  };
  bool is_constraint(int component) const;
  Sort sort_of(int site, int component) const;
  /// The size of a value of a component in Σ_a |∂E/∂y_a| size(a).
  using Size = std::function<double(int component, double y)>;
  std::vector<double> sizes_at(const Window&, std::int64_t row, int site, const std::vector<int>& components,
                               const Size&) const;
  void find_sizes(const Window&, std::int64_t row);
  int largest_site(int component) const;

  const LatticeSystem* system_;
  AssembledRow row_;
  double tolerance_;
  int data_rows_;
  std::optional<ValueError> rounded_;
  int reach_ = 1;
  std::vector<char> solved_;  ///< of each site and component: there is an equation
  std::vector<Sort> sorts_;
  std::vector<int> shifts_;  ///< rows from the equation up to the slab that solves it
  std::vector<Seen> seen_;   ///< one for each sort
  std::vector<double> sizes_, newest_;
  std::vector<LatticeSystem::Value> values_;
  double scale_ = 0;
  std::int64_t rows_ = 0;
};

}  // namespace delf
