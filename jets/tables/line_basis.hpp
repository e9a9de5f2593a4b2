// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace delf {

/// The Lagrange basis ψ_j on given nodes, and its derivative, at any point.
class LagrangeBasis {
 public:
  explicit LagrangeBasis(std::vector<double> nodes);

  /// ψ_j(x) = (b_j / (x − x_j)) / Σ_m b_m / (x − x_m)
  std::vector<double> values(double x) const;
  /// ψ′_j(x) = Σ_m ψ_m(x) ψ′_j(x_m), exact since ψ′_j has a lower degree
  std::vector<double> slopes(double x) const;

 private:
  std::vector<double> nodes_, weights_, slopes_;
};

/// S functions φ_j on [0, 1] with Σ φ_j = 1: polynomials of degree S − 1, or of a lower degree from knot to knot.
/// Coefficient j belongs to the place τ_j: the field τ has the coefficients τ_j.
struct LineBasis {
  std::vector<double> places;
  std::function<std::vector<double>(double x)> values, slopes;  ///< φ_j(x) and φ′_j(x)
  std::vector<double> knots = {};  ///< inside (0, 1), ascending: a rule goes from one to the next

  int size() const { return static_cast<int>(places.size()); }
  /// True if the first coefficient is the value at 0, and the last one that at 1: both can be shared with neighbours.
  bool has_end_nodes() const;
};

LineBasis lagrange_basis(std::vector<double> nodes);
/// B_j(x) = C(S − 1, j) x^j (1 − x)^{S−1−j}
LineBasis bernstein_basis(int S);

/// B-splines of a degree p ≤ S − 1 on S − p equal spans, each end a knot p + 1 times: p − 1 derivatives are continuous.
LineBasis b_spline_basis(int S, int degree);

/// A basis as a scene names it.
struct NamedLineBasis {
  std::string name;
  LineBasis (*make)(int S);
  /// Makes the basis of a degree that is not S − 1. Null for polynomials.
  LineBasis (*of_degree)(int S, int degree) = nullptr;
  int fewest = 2;  ///< functions
};
/// lagrange-lobatto, lagrange-gauss, lagrange-radau (0 is a node), lagrange-chebyshev (the extrema, both ends with them),
/// lagrange-lobatto-bubble (S − 1 Lobatto nodes c_i, and one between them, whose function is the bubble Π(τ − c_i) up to
/// its scale), bernstein, b-spline (of degree 3, or S − 1 if that is less).
const std::vector<NamedLineBasis>& named_line_bases();

}  // namespace delf
