// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
namespace {

/// φ = A e^{i(qx − ωt)}: |φ| = A everywhere, so that ω² = q² + m² + λA² at any amplitude.
class ChargedWave final : public State {
 public:
  ChargedWave(double amplitude, double wavenumber, double frequency) : A(amplitude), q(wavenumber), omega(frequency) {}

  int components() const override { return 2; }
  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      const auto s = static_cast<std::size_t>(2 * i);
      const double phase = q * lattice.position(i) - omega * t;
      out[s] = A * std::cos(phase);
      out[s + 1] = A * std::sin(phase);
    }
  }
  // φ_t = −iωφ
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      const auto s = static_cast<std::size_t>(2 * i);
      const double phase = q * lattice.position(i) - omega * t;
      out[s] = A * omega * std::sin(phase);
      out[s + 1] = -A * omega * std::cos(phase);
    }
  }
  bool exact() const override { return true; }
  std::string description() const override {
    return "charged-wave: phi = A exp(i(q x - omega t)), A = " + text(A) + ", q = " + text(q) +
           ", omega = " + text(omega);
  }

 private:
  double A, q, omega;
};

}  // namespace

std::unique_ptr<State> charged_wave(const StateRequest& request, const Lattice& lattice) {
  const Modes modes(lattice);
  const double A = finite("initial.amplitude", request.amplitude, 1), q = modes.wavenumber(modes.read(request, 1));
  // ω² = q² + m² + λA²
  const double linear = q * q + request.mass * request.mass, squared = linear + request.lambda * A * A;
  if (squared < 0)
    throw BadInput("theory.lambda", "theory.lambda = " + text(request.lambda) +
                                        ": a wave of this amplitude does not turn but grows; choose lambda >= " +
                                        text(-linear / (A * A)));
  return std::make_unique<ChargedWave>(A, q, std::sqrt(squared));
}

}  // namespace delf::initial
