// SPDX-License-Identifier: MIT
#include "schemes/states/jacobi.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace delf::initial {

// κ′² = 1 − (1 − ε)² = ε(2 − ε)
Jacobi Jacobi::from_epsilon(double epsilon) { return {1 - epsilon, std::sqrt(epsilon) * std::sqrt(2 - epsilon)}; }

Jacobi Jacobi::from_logit(double z) {
  // κ/κ′ = e^{z/2}, the larger of the two first
  const double ratio = std::exp(-std::abs(z) / 2), larger = 1 / std::sqrt(1 + ratio * ratio), smaller = ratio * larger;
  return z > 0 ? Jacobi(larger, smaller) : Jacobi(smaller, larger);
}

Jacobi Jacobi::from_angle(double alpha) { return {std::sin(alpha), std::cos(alpha)}; }

Jacobi::Jacobi(double kappa, double kappa_prime) : kappa_(kappa), kappa_prime_(kappa_prime) {
  // a₀ = 1, b₀ = κ′;   a_{n+1} = (a_n + b_n)/2,   b_{n+1} = √(a_n b_n),   c_{n+1} = (a_n − b_n)/2      DLMF 19.8(i)
  double a = 1, b = kappa_prime, c = kappa;
  while (c > std::numeric_limits<double>::epsilon() * a) {
    c = (a - b) / 2;
    const double next = (a + b) / 2;
    b = std::sqrt(a) * std::sqrt(b);
    a = next;
    b_.push_back(b);
    c_.push_back(c);
  }
  mean_ = a;
  // K = π/(2 agm(1, κ′))                                                                              DLMF 19.8.5
  K_ = std::numbers::pi / (2 * mean_);
}

double Jacobi::am(double u) const {
  // φ_N = 2^N a_N u,   φ_{n−1} = (φ_n + arcsin((c_n/a_n) sin φ_n))/2                                   DLMF 22.20(ii)
  double phi = std::ldexp(mean_ * u, static_cast<int>(c_.size()));
  for (std::size_t n = c_.size(); n-- > 0;) {
    // a_n² = b_n² + c_n²: the arcsine without the loss near its ends
    const double s = c_[n] * std::sin(phi);
    phi = (phi + std::atan2(s, std::hypot(b_[n], c_[n] * std::cos(phi)))) / 2;
  }
  return phi;
}

double Jacobi::dn(double amplitude) const { return std::hypot(kappa_prime_, kappa_ * std::cos(amplitude)); }

}  // namespace delf::initial
