// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>

#include "schemes/states/builders.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
namespace {

/// φ = A cos(q(x − x₀) − ωt) around a circle, ω = √(q² + m²) ≥ 0: n > 0 moves right, n < 0 left.
class PlaneWave final : public State {
 public:
  PlaneWave(double amplitude, double wavenumber, double frequency, double position, bool solves)
      : A(amplitude), q(wavenumber), omega(frequency), x0(position), exact_(solves) {}

  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i)
      out[static_cast<std::size_t>(i)] = A * std::cos(q * (lattice.position(i) - x0) - omega * t);
  }
  // φ_t = Aω sin(q(x − x₀) − ωt)
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i)
      out[static_cast<std::size_t>(i)] = A * omega * std::sin(q * (lattice.position(i) - x0) - omega * t);
  }
  bool exact() const override { return exact_; }
  std::string description() const override {
    return "plane-wave: phi = A cos(q (x - x0) - omega t), A = " + text(A) + ", q = " + text(q) +
           ", omega = " + text(omega) + ", x0 = " + text(x0) + (exact_ ? "" : "; exact only as A -> 0");
  }

 private:
  double A, q, omega, x0;
  bool exact_;
};

/// φ = A X_n(x) cos ωt between walls, X_n the standing mode that they allow.
class StandingWave final : public State {
 public:
  StandingWave(const Modes& modes, int n, double amplitude, double frequency, bool solves)
      : modes_(modes), n_(n), A(amplitude), omega(frequency), exact_(solves) {}

  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    fill(A * std::cos(omega * t), lattice, out);
  }
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    fill(-A * omega * std::sin(omega * t), lattice, out);
  }
  bool exact() const override { return exact_; }
  std::string description() const override {
    return "plane-wave between walls: phi = A X(x) cos(omega t), X the standing mode " + std::to_string(n_) +
           ", A = " + text(A) + ", q = " + text(modes_.wavenumber(n_)) + ", omega = " + text(omega) +
           (exact_ ? "" : "; exact only as A -> 0");
  }

 private:
  void fill(double factor, const Lattice& lattice, std::span<double> out) const {
    for (int i = 0; i < lattice.sites(); ++i)
      out[static_cast<std::size_t>(i)] = factor * modes_.standing(n_, lattice.position(i));
  }

  Modes modes_;
  int n_;
  double A, omega;
  bool exact_;
};

}  // namespace

std::unique_ptr<State> plane_wave(const StateRequest& request, const Lattice& lattice) {
  const Modes modes(lattice);
  const int n = modes.read(request, 1);
  // ω² = q² + m²
  const double A = wave_amplitude(request), q = modes.wavenumber(n), omega = std::sqrt(q * q + squared_mass(request));
  if (!lattice.is_circle()) return std::make_unique<StandingWave>(modes, n, A, omega, is_linear(request));
  return std::make_unique<PlaneWave>(A, q, omega, finite("initial.position", request.position, 0), is_linear(request));
}

}  // namespace delf::initial
