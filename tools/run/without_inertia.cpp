// SPDX-License-Identifier: MIT
#include "tools/run/without_inertia.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "jets/simd/scratch_rows.hpp"

namespace delf {

std::string without_inertia(const BatchDensity& density, const std::vector<std::string>& fields,
                            const std::vector<double>& row) {
  const int d = density.components(), m = density.variables();
  if (d < 2 || fields.size() != at(d) || row.size() < at(d)) return {};
  const ScratchRows jet(m + 1, lanes), H(m * m, lanes);
  for (int a = 0; a <= m; ++a) std::fill_n(jet[a], lanes, a < d ? row[at(a)] : 0.0);
  density.hessian({lanes, jet.data(), 0, jet[m]}, H.data());
  Eigen::MatrixXd inertia(d, d);
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) inertia(a, b) = H[(d + a) * m + d + b][0];
  if (!inertia.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inertia);
  Eigen::Index least = 0;
  const double most = solver.eigenvalues().cwiseAbs().maxCoeff();
  constexpr double rounding = 1e-12;
  if (!(solver.eigenvalues().cwiseAbs().minCoeff(&least) <= rounding * most)) return {};
  Eigen::VectorXd direction = solver.eigenvectors().col(least);
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  direction /= direction(largest);
  std::vector<std::string> entries;
  for (const double entry : direction) entries.push_back(fmt::format("{:.4g}", std::abs(entry) < 1e-9 ? 0.0 : entry));
  return fmt::format("the density has no inertia along ({}) = ({})", fmt::join(fields, ", "), fmt::join(entries, ", "));
}

}  // namespace delf
