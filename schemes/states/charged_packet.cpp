// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
namespace {

/// A Gaussian envelope, with its images around the circle, on a carrier that turns in the plane of φ:
///
///     φ = A Σ_k e^{−(s − kL)²/2w²} e^{i(qs − ωt)},   s = x − x₀,   φ_t = −iωφ
///
/// The envelope stands still here: this is how the packet starts, not how it moves.
class ChargedPacket final : public State {
 public:
  ChargedPacket(double amplitude, double width, double wavenumber, double frequency, double position)
      : A(amplitude), w(width), q(wavenumber), omega(frequency), x0(position) {}

  int components() const override { return 2; }
  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      const auto site = static_cast<std::size_t>(2 * i);
      const double s = lattice.position(i) - x0, phase = q * s - omega * t, height = envelope(s, lattice.length());
      out[site] = height * std::cos(phase);
      out[site + 1] = height * std::sin(phase);
    }
  }
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      const auto site = static_cast<std::size_t>(2 * i);
      const double s = lattice.position(i) - x0, phase = q * s - omega * t, height = envelope(s, lattice.length());
      out[site] = omega * height * std::sin(phase);
      out[site + 1] = -omega * height * std::cos(phase);
    }
  }
  bool exact() const override { return false; }
  std::string description() const override {
    return "charged-packet: phi(0) = A exp(-s^2/2w^2) exp(i q s), phi_t = -i omega phi, s = x - x0, A = " + text(A) +
           ", w = " + text(w) + ", q = " + text(q) + ", omega = " + text(omega) + ", x0 = " + text(x0);
  }

 private:
  double envelope(double s, double L) const {
    // beyond 9.2 w an image is below 1e-18
    const double nearest = std::remainder(s, L);
    const int images = static_cast<int>(std::ceil(9.2 * w / L)) + 1;
    double sum = 0;
    for (int k = -images; k <= images; ++k) {
      const double z = (nearest - k * L) / w;
      sum += std::exp(-z * z / 2);
    }
    return A * sum;
  }

  double A, w, q, omega, x0;
};

}  // namespace

std::unique_ptr<State> charged_packet(const StateRequest& request, const Lattice& lattice) {
  const double L = lattice.length(), w = positive("initial.width", request.width, L / 20);
  if (w < lattice.space_step() || w > L)
    throw BadInput("initial.width", "initial.width = " + text(w) +
                                        ": a packet is wider than the distance of the sites, " +
                                        text(lattice.space_step()) + ", and narrower than the circle, " + text(L) +
                                        "; choose a width between");
  const Modes modes(lattice);
  const double q = modes.wavenumber(modes.read(request, std::min(8, modes.most())));
  return std::make_unique<ChargedPacket>(wave_amplitude(request), w, q, std::sqrt(q * q + squared_mass(request)),
                                         centre(request, lattice));
}

}  // namespace delf::initial
