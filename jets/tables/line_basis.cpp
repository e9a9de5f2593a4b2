// SPDX-License-Identifier: MIT
#include "jets/tables/line_basis.hpp"

#include <memory>

#include "jets/tables/line_rule.hpp"

namespace delf {

LagrangeBasis::LagrangeBasis(std::vector<double> nodes)
    : nodes_(std::move(nodes)), weights_(nodes_.size(), 1.0), slopes_(nodes_.size() * nodes_.size(), 0.0) {
  const std::size_t n = nodes_.size();
  // b_j = 1 / Π_{m≠j} (x_j − x_m)
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t m = 0; m < n; ++m)
      if (m != j) weights_[j] /= nodes_[j] - nodes_[m];
  // ψ′_j(x_m) = (b_j / b_m) / (x_m − x_j), and Σ_j ψ′_j = 0
  for (std::size_t m = 0; m < n; ++m)
    for (std::size_t j = 0; j < n; ++j) {
      if (j == m) continue;
      slopes_[m * n + j] = weights_[j] / weights_[m] / (nodes_[m] - nodes_[j]);
      slopes_[m * n + m] -= slopes_[m * n + j];
    }
}

std::vector<double> LagrangeBasis::values(double x) const {
  const std::size_t n = nodes_.size();
  std::vector<double> psi(n, 0.0);
  for (std::size_t j = 0; j < n; ++j)
    if (x == nodes_[j]) {
      psi[j] = 1;
      return psi;
    }
  double sum = 0;
  for (std::size_t j = 0; j < n; ++j) sum += psi[j] = weights_[j] / (x - nodes_[j]);
  for (double& value : psi) value /= sum;
  return psi;
}

std::vector<double> LagrangeBasis::slopes(double x) const {
  const std::size_t n = nodes_.size();
  const std::vector<double> psi = values(x);
  std::vector<double> slope(n, 0.0);
  for (std::size_t m = 0; m < n; ++m)
    for (std::size_t j = 0; j < n; ++j) slope[j] += psi[m] * slopes_[m * n + j];
  return slope;
}

bool LineBasis::has_end_nodes() const {
  const auto is_unit = [](const std::vector<double>& v, std::size_t at) {
    for (std::size_t j = 0; j < v.size(); ++j)
      if (v[j] != (j == at ? 1 : 0)) return false;
    return true;
  };
  return is_unit(values(0), 0) && is_unit(values(1), places.size() - 1);
}

LineBasis lagrange_basis(std::vector<double> nodes) {
  const auto basis = std::make_shared<const LagrangeBasis>(nodes);
  return {std::move(nodes), [basis](double x) { return basis->values(x); },
          [basis](double x) { return basis->slopes(x); }};
}

namespace {

/// The n functions of degree n − 1, by de Casteljau's recursion B_j ← (1 − x) B_j + x B_{j−1}.
std::vector<double> bernstein_values(int n, double x) {
  std::vector<double> B(static_cast<std::size_t>(n), 0.0);
  B[0] = 1;
  for (std::size_t degree = 1; degree < B.size(); ++degree)
    for (std::size_t j = degree + 1; j-- > 0;) B[j] = (1 - x) * B[j] + (j > 0 ? x * B[j - 1] : 0.0);
  return B;
}

/// B′_j = (S − 1)(B_{j−1} − B_j), of one degree less.
std::vector<double> bernstein_slopes(int S, double x) {
  const std::vector<double> lower = bernstein_values(S - 1, x);
  std::vector<double> slopes(static_cast<std::size_t>(S), 0.0);
  for (std::size_t j = 0; j < lower.size(); ++j) {
    slopes[j] -= (S - 1) * lower[j];
    slopes[j + 1] += (S - 1) * lower[j];
  }
  return slopes;
}

LineBasis lagrange_gauss(int S) { return lagrange_basis(gauss_rule(S).points); }
LineBasis lagrange_lobatto(int S) { return lagrange_basis(lobatto_rule(S).points); }
LineBasis lagrange_radau(int S) { return lagrange_basis(radau_rule(S).points); }
LineBasis lagrange_chebyshev(int S) { return lagrange_basis(clenshaw_curtis_rule(S).points); }

}  // namespace

LineBasis bernstein_basis(int S) {
  LineBasis basis{
      {}, [S](double x) { return bernstein_values(S, x); }, [S](double x) { return bernstein_slopes(S, x); }};
  // Σ_j (j/(S − 1)) B_j = x
  for (int j = 0; j < S; ++j) basis.places.push_back(static_cast<double>(j) / (S - 1));
  return basis;
}

const std::vector<NamedLineBasis>& named_line_bases() {
  static const std::vector<NamedLineBasis> bases{{"lagrange-lobatto", lagrange_lobatto},
                                                 {"lagrange-gauss", lagrange_gauss},
                                                 {"lagrange-radau", lagrange_radau},
                                                 {"lagrange-chebyshev", lagrange_chebyshev},
                                                 {"bernstein", bernstein_basis}};
  return bases;
}

}  // namespace delf
