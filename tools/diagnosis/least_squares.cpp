// SPDX-License-Identifier: MIT
#include "tools/diagnosis/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delf {

LeastSquares least_squares(const Eigen::VectorXd& given, const std::vector<Eigen::VectorXd>& given_columns) {
  LeastSquares fit;
  // Units of the target keep squares finite, which those of values above 1e154 are not.
  const double largest = given.cwiseAbs().maxCoeff(), unit = largest > 0 ? largest : 1;
  const Eigen::VectorXd target = given / unit;
  std::vector<Eigen::VectorXd> columns = given_columns;
  for (Eigen::VectorXd& column : columns) column /= unit;
  fit.coefficients.assign(columns.size(), 0.0);
  fit.errors.assign(columns.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> used;
  for (std::size_t n = 0; n < columns.size(); ++n)
    if (columns[n].cwiseAbs().maxCoeff() > 0) used.push_back(n);
  Eigen::VectorXd rest = target;
  if (!used.empty()) {
    // Columns of length one: theirs differ by powers of h and k.
    const auto m = static_cast<Eigen::Index>(used.size());
    Eigen::MatrixXd X(target.size(), m);
    for (Eigen::Index n = 0; n < m; ++n) X.col(n) = columns[used[n]].normalized();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(X);
    const Eigen::VectorXd solution = qr.solve(target);
    rest = target - X * solution;
    // σ² (XᵀX)⁻¹, σ² = |rest|²/(equations − unknowns)
    const Eigen::MatrixXd inverse = (X.transpose() * X).inverse();
    const double variance = rest.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(target.size() - m, 1));
    for (Eigen::Index n = 0; n < m; ++n) {
      const std::size_t at = used[n];
      fit.coefficients[at] = solution[n] / columns[at].norm();
      fit.errors[at] = std::sqrt(std::abs(variance * inverse(n, n))) / columns[at].norm();
    }
  }
  fit.remains = rest.cwiseAbs().maxCoeff() * unit;
  return fit;
}

}  // namespace delf
