// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
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

  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      double sum = 0;
      for (const Wave& w : waves_)
        sum += w.weight * std::cos(w.wavenumber * (lattice.position(i) - x0) - w.frequency * t);
      out[static_cast<std::size_t>(i)] = sum;
    }
  }
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      double sum = 0;
      for (const Wave& w : waves_)
        sum += w.weight * w.frequency * std::sin(w.wavenumber * (lattice.position(i) - x0) - w.frequency * t);
      out[static_cast<std::size_t>(i)] = sum;
    }
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

}  // namespace

std::unique_ptr<State> wave_packet(const StateRequest& request, const Lattice& lattice) {
  const double L = lattice.length(), A = wave_amplitude(request), m2 = squared_mass(request);
  const double w = positive("initial.width", request.width, L / 20);
  if (w < lattice.space_step())
    throw BadInput("initial.width", "initial.width = " + text(w) + ": the sites are " + text(lattice.space_step()) +
                                        " apart; choose a wider packet, or raise lattice.sites");
  const Modes modes(lattice);
  const int carrier = modes.read(request, std::min(8, modes.most()));
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
  return std::make_unique<WavePacket>(std::move(waves), centre(request, lattice),
                                      "A = " + text(A) + ", w = " + text(w) + ", q = " + text(direction * q0),
                                      is_linear(request));
}

}  // namespace delf::initial
