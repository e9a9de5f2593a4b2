// SPDX-License-Identifier: MIT
#include "schemes/stability/highest_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "jets/one_jet.hpp"

namespace delf {

double highest_frequency(const BatchDensity& density, double constant, double q) {
  const int d = density.components(), m = density.variables();
  std::vector<double> jet(m, 0.0);
  std::fill_n(jet.begin(), d, constant);
  const std::vector<double> all = hessian_at(density, jet, 0, 0);
  const auto H = [&](int a, int b) { return all[a * m + b]; };
  enum { phi, phi_t, phi_x, phi_tt, phi_tx, phi_xx };
  double highest = 0;
  for (int a = 0; a < d; ++a) {
    const auto sum = [&](int left, int right, auto value) {
      double total = 0;
      for (int b = 0; b < d && std::max(left, right) < density.slots(); ++b)
        total += std::abs(value(H(left * d + a, right * d + b), H(right * d + a, left * d + b)));
      return total;
    };
    const auto entry = [](double x, double) { return x; };
    const double M = sum(phi_t, phi_t, entry);
    const double C = sum(phi, phi_t, [](double x, double y) { return x - y; }) + 2 * q * sum(phi_t, phi_x, entry);
    const double K =
        std::max({sum(phi, phi, entry), q * q * sum(phi_x, phi_x, entry), q * q * q * q * sum(phi_xx, phi_xx, entry)});
    // ω = (C + √(C² + 4MK))/2M, and K/C for M = 0
    const double root = std::sqrt(C * C + 4 * M * K), omega = M > 0 ? (C + root) / (2 * M) : C > 0 ? K / C : 0;
    if (std::isfinite(omega)) highest = std::max(highest, omega);
  }
  return highest;
}

}  // namespace delf
