// SPDX-License-Identifier: MIT
#include "jets/tables/line_rule.hpp"

#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "lattice/index.hpp"

namespace delf {
namespace {

using std::numbers::pi;

LineRule empty_rule(int n) { return {std::vector<double>(n), std::vector<double>(n)}; }

/// 1 − Σ_{j=1}^{⌊m/2⌋} c_j cos(2jθ)/(4j² − 1), c_j = 2, but 1 for the last one if `closed` and m is even: the integral of
/// the cosine series that interpolates at θ.
double cosine_sum(int m, double theta, bool closed) {
  double sum = 1;
  for (int j = m / 2; j >= 1; --j) sum -= (closed && 2 * j == m ? 1 : 2) * std::cos(2 * j * theta) / (4.0 * j * j - 1);
  return sum;
}

}  // namespace

LineRule gauss_rule(int R) {
  const std::size_t n = R;
  LineRule rule = empty_rule(R);
  std::size_t middle = n / 2;  // of the smallest zero ≥ 0; the zeros ascend
  for (const double x : boost::math::legendre_p_zeros<double>(R)) {
    const double slope = boost::math::legendre_p_prime(R, x);
    const std::size_t high = middle++, low = n - 1 - high;
    rule.points[low] = (1 - x) / 2;
    rule.points[high] = (1 + x) / 2;
    rule.weights[low] = rule.weights[high] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

LineRule lobatto_rule(int n) {
  const int p = n - 1;
  LineRule rule = empty_rule(n);
  for (int i = 0; 2 * i <= p; ++i) {
    double x = 2 * i == p ? 0.0 : std::cos(pi * i / p);
    // Newton on (1 − x²) P′_p, whose derivative is −p(p + 1) P_p
    if (i > 0 && 2 * i < p)
      for (int iteration = 0; iteration < 10; ++iteration)
        x += (1 - x * x) * boost::math::legendre_p_prime(p, x) / (p * (p + 1) * boost::math::legendre_p(p, x));
    const double legendre = boost::math::legendre_p(p, x);
    const std::size_t low = i, high = at(p - i);
    rule.points[low] = (1 - x) / 2;
    rule.points[high] = (1 + x) / 2;
    rule.weights[low] = rule.weights[high] = 1 / (p * (p + 1) * legendre * legendre);
  }
  return rule;
}

LineRule radau_rule(int n) {
  LineRule rule = empty_rule(n);
  rule.weights[0] = 1.0 / (n * n);
  // The weights are not stationary in the points, as they are for Gauss and Lobatto: long doubles leave no rounding there.
  for (int i = 1; i < n; ++i) {
    // Newton on P_{n−1} + P_n
    long double x = -std::cos(2 * pi * i / (2 * n - 1));
    for (int iteration = 0; iteration < 10; ++iteration)
      x -= (boost::math::legendre_p(n - 1, x) + boost::math::legendre_p(n, x)) /
           (boost::math::legendre_p_prime(n - 1, x) + boost::math::legendre_p_prime(n, x));
    const long double legendre = n * boost::math::legendre_p(n - 1, x);
    rule.points[i] = static_cast<double>((1 + x) / 2);
    rule.weights[i] = static_cast<double>((1 - x) / (2 * legendre * legendre));
  }
  return rule;
}

LineRule clenshaw_curtis_rule(int n) {
  LineRule rule = empty_rule(n);
  for (int i = 0; i < n; ++i) {
    const double theta = pi * i / (n - 1);
    const double half = std::sin(theta / 2);
    rule.points[i] = half * half;  // (1 − cos θ)/2
    rule.weights[i] = (i == 0 || i == n - 1 ? 0.5 : 1.0) / (n - 1) * cosine_sum(n - 1, theta, true);
  }
  return rule;
}

LineRule fejer_rule(int n) {
  LineRule rule = empty_rule(n);
  for (int i = 0; i < n; ++i) {
    const double theta = pi * (i + 0.5) / n;
    const double half = std::sin(theta / 2);
    rule.points[i] = half * half;
    rule.weights[i] = cosine_sum(n, theta, false) / n;
  }
  return rule;
}

LineRule on_spans(const LineRule& rule, const std::vector<double>& knots) {
  if (knots.empty()) return rule;
  LineRule all;
  double from = 0;
  for (std::size_t span = 0; span <= knots.size(); ++span) {
    const double to = span < knots.size() ? knots[span] : 1.0;
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
      all.points.push_back(from + (to - from) * rule.points[i]);
      all.weights.push_back((to - from) * rule.weights[i]);
    }
    from = to;
  }
  return all;
}

const std::vector<NamedLineRule>& named_line_rules() {
  static const std::vector<NamedLineRule> rules{{"gauss", gauss_rule, 1},
                                                {"lobatto", lobatto_rule, 2},
                                                {"radau", radau_rule, 1},
                                                {"clenshaw-curtis", clenshaw_curtis_rule, 2},
                                                {"fejer", fejer_rule, 1}};
  return rules;
}

}  // namespace delf
