// SPDX-License-Identifier: MIT
#include "jets/tables/line_basis.hpp"

#include <algorithm>
#include <memory>

#include "jets/tables/line_rule.hpp"
#include "lattice/index.hpp"

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
  std::vector<double> B(n, 0.0);
  B[0] = 1;
  for (std::size_t degree = 1; degree < B.size(); ++degree)
    for (std::size_t j = degree + 1; j-- > 0;) B[j] = (1 - x) * B[j] + (j > 0 ? x * B[j - 1] : 0.0);
  return B;
}

/// B′_j = (S − 1)(B_{j−1} − B_j), of one degree less.
std::vector<double> bernstein_slopes(int S, double x) {
  const std::vector<double> lower = bernstein_values(S - 1, x);
  std::vector<double> slopes(S, 0.0);
  for (std::size_t j = 0; j < lower.size(); ++j) {
    slopes[j] -= (S - 1) * lower[j];
    slopes[j + 1] += (S - 1) * lower[j];
  }
  return slopes;
}

LineBasis lagrange_gauss(int S) { return lagrange_basis(gauss_rule(S).points); }
LineBasis lagrange_lobatto(int S) { return lagrange_basis(lobatto_rule(S).points); }
LineBasis lagrange_radau(int S) { return lagrange_basis(radau_rule(S).points); }
/// Two functions leave no room for a bubble between both ends.
LineBasis lagrange_lobatto_bubble(int S) {
  if (S == 2) return lagrange_lobatto(2);
  std::vector<double> nodes = lobatto_rule(S - 1).points;
  const auto above = nodes.begin() + S / 2;  // the middle of the two nodes, or of the middle node and the next
  nodes.insert(above, (*(above - 1) + *above) / 2);
  return lagrange_basis(std::move(nodes));
}
LineBasis lagrange_chebyshev(int S) { return lagrange_basis(clenshaw_curtis_rule(S).points); }

}  // namespace

LineBasis bernstein_basis(int S) {
  LineBasis basis{
      {}, [S](double x) { return bernstein_values(S, x); }, [S](double x) { return bernstein_slopes(S, x); }};
  // Σ_j (j/(S − 1)) B_j = x
  for (int j = 0; j < S; ++j) basis.places.push_back(static_cast<double>(j) / (S - 1));
  return basis;
}

namespace {

/// The knots t of B-splines, and their values by the recursion of de Boor and Cox.
class Spline {
 public:
  Spline(int S, int degree) : S_(S), p_(degree), t_(delf::at(S + degree + 1), 0.0) {
    const int spans = S - p_;
    for (int i = 0; i <= S; ++i) t_[i + p_] = std::min(1.0, static_cast<double>(i) / spans);
    std::fill(t_.end() - p_ - 1, t_.end(), 1.0);
  }
  std::vector<double> inner_knots() const { return {t_.begin() + p_ + 1, t_.end() - p_ - 1}; }
  /// (t_{j+1} + … + t_{j+p})/p: the field τ has these coefficients (Greville).
  std::vector<double> places() const {
    std::vector<double> places(S_, 0.0);
    for (int j = 0; j < S_; ++j)
      for (int m = 1; m <= p_; ++m) places[j] += t(j + m) / p_;
    return places;
  }
  /// N_{j,q} = (x − t_j)/(t_{j+q} − t_j) N_{j,q−1} + (t_{j+q+1} − x)/(t_{j+q+1} − t_{j+1}) N_{j+1,q−1}, from N_{j,0} = 1 on
  /// the span of x; q = p, or p − 1 for slopes. Beyond the ends the last spans go on.
  std::vector<double> values(double x, int q) const {
    std::vector<double> N(t_.size() - 1, 0.0);
    int span = p_;
    while (span + 1 < S_ && x >= t(span + 1)) ++span;
    N[span] = 1;
    for (int degree = 1; degree <= q; ++degree)
      for (int j = std::max(0, span - degree); j <= span; ++j) {
        const std::size_t at = j;
        N[at] = share(x - t(j), t(j + degree) - t(j)) * N[at] +
                share(t(j + degree + 1) - x, t(j + degree + 1) - t(j + 1)) * (at + 1 < N.size() ? N[at + 1] : 0.0);
      }
    return N;
  }
  /// N′_{j,p} = p (N_{j,p−1}/(t_{j+p} − t_j) − N_{j+1,p−1}/(t_{j+p+1} − t_{j+1}))
  std::vector<double> slopes(double x) const {
    const std::vector<double> lower = values(x, p_ - 1);
    std::vector<double> slopes(S_);
    for (int j = 0; j < S_; ++j) {
      const std::size_t at = j;
      slopes[at] = p_ * (share(lower[at], t(j + p_) - t(j)) - share(lower[at + 1], t(j + p_ + 1) - t(j + 1)));
    }
    return slopes;
  }

 private:
  double t(int j) const { return t_[j]; }
  static double share(double part, double whole) { return whole > 0 ? part / whole : 0; }  // 0/0 = 0
  int S_, p_;
  std::vector<double> t_;
};

LineBasis cubic_b_spline(int S) { return b_spline_basis(S, std::min(3, S - 1)); }

}  // namespace

LineBasis b_spline_basis(int S, int degree) {
  const auto spline = std::make_shared<const Spline>(S, degree);
  const auto values = [spline, S, degree](double x) {
    std::vector<double> N = spline->values(x, degree);
    N.resize(S);
    return N;
  };
  return {spline->places(), values, [spline](double x) { return spline->slopes(x); }, spline->inner_knots()};
}

const std::vector<NamedLineBasis>& named_line_bases() {
  static const std::vector<NamedLineBasis> bases{{"lagrange-lobatto", lagrange_lobatto},
                                                 {"lagrange-gauss", lagrange_gauss, nullptr, 1},
                                                 {"lagrange-radau", lagrange_radau, nullptr, 1},
                                                 {"lagrange-chebyshev", lagrange_chebyshev},
                                                 {"lagrange-lobatto-bubble", lagrange_lobatto_bubble},
                                                 {"bernstein", bernstein_basis},
                                                 {"b-spline", cubic_b_spline, b_spline_basis}};
  return bases;
}

}  // namespace delf
