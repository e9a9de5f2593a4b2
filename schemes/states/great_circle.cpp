// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>

#include "lattice/error.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// A wave on a great circle of the sphere, where the wave map is the wave equation for the angle, α_tt = α_xx:
///
///     u = cos α e₁ + sin α e₂,   α = A cos q(x − t) + (A/2) sin 2qx cos 2qt
///
/// e₁, e₂ are the first two axes, turned by 0.7 about the first and then by 0.4 about the second, so that all three
/// components move.
class GreatCircle final : public State {
 public:
  GreatCircle(double amplitude, double wavenumber) : A(amplitude), q(wavenumber) {}

  int components() const override { return 3; }
  // u_t = α_t(−sin α e₁ + cos α e₂),   u_x = α_x(−sin α e₁ + cos α e₂)
  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double angle = alpha(t, x), c = std::cos(angle), s = std::sin(angle);
    const double rate = alpha_t(t, x), slope = alpha_x(t, x);
    for (std::size_t a = 0; a < 3; ++a)
      out[a] = {c * first_[a] + s * second_[a], rate * c * second_[a] - rate * s * first_[a],
                slope * c * second_[a] - slope * s * first_[a]};
  }
  bool exact() const override { return true; }
  std::string description() const override {
    return "great-circle: u = cos(alpha) e1 + sin(alpha) e2, alpha = A cos(q (x - t)) + (A/2) sin(2 q x) cos(2 q t), "
           "A = " +
           text(A) + ", q = " + text(q);
  }

 private:
  double alpha(double t, double x) const {
    return A * std::cos(q * (x - t)) + A / 2 * std::sin(2 * q * x) * std::cos(2 * q * t);
  }
  double alpha_t(double t, double x) const {
    return A * q * (std::sin(q * (x - t)) - std::sin(2 * q * x) * std::sin(2 * q * t));
  }
  double alpha_x(double t, double x) const {
    return A * q * (std::cos(2 * q * x) * std::cos(2 * q * t) - std::sin(q * (x - t)));
  }

  double A, q;
  const std::array<double, 3> first_{std::cos(0.4), 0, -std::sin(0.4)};
  const std::array<double, 3> second_{std::sin(0.4) * std::sin(0.7), std::cos(0.7), std::cos(0.4) * std::sin(0.7)};
};

std::unique_ptr<State> great_circle(const StateBuild& build) {
  const Modes modes(build.lattice);
  const int n = modes.read(build);
  if (2 * std::abs(n) > modes.most())
    throw BadInput("initial.wavenumber", "initial.wavenumber = " + std::to_string(n) + ": the shorter wave has " +
                                             std::to_string(2 * std::abs(n)) + " periods, and " +
                                             std::to_string(build.lattice.sites()) + " sites resolve at most " +
                                             std::to_string(modes.most()) + "; raise lattice.sites");
  return std::make_unique<GreatCircle>(build.number("initial.amplitude"), modes.wavenumber(n));
}

}  // namespace
}  // namespace initial

extern const StateEntry great_circle_state;
const StateEntry great_circle_state{
    .name = "great-circle",
    .formula =
        "cos(alpha) e1 + sin(alpha) e2, alpha = A cos(q (x - t)) + (A/2) sin(2 q x) cos(2 q t), q = 2 pi n/L, e1 and e2 "
        "fixed and orthogonal",
    .parameters = {initial::amplitude_parameter(1), initial::wavenumber_parameter(1)},
    .exact = {"wave-map"},
    .approximate = {},
    .place = Place::circle,
    .build = initial::great_circle,
    .sources = {"shatah-struwe-1998"}};

}  // namespace delf
