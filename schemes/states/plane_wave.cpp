// SPDX-License-Identifier: MIT
#include <cmath>

#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// φ = A cos(q(x − x₀) − ωt) around a circle, ω = √(q² + m²) ≥ 0: n > 0 moves right, n < 0 left.
class PlaneWave final : public State {
 public:
  PlaneWave(double amplitude, double wavenumber, double frequency, double position, bool solves)
      : A(amplitude), q(wavenumber), omega(frequency), x0(position), exact_(solves) {}

  // φ_t = Aω sin(q(x − x₀) − ωt),   φ_x = −Aq sin(q(x − x₀) − ωt)
  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double phase = q * (x - x0) - omega * t;
    out[0] = {A * std::cos(phase), A * omega * std::sin(phase), -A * q * std::sin(phase)};
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

  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double X = modes_.standing(n_, x), c = A * std::cos(omega * t);
    out[0] = {c * X, -A * omega * std::sin(omega * t) * X, c * modes_.standing_slope(n_, x)};
  }
  bool exact() const override { return exact_; }
  std::string description() const override {
    return "plane-wave between walls: phi = A X(x) cos(omega t), X the standing mode " + std::to_string(n_) +
           ", A = " + text(A) + ", q = " + text(modes_.wavenumber(n_)) + ", omega = " + text(omega) +
           (exact_ ? "" : "; exact only as A -> 0");
  }

 private:
  Modes modes_;
  int n_;
  double A, omega;
  bool exact_;
};

std::unique_ptr<State> plane_wave(const StateBuild& build) {
  const Modes modes(build.lattice);
  const int n = modes.read(build);
  // ω² = q² + m²
  const double A = wave_amplitude(build), q = modes.wavenumber(n), omega = std::sqrt(q * q + squared_mass(build));
  if (!build.lattice.is_circle()) return std::make_unique<StandingWave>(modes, n, A, omega, build.exact);
  return std::make_unique<PlaneWave>(A, q, omega, build.number("initial.position"), build.exact);
}

Parameter origin() {
  Parameter p = position_parameter();
  p.otherwise.clear();
  return p;
}

}  // namespace
}  // namespace initial

extern const StateEntry plane_wave_state;
const StateEntry plane_wave_state{
    .name = "plane-wave",
    .formula =
        "A cos(q (x - x0) - omega t), q = 2 pi n/L, omega^2 = q^2 + m^2; between walls the standing mode n times "
        "cos(omega t)",
    .parameters = {initial::wave_amplitude_parameter(), initial::wavenumber_parameter(1), initial::origin()},
    .exact = {"wave", "klein-gordon"},
    .approximate = {"sine-gordon", "double-sine-gordon", "sine-gordon-impurity"},
    .place = Place::line,
    .build = initial::plane_wave,
    .sources = {"whitham-1974"}};

}  // namespace delf
