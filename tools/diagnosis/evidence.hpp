// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "schemes/simulation.hpp"
#include "schemes/system/lattice_system.hpp"
#include "tools/diagnosis/finding.hpp"

namespace delf {

/// The equations of some rows that fail, counted by row and by site.
class FailedEquations {
 public:
  /// |E| of a row relative to its terms, [i·C + c]; not a number where there is no equation (EquationCheck::newest).
  void add(std::int64_t row, const std::vector<double>& relative, int components, double tolerance);

  std::int64_t tried() const { return tried_; }
  std::int64_t failed() const { return failed_; }
  double worst() const { return worst_; }
  std::int64_t worst_row() const { return worst_row_; }
  /// Rows and sites that have a failure, ascending.
  const std::vector<std::int64_t>& rows() const { return rows_; }
  std::vector<int> sites() const;
  std::int64_t rows_tried() const { return rows_tried_; }

 private:
  std::int64_t tried_ = 0, failed_ = 0, rows_tried_ = 0, worst_row_ = 0;
  double worst_ = 0;
  std::vector<std::int64_t> rows_, of_site_;
};

/// Rows of fields whose equations are to be explained.
struct Evidence {
  Problem problem;              ///< what the scene states of them
  const LatticeSystem& system;  ///< the equations that were tried; fields at the vertices and nothing else
  double monodromy = 0;         ///< what the field gains around the circle
  double tolerance = 1e-13;     ///< of equations, relative to their terms
  std::int64_t rows = 0;
  std::function<std::vector<double>(std::int64_t)> row;  ///< row j: [i·C + c]
  FailedEquations failed = {};
  std::function<std::vector<double>(std::int64_t)> momenta = {};  ///< of the same shape, if the file has them
};

}  // namespace delf
