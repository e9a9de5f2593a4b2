// SPDX-License-Identifier: MIT
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/pulse.hpp"
#include "schemes/states/scaled_hyperbolic.hpp"

namespace delf::initial {
namespace {

/// Sine-Gordon's bound pair, η = √(m² − ω²), carried along by a boost:
///
///     φ = 4 atan( η cos(ωt′)/(ω cosh(ηx′)) ),   t′ = γ(t − v(x − x₀)),   x′ = γ(x − x₀ − vt)
///
class Breather final : public Pulse {
 public:
  Breather(const Lattice& lattice, const StateRequest& request, const PulseFrame& frame, double mass, double frequency)
      : Pulse(lattice, request, frame),
        x0(frame.position),
        v(frame.speed),
        gamma(lorentz_factor(v)),
        m(mass),
        omega(frequency),
        eta(std::sqrt((m - omega) * (m + omega))) {}

 protected:
  FieldPoint at(double t, double s) const override {
    // t′ = t/γ − γvs and x′ = γs, since x − x₀ = s + vt
    const double phase = omega * (t / gamma - gamma * v * s), b = eta * gamma * s, M = std::abs(b);
    // tan(φ/4) = F/G,   φ_t = 4(F_t G − F G_t)/(F² + G²), all times e^{−M}
    const double F = eta * std::cos(phase) * std::exp(-M), F_t = -eta * omega * gamma * std::sin(phase) * std::exp(-M);
    const double G = omega * scaled_cosh(b, M), G_t = -omega * eta * gamma * v * scaled_sinh(b, M);
    const double r = std::hypot(F, G);
    return {4 * std::atan2(F, G), 4 * ((F_t / r) * (G / r) - (F / r) * (G_t / r))};
  }
  std::string formula() const override {
    return "breather: phi = 4 atan(eta cos(omega t')/(omega cosh(eta x'))), omega = " + text(omega) +
           ", eta = " + text(eta) + ", m = " + text(m) + ", x0 = " + text(x0) + ", v = " + text(v);
  }

 private:
  double x0, v, gamma, m, omega, eta;
};

}  // namespace

std::unique_ptr<State> breather(const StateRequest& request, const Lattice& lattice) {
  const double m = pulse_mass(request), v = subluminal(request, 0, "breather");
  const double omega = finite("initial.frequency", request.frequency, 0.6 * m);
  if (!(omega > 0 && omega < m))
    throw BadInput("initial.frequency", "initial.frequency = " + text(omega) +
                                            ": a breather beats slower than the mass; choose 0 < frequency < " +
                                            text(m));
  const double x0 = centre(request, lattice), eta = std::sqrt((m - omega) * (m + omega));
  // φ ≈ 8(η/ω) e^{−ηγ|s|} far away
  const double until = request.theory == "sine-gordon-impurity"
                           ? 0.0
                           : clear_until(lattice, x0, v, reach(8 * eta / omega, eta * lorentz_factor(v)));
  return std::make_unique<Breather>(lattice, request, PulseFrame{x0, v, 0, until}, m, omega);
}

}  // namespace delf::initial
