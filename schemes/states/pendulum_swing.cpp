// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/jacobi.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// A pendulum let go at the angle A: sin(q/2) = k sn(K + mt; k), k = sin(A/2). With the quarter period taken out,
/// u = mt, sn(K + u) = cn u/dn u and dn(K + u) = k′/dn u (DLMF 22.4.3), it reads
///
///     q = 2 atan2(k cn u, k′),   q_t = −2mkk′ sn u/dn u
///
class PendulumSwing final : public State {
 public:
  PendulumSwing(double amplitude, double mass)
      : A(amplitude), m(mass), sign(A < 0 ? -1 : 1), jacobi(Jacobi::from_angle(std::abs(A) / 2)) {}

  void at(double t, double, std::span<FieldPoint> out) const override {
    const double phi = amplitude(t), k = jacobi.modulus(), k_prime = jacobi.complementary_modulus();
    out[0] = {2 * sign * std::atan2(k * std::cos(phi), k_prime),
              -2 * sign * m * k * k_prime * std::sin(phi) / jacobi.dn(phi), 0};
  }
  bool exact() const override { return true; }
  std::string description() const override {
    return "pendulum-swing: q = 2 asin(k sn(K + m t; k)), k = sin(A/2), A = " + text(A) + ", m = " + text(m) +
           ", period = " + text(4 * jacobi.K() / m);
  }

 private:
  // am(u) within one period 4K
  double amplitude(double t) const { return jacobi.am(std::remainder(m * t, 4 * jacobi.K())); }

  double A, m, sign;
  Jacobi jacobi;
};

std::unique_ptr<State> pendulum_swing(const StateBuild& build) {
  const double A = build.number("initial.amplitude"), m = build.mass();
  if (!(m > 0))
    throw BadInput("theory.mass", "theory.mass = " + text(m) + ": must be positive; choose theory.mass > 0");
  if (!(std::abs(A) < std::numbers::pi))
    throw BadInput("initial.amplitude", "initial.amplitude = " + text(A) +
                                            ": a pendulum let go turns back before the top; choose |amplitude| < pi");
  return std::make_unique<PendulumSwing>(A, m);
}

}  // namespace
}  // namespace initial

extern const StateEntry pendulum_swing_state;
const StateEntry pendulum_swing_state{.name = "pendulum-swing",
                                      .formula = "2 asin(k sn(K + m t; k)), k = sin(A/2)",
                                      .parameters = {initial::amplitude_parameter(2)},
                                      .exact = {"pendulum"},
                                      .approximate = {},
                                      .place = Place::point,
                                      .build = initial::pendulum_swing,
                                      .sources = {"dlmf"}};

}  // namespace delf
