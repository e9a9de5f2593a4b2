// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "lattice/error.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// A Gaussian envelope, with its images around the circle, on a carrier that turns in the plane of φ:
///
///     φ = a(s) e^{i(qs − ωt)},   a = A Σ_k e^{−(s − kL)²/2w²},   s = x − x₀,   φ_t = −iωφ,   φ_x = (a′/a + iq)φ
///
/// The envelope stands still here: this is how the packet starts, not how it moves.
class ChargedPacket final : public State {
 public:
  ChargedPacket(double amplitude, double width, double wavenumber, double frequency, double position, double length)
      : A(amplitude), w(width), q(wavenumber), omega(frequency), x0(position), L(length) {}

  int components() const override { return 2; }
  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double s = x - x0, phase = q * s - omega * t, c = std::cos(phase), n = std::sin(phase);
    const auto [height, slope] = envelope(s);
    out[0] = {height * c, omega * height * n, slope * c - q * height * n};
    out[1] = {height * n, -omega * height * c, slope * n + q * height * c};
  }
  bool exact() const override { return false; }
  std::string description() const override {
    return "charged-packet: phi(0) = A exp(-s^2/2w^2) exp(i q s), phi_t = -i omega phi, s = x - x0, A = " + text(A) +
           ", w = " + text(w) + ", q = " + text(q) + ", omega = " + text(omega) + ", x0 = " + text(x0);
  }

 private:
  // a and a′
  std::pair<double, double> envelope(double s) const {
    // beyond 9.2 w an image is below 1e-18
    const double nearest = std::remainder(s, L);
    const int images = static_cast<int>(std::ceil(9.2 * w / L)) + 1;
    double sum = 0, slope = 0;
    for (int k = -images; k <= images; ++k) {
      const double z = (nearest - k * L) / w, height = std::exp(-z * z / 2);
      sum += height, slope -= z / w * height;
    }
    return {A * sum, A * slope};
  }

  double A, w, q, omega, x0, L;
};

std::unique_ptr<State> charged_packet(const StateBuild& build) {
  const Lattice& lattice = build.lattice;
  const double L = lattice.length(), w = build.number("initial.width", L / 20);
  if (w < lattice.space_step() || w > L)
    throw BadInput("initial.width", "initial.width = " + text(w) +
                                        ": a packet is wider than the distance of the sites, " +
                                        text(lattice.space_step()) + ", and narrower than the circle, " + text(L) +
                                        "; choose a width between");
  const Modes modes(lattice);
  const double q = modes.wavenumber(modes.read(build, std::min(8, modes.most()))), m = build.mass();
  return std::make_unique<ChargedPacket>(build.number("initial.amplitude"), w, q, std::sqrt(q * q + m * m),
                                         centre(build), L);
}

}  // namespace
}  // namespace initial

extern const StateEntry charged_packet_state;
const StateEntry charged_packet_state{
    .name = "charged-packet",
    .formula = "A exp(-s^2/2w^2) exp(i(q s - omega t)), s = x - x0, q = 2 pi n/L, omega^2 = q^2 + m^2",
    .parameters = {initial::amplitude_parameter(0.1), initial::width_parameter(),
                   initial::packet_wavenumber_parameter(), initial::position_parameter()},
    .exact = {},
    .approximate = {"complex-klein-gordon"},
    .place = Place::circle,
    .build = initial::charged_packet,
    .sources = {"whitham-1974"}};

}  // namespace delf
