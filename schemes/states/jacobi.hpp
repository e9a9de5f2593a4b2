// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

namespace delf::initial {

/// K, am and dn of one modulus κ, from κ and κ′ = √(1 − κ²) given apart, so that no digits are lost as κ → 1. (Boost
/// takes κ alone: at κ = 1 − 1e-6 that leaves ten digits of κ′, and it has no am.)
class Jacobi {
 public:
  /// κ = 1 − ε, 0 < ε < 1.
  static Jacobi from_epsilon(double epsilon);
  /// κ² = 1/(1 + e^{−z}), κ′² = 1/(1 + e^{z}): every modulus, small and nearly 1 alike, at a moderate z.
  static Jacobi from_logit(double z);
  /// κ = sin(α), κ′ = cos(α), 0 ≤ α < π/2.
  static Jacobi from_angle(double alpha);

  double modulus() const { return kappa_; }
  double complementary_modulus() const { return kappa_prime_; }
  /// K(κ), the quarter period.
  double K() const { return K_; }
  /// am(u; κ) for |u| ≤ 2K (further out it loses digits in proportion to u; add π for each 2K instead).
  double am(double u) const;
  /// dn = √(κ′² + κ² cos² am) = d am/du
  double dn(double amplitude) const;

 private:
  Jacobi(double kappa, double kappa_prime);
  double kappa_, kappa_prime_, K_;
  std::vector<double> b_, c_;  ///< of the arithmetic–geometric mean, from step 1 on
  double mean_;
};

}  // namespace delf::initial
