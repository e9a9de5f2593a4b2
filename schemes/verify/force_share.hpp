// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "schemes/system/assembled_row.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"
#include "schemes/verify/equation_check.hpp"

namespace delf {

/// The largest |E| that a site has in any row, beside the largest force there.
struct SiteSeverity {
  int site = 0;
  std::string field;
  std::int64_t row = 0;  ///< of the error
  double error = 0, force = 0;
  double rounding = 0;  ///< what rounding of the values, and the solver, make of E there
  /// 0 of errors that are rounding.
  double share() const { return error <= rounding ? 0 : error / std::max(force, rounding); }
};

/// |E| of rows beside the force there: what the equations give of a row that stands still, which for N′ and D² alike is
/// E without its time differences. The terms of E grow as 1/h², and hide a wrong force; this scale does not.
///
///     F(j, i) = E(j, i) of the section that is row j in every row
///
/// Where all terms have time differences, and no row has a force, the scale is that of the terms themselves.
///
/// Rows are wrong where |E| is more than the errors of the values explain, and more than a share of the force that no
/// program computes to. Where the errors of the values are larger than the force, nothing can be said.
///
/// Errors of the values have no sign, and a wrong force has: averages over the rows see it far below the rounding of each.
///
///     c = Σ E S / Σ S²          S = F of an earlier row, whose rounding is another; or S = y_{j+1} − y_{j−1}, friction
///
/// where it has the same sign in all of 32 stretches of the rows, or is ten of its standard errors.
///
/// F changes slowly from row to row: of long files every eighth row is evaluated, in which a wave goes on by eight sites at
/// most.
class ForceShare {
 public:
  struct Precision {
    ValueError values;
    double solver = 0;  ///< the last change of an iterated step, relative to the largest value
    double asked = 0;   ///< |E| that was asked to be passed over, relative to its terms
  };
  /// `rows` are checked.
  ForceShare(const LatticeSystem&, std::int64_t rows, const Precision&);

  /// One row of a window that holds the rows that its equations read, which the check has checked.
  void at(const Window&, std::int64_t row, const EquationCheck&);

  /// |E| beside the force, and beside the errors of the values; nothing of fields that rest in a vacuum. Where it is
  /// `unmeasurable`, rows of any force would pass, in words.
  struct Judged {
    Check check;
    std::string unmeasurable = {};
  };
  std::optional<Judged> check() const;
  /// |c| of the signal that is followed best, beside how far c of a stretch falls below it; nothing of few rows.
  std::optional<Check> average() const;
  /// The bound by errors of the values on |E| of the row checked last, relative as EquationCheck::newest.
  double relative_bound() const { return relative_bound_; }
  /// max|E| / max|F| over all rows and sites; and the site whose share is largest, if an error is more than rounding. Of
  /// fields that rest, nothing.
  std::vector<Measured> measured() const;
  /// The severities of all sites that have an equation, and of each field there.
  std::vector<SiteSeverity> sites() const;
  /// |E| of the row that was checked last, [i·C + c]; not a number where there is no equation of a field.
  const std::vector<double>& errors() const { return errors_; }

 private:
  struct Largest {
    double error = 0, force = 0, value = 0;
    bool failed = false, seen = false;
    std::int64_t row = 0;
  };
  /// An equation of some row, and the bound of |E| by the errors of the values.
  struct Suspect {
    double error = 0, bound = 0;
    std::size_t n = 0;
    std::int64_t row = 0;
  };
  void find_forces(const Window&, std::int64_t row);
  bool find_whether_rows_have_forces();
  /// Sums of one component and one signal, over the equations of each stretch.
  struct Average {
    std::vector<double> ES, SS;
    double c() const;
    /// The least |c| that noise does not give.
    double least() const;
  };
  void add_to_averages(const Window&, std::int64_t row, const EquationCheck&);
  void suspect(const Window&, std::int64_t row, const EquationCheck&);
  bool has_force(std::size_t n) const;
  std::string where(std::size_t n, std::int64_t row) const;
  SiteSeverity severity(std::size_t n) const;

  const LatticeSystem* system_;
  AssembledRow row_;
  std::int64_t stride_, seen_ = 0;
  Precision precision_;
  double coefficients_ = 0, largest_value_ = 0;
  bool rows_have_forces_;
  double force_ = 0, terms_ = 0;  ///< max|F|, and the largest sum of the absolute values of its terms
  double relative_bound_ = 0;
  Suspect closest_, beyond_;  ///< the largest |E| / bound; the largest |E| beyond its bound
  std::int64_t rows_beyond_ = 0;
  std::size_t stretches_;
  std::int64_t rows_;
  struct Force {
    std::int64_t row;
    std::vector<double> F;
  };
  std::deque<Force> earlier_;      ///< of the rows that were evaluated last
  std::vector<Average> averages_;  ///< [component · 2 + signal]
  double forces_square_ = 0;
  double passed_over_ = 0;  ///< |E| that averages do not count
  std::int64_t forces_count_ = 0;
  std::vector<Largest> at_;  ///< [i·C + c]
  std::vector<LatticeSystem::Value> forces_;
  std::int64_t forces_of_ = -1;  ///< the row
  std::vector<double> errors_;
  std::int64_t equations_ = 0;
};

}  // namespace delf
