// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Dense>
#include <vector>

namespace delf {

/// target ≈ Σ_n coefficient_n column_n
struct LeastSquares {
  std::vector<double> coefficients, errors;  ///< with their standard errors
  double remains = 0;                        ///< the largest |target − sum|
};
/// Columns that are zero have the coefficient 0 and an infinite error.
LeastSquares least_squares(const Eigen::VectorXd& target, const std::vector<Eigen::VectorXd>& columns);

}  // namespace delf
