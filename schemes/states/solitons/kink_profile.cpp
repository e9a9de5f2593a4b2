// SPDX-License-Identifier: MIT
#include "schemes/states/solitons/kink_profile.hpp"

#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/scaled_hyperbolic.hpp"

namespace delf::initial {
namespace {

class SineGordon final : public KinkProfile {
 public:
  explicit SineGordon(double mass) : m(mass) {}
  // f = 4 atan e^{ms},   f′ = 2m sin(f/2) = 2m/cosh(ms)                         Tyranowski–Desbrun (163)
  double f(double s) const override { return 4 * std::atan(std::exp(m * s)); }
  double slope(double s) const override { return 2 * m / std::cosh(m * s); }
  double upper() const override { return 2 * std::numbers::pi; }
  bool integrable() const override { return true; }
  double tail_factor() const override { return 4; }
  double tail_rate() const override { return m; }
  std::string formula() const override { return "4 atan exp(m s), m = " + text(m); }

 private:
  double m;
};

class DoubleSineGordon final : public KinkProfile {
 public:
  DoubleSineGordon(double mass, double lambda) : m(mass), l(lambda), mu(std::sqrt(m * m + 2 * l)) {}
  // −N = 2m² sin²(f/2) + λ sin² f. With w = cot(f/2), f′ = √(−2N) is w′ = −√(m² + μ²w²), μ² = m² + 2λ, so that
  // w = −(m/μ) sinh μs and f = 2 arccot w.
  double f(double s) const override {
    const double M = std::abs(mu * s);
    return 2 * std::atan2(std::exp(-M), -(m / mu) * scaled_sinh(mu * s, M));
  }
  // f′ = −2w′/(1 + w²) = 2m cosh μs/(1 + (m/μ)² sinh² μs)
  double slope(double s) const override {
    const double M = std::abs(mu * s), w = (m / mu) * scaled_sinh(mu * s, M);
    return 2 * m * scaled_cosh(mu * s, M) * std::exp(-M) / (std::exp(-2 * M) + w * w);
  }
  double upper() const override { return 2 * std::numbers::pi; }
  double tail_factor() const override { return 4 * mu / m; }
  double tail_rate() const override { return mu; }
  std::string formula() const override {
    return "2 arccot(-(m/mu) sinh(mu s)), mu^2 = m^2 + 2 lambda, m = " + text(m) + ", lambda = " + text(l);
  }

 private:
  double m, l, mu;
};

class PhiFour final : public KinkProfile {
 public:
  explicit PhiFour(double lambda) : a(std::sqrt(lambda / 2)), l(lambda) {}
  // f′ = √(λ/2)(1 − f²),   f = tanh(√(λ/2) s)
  double f(double s) const override { return std::tanh(a * s); }
  double slope(double s) const override {
    const double c = std::cosh(a * s);
    return a / c / c;
  }
  double upper() const override { return 1; }
  double tail_factor() const override { return 2; }
  double tail_rate() const override { return 2 * a; }
  std::string formula() const override { return "tanh(sqrt(lambda/2) s), lambda = " + text(l); }

 private:
  double a, l;
};

}  // namespace

std::unique_ptr<KinkProfile> kink_profile(const StateBuild& build) {
  const double l = build.lambda();
  const std::string& theory = build.request.theory;
  if (theory == "phi4") {
    if (!(l > 0))
      throw BadInput("theory.lambda", "theory.lambda = " + text(l) +
                                          ": phi4 has its two vacua when lambda is positive; choose lambda > 0");
    return std::make_unique<PhiFour>(l);
  }
  const double m = pulse_mass(build);
  if (theory != "double-sine-gordon") return std::make_unique<SineGordon>(m);
  // below −m²/2 the vacuum at 0 splits in two
  if (!(2 * l > -m * m))
    throw BadInput("theory.lambda", "theory.lambda = " + text(l) +
                                        ": the vacuum at 0 has split, and no kink joins it to 2 pi; choose "
                                        "lambda > -mass^2/2 = " +
                                        text(-m * m / 2));
  return std::make_unique<DoubleSineGordon>(m, l);
}

}  // namespace delf::initial
