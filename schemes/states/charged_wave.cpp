// SPDX-License-Identifier: MIT
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// φ = A e^{i(qx − ωt)}: |φ| = A everywhere, so that ω² = q² + m² + λA² at any amplitude.
class ChargedWave final : public State {
 public:
  ChargedWave(double amplitude, double wavenumber, double frequency) : A(amplitude), q(wavenumber), omega(frequency) {}

  int components() const override { return 2; }
  // φ_t = −iωφ,   φ_x = iqφ
  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double phase = q * x - omega * t, c = std::cos(phase), s = std::sin(phase);
    out[0] = {A * c, A * omega * s, -A * q * s};
    out[1] = {A * s, -A * omega * c, A * q * c};
  }
  bool exact() const override { return true; }
  std::string description() const override {
    return "charged-wave: phi = A exp(i(q x - omega t)), A = " + text(A) + ", q = " + text(q) +
           ", omega = " + text(omega);
  }

 private:
  double A, q, omega;
};

std::unique_ptr<State> charged_wave(const StateBuild& build) {
  const Modes modes(build.lattice);
  const double A = build.number("initial.amplitude"), q = modes.wavenumber(modes.read(build)), m = build.mass();
  // ω² = q² + m² + λA²
  const double linear = q * q + m * m, squared = linear + build.lambda() * A * A;
  if (squared < 0)
    throw BadInput("theory.lambda", "theory.lambda = " + text(build.lambda()) +
                                        ": a wave of this amplitude does not turn but grows; choose lambda >= " +
                                        text(-linear / (A * A)));
  return std::make_unique<ChargedWave>(A, q, std::sqrt(squared));
}

}  // namespace
}  // namespace initial

extern const StateEntry charged_wave_state;
const StateEntry charged_wave_state{
    .name = "charged-wave",
    .formula = "A exp(i(q x - omega t)), q = 2 pi n/L, omega^2 = q^2 + m^2 + lambda A^2",
    .parameters = {initial::amplitude_parameter(1), initial::wavenumber_parameter(1)},
    .exact = {"complex-klein-gordon"},
    .approximate = {},
    .place = Place::circle,
    .build = initial::charged_wave,
    .sources = {"whitham-1974"}};

}  // namespace delf
