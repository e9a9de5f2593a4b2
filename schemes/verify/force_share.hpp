// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "schemes/system/assembled_row.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

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
/// F changes slowly from row to row: of long files every eighth row is evaluated, in which a wave goes on by eight sites at
/// most.
class ForceShare {
 public:
  /// `rows` are looked at. `solver`: how far values may be from the roots of their equations, relative to the largest.
  ForceShare(const LatticeSystem&, std::int64_t rows, double solver);

  /// One row of a window that holds the rows that its equations read: E there, and |E| relative to its terms ([i·C + c];
  /// not a number where there is no equation). Fields alone are looked at.
  void at(const Window&, std::int64_t row, const std::vector<LatticeSystem::Value>& E,
          const std::vector<double>& relative, double tolerance);

  /// max|E| / max|F| over all rows and sites; and the site whose share is largest, if an error is more than rounding. Of
  /// fields that rest, nothing.
  std::vector<Measured> measured() const;
  /// Of each site that has an equation, and of each field there.
  std::vector<SiteSeverity> sites() const;
  /// |E| of the row that was looked at last, [i·C + c], as `relative` is.
  const std::vector<double>& errors() const { return errors_; }

 private:
  struct Largest {
    double error = 0, force = 0, value = 0;
    bool failed = false, seen = false;
    std::int64_t row = 0;
  };
  SiteSeverity severity(std::size_t n) const;

  const LatticeSystem* system_;
  AssembledRow row_;
  std::int64_t stride_, seen_ = 0;
  double solver_, coefficients_ = 0, largest_value_ = 0;
  std::vector<Largest> at_;  ///< [i·C + c]
  std::vector<LatticeSystem::Value> forces_;
  std::vector<double> errors_;
  std::int64_t equations_ = 0;
};

}  // namespace delf
