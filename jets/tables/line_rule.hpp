// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace delf {

/// A quadrature rule: points and weights on [0, 1], the points ascending; Σ w = 1.
struct LineRule {
  std::vector<double> points, weights;
  int size() const { return static_cast<int>(points.size()); }
};

// Rules of n points. A rule is exact on polynomials up to the degree given here, and on none of the next.

/// The zeros of P_n: degree 2n − 1.
LineRule gauss_rule(int n);
/// 0, the zeros of P′_{n−1}, and 1, n ≥ 2: degree 2n − 3.
LineRule lobatto_rule(int n);
/// The left end, 0, and the other zeros of P_{n−1} + P_n: degree 2n − 2.
LineRule radau_rule(int n);
/// The extrema of the Chebyshev polynomial of degree n − 1, n ≥ 2, both ends with them: degree n − 1, for odd n degree n.
LineRule clenshaw_curtis_rule(int n);
/// The zeros of the Chebyshev polynomial of degree n, without the ends (Fejér's first rule): degree n − 1, for odd n
/// degree n.
LineRule fejer_rule(int n);

/// The rule on every span between 0, the knots and 1.
LineRule on_spans(const LineRule&, const std::vector<double>& knots);

/// A rule as a scene names it.
struct NamedLineRule {
  std::string name;
  LineRule (*make)(int n);
  int fewest;  ///< points
};
/// gauss, lobatto, radau, clenshaw-curtis, fejer.
const std::vector<NamedLineRule>& named_line_rules();

}  // namespace delf
