// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

struct Wave {
  double weight, wavenumber, frequency;
};

/// A Gaussian envelope on a carrier, φ(0, x) = A e^{−s²/2w²} cos q₀s with s = x − x₀ and its images around the circle;
/// every Fourier mode goes the same way with its own ω, so that the packet spreads as it does in the theory:
///
///     φ = Σ_{n ≥ 0} a_n cos(q_n s − ω_n t)
///
class WavePacket final : public State {
 public:
  WavePacket(std::vector<Wave> waves, double position, std::string parameters, bool solves)
      : waves_(std::move(waves)), x0(position), parameters_(std::move(parameters)), exact_(solves) {}

  void at(double t, double x, std::span<FieldPoint> out) const override {
    double phi = 0, phi_t = 0, phi_x = 0;
    for (const Wave& w : waves_) phi += w.weight * std::cos(w.wavenumber * (x - x0) - w.frequency * t);
    for (const Wave& w : waves_) {
      const double sine = std::sin(w.wavenumber * (x - x0) - w.frequency * t);
      phi_t += w.weight * w.frequency * sine;
      phi_x -= w.weight * w.wavenumber * sine;
    }
    out[0] = {phi, phi_t, phi_x};
  }
  bool exact() const override { return exact_; }
  std::string description() const override {
    return "wave-packet: phi(0) = A exp(-s^2/2w^2) cos(q s), s = x - x0, each mode with its own omega; " + parameters_ +
           ", x0 = " + text(x0) + ", modes = " + std::to_string(waves_.size()) +
           (exact_ ? "" : "; exact only as A -> 0");
  }

 private:
  std::vector<Wave> waves_;
  double x0;
  std::string parameters_;
  bool exact_;
};

std::unique_ptr<State> wave_packet(const StateBuild& build) {
  const Lattice& lattice = build.lattice;
  const double L = lattice.length(), A = wave_amplitude(build), m2 = squared_mass(build);
  const double w = build.number("initial.width", L / 20);
  if (w < lattice.space_step())
    throw BadInput("initial.width", "initial.width = " + text(w) + ": the sites are " + text(lattice.space_step()) +
                                        " apart; choose a wider packet, or raise lattice.sites");
  if (w > L / 4)  // at the other side of the circle it is e⁻² of its height
    throw BadInput("initial.width", "initial.width = " + text(w) +
                                        ": such a packet does not fit on a circle of length " + text(L) +
                                        "; choose a width of at most " + text(L / 4) + ", or a longer circle");
  const Modes modes(lattice);
  const int carrier = modes.read(build, std::min(8, modes.most()));
  const double q0 = modes.wavenumber(std::abs(carrier)), direction = carrier < 0 ? -1 : 1;

  // Poisson: Σ_images A e^{−s²/2w²} e^{iq₀s} = Σ_n c_n e^{iq_n s},   c_n = A (w√(2π)/L) e^{−w²(q_n − q₀)²/2},
  // and a_n = c_n + c_{−n}. Beyond |q − q₀| = 9.2/w the exponential is below 1e-18.
  const auto c = [&](int n) {
    const double z = w * (modes.wavenumber(n) - q0);
    return A * w * std::sqrt(2 * std::numbers::pi) / L * std::exp(-z * z / 2);
  };
  const double bandwidth = 9.2 * L / (2 * std::numbers::pi * w);
  const int last = static_cast<int>(std::ceil(std::abs(carrier) + bandwidth));
  const int first = std::max(0, static_cast<int>(std::floor(std::abs(carrier) - bandwidth)));
  std::vector<Wave> waves;
  for (int n = first; n <= last; ++n) {
    const double q = modes.wavenumber(n);
    waves.push_back({n == 0 ? c(0) : c(n) + c(-n), direction * q, std::sqrt(q * q + m2)});
  }
  return std::make_unique<WavePacket>(std::move(waves), centre(build),
                                      "A = " + text(A) + ", w = " + text(w) + ", q = " + text(direction * q0),
                                      build.exact);
}

}  // namespace
}  // namespace initial

extern const StateEntry wave_packet_state;
const StateEntry wave_packet_state{
    .name = "wave-packet",
    .formula = "A exp(-s^2/2w^2) cos(2 pi n s/L), s = x - x0, each mode with its own omega",
    .parameters = {initial::wave_amplitude_parameter(), initial::width_parameter(),
                   initial::packet_wavenumber_parameter(), initial::position_parameter()},
    .exact = {"wave", "klein-gordon"},
    .approximate = {"sine-gordon", "double-sine-gordon", "sine-gordon-impurity"},
    .place = Place::circle,
    .build = initial::wave_packet,
    .sources = {"whitham-1974"}};

}  // namespace delf
