// SPDX-License-Identifier: MIT
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/pulse.hpp"
#include "schemes/states/scaled_hyperbolic.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// Sine-Gordon's bound pair, η = √(m² − ω²), carried along by a boost:
///
///     φ = 4 atan( η cos(ωt′)/(ω cosh(ηx′)) ),   t′ = γ(t − v(x − x₀)),   x′ = γ(x − x₀ − vt)
///
class Breather final : public Pulse {
 public:
  Breather(const StateBuild& build, const PulseFrame& frame, double mass, double frequency)
      : Pulse(build, frame),
        x0(frame.position),
        v(frame.speed),
        gamma(lorentz_factor(v)),
        m(mass),
        omega(frequency),
        eta(std::sqrt((m - omega) * (m + omega))) {}

 protected:
  FieldPoint pulse(double t, double s) const override {
    // t′ = t/γ − γvs and x′ = γs, since x − x₀ = s + vt
    const double phase = omega * (t / gamma - gamma * v * s), b = eta * gamma * s, M = std::abs(b);
    // tan(φ/4) = F/G,   φ_t = 4(F_t G − F G_t)/(F² + G²), φ_x likewise, all times e^{−M}
    const double F = eta * std::cos(phase) * std::exp(-M), F_t = -eta * omega * gamma * std::sin(phase) * std::exp(-M);
    const double G = omega * scaled_cosh(b, M), G_t = -omega * eta * gamma * v * scaled_sinh(b, M);
    const double F_x = -v * F_t, G_x = omega * eta * gamma * scaled_sinh(b, M), r = std::hypot(F, G);
    const auto slope = [&](double dF, double dG) { return 4 * ((dF / r) * (G / r) - (F / r) * (dG / r)); };
    return {4 * std::atan2(F, G), slope(F_t, G_t), slope(F_x, G_x)};
  }
  std::string formula() const override {
    return "breather: phi = 4 atan(eta cos(omega t')/(omega cosh(eta x'))), omega = " + text(omega) +
           ", eta = " + text(eta) + ", m = " + text(m) + ", x0 = " + text(x0) + ", v = " + text(v);
  }

 private:
  double x0, v, gamma, m, omega, eta;
};

std::unique_ptr<State> breather(const StateBuild& build) {
  const double m = pulse_mass(build), v = subluminal(build, "breather");
  const double omega = build.number("initial.frequency", 0.6 * m);
  if (!(omega > 0 && omega < m))
    throw BadInput("initial.frequency", "initial.frequency = " + text(omega) +
                                            ": a breather beats slower than the mass; choose 0 < frequency < " +
                                            text(m));
  const double x0 = centre(build), eta = std::sqrt((m - omega) * (m + omega));
  // φ ≈ 8(η/ω) e^{−ηγ|s|} far away
  const double until =
      build.exact ? clear_until(build.lattice, x0, v, reach(8 * eta / omega, eta * lorentz_factor(v))) : 0.0;
  return std::make_unique<Breather>(build, PulseFrame{x0, v, 0, until}, m, omega);
}

// 1/(γm): the slopes of a slow breather are those of kinks, and the tails of a fast one longer.
double breather_width(const StateBuild& build) {
  return 1 / (lorentz_factor(subluminal(build, "breather")) * pulse_mass(build));
}

}  // namespace
}  // namespace initial

extern const StateEntry breather_state;
const StateEntry breather_state{
    .name = "breather",
    .formula =
        "4 atan(eta cos(omega t')/(omega cosh(eta x'))), eta^2 = m^2 - omega^2, t' = gamma (t - v (x - x0)), "
        "x' = gamma (x - x0 - v t)",
    .parameters = {initial::position_parameter(), initial::speed_parameter(0), initial::frequency_parameter()},
    .exact = {"sine-gordon"},
    .approximate = {"sine-gordon-impurity"},
    .place = Place::line,
    .build = initial::breather,
    .width = initial::breather_width,
    .sources = {"ablowitz-kaup-newell-segur-1973"}};

}  // namespace delf
