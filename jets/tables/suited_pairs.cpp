// SPDX-License-Identifier: MIT
#include "jets/tables/suited_pairs.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "jets/tables/pair_element.hpp"

namespace delf {
namespace {

constexpr int points = 400, iterations = 300;

double theta_of(int j) { return std::numbers::pi * (j + 1) / points; }
double weight_of(double theta, double decay) { return std::exp(-decay * theta) / theta; }

}  // namespace

double pair_symbol(const std::vector<double>& pairs, double theta) {
  double sum = 0;
  for (std::size_t m = 1; m <= pairs.size(); ++m) {
    // 2(1 − cos mθ) = 4 sin²(mθ/2)
    const auto distance = static_cast<double>(m);
    const double sine = std::sin(0.5 * distance * theta);
    sum += pairs[m - 1] * 4 * sine * sine / (distance * distance);
  }
  return sum;
}

double weighted_defect(const std::vector<double>& pairs, double decay) {
  double worst = 0;
  for (int j = 0; j < points; ++j) {
    const double theta = theta_of(j);
    worst = std::max(worst, std::abs(pair_symbol(pairs, theta) - theta * theta) * weight_of(theta, decay));
  }
  return worst;
}

std::vector<double> suited_pairs(int p, double decay) {
  std::vector<double> best = pair_weights(p);
  if (p == 1) return best;
  double least = weighted_defect(best, decay);
  // The basis of corrections to the weights of maximal order that leave their sum: rows θ, columns m = 2 … p.
  Eigen::MatrixXd basis(points, p - 1);
  Eigen::VectorXd defect(points);
  for (int j = 0; j < points; ++j) {
    const double theta = theta_of(j), w = weight_of(theta, decay), nearest = pair_symbol({1}, theta);
    for (int m = 2; m <= p; ++m) {
      std::vector<double> one(m, 0.0);
      one.back() = 1;
      basis(j, m - 2) = w * (pair_symbol(one, theta) - nearest);
    }
    defect(j) = w * (theta * theta - pair_symbol(best, theta));
  }
  const std::vector<double> given = best;
  Eigen::VectorXd lambda = Eigen::VectorXd::Constant(points, 1.0 / points);
  for (int i = 0; i < iterations; ++i) {
    const Eigen::VectorXd root = lambda.cwiseSqrt();
    const Eigen::VectorXd change = (root.asDiagonal() * basis).colPivHouseholderQr().solve(root.asDiagonal() * defect);
    std::vector<double> pairs = given;
    for (int m = 2; m <= p; ++m) pairs[m - 1] += change(m - 2), pairs[0] -= change(m - 2);
    if (const double now = weighted_defect(pairs, decay); now < least) least = now, best = pairs;
    lambda = lambda.cwiseProduct((basis * change - defect).cwiseAbs());
    lambda /= lambda.sum();
  }
  return best;
}

}  // namespace delf
