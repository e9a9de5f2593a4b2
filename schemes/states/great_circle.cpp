// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstddef>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
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
  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      const double angle = alpha(t, lattice.position(i)), c = std::cos(angle), s = std::sin(angle);
      for (std::size_t a = 0; a < 3; ++a) out[static_cast<std::size_t>(3 * i) + a] = c * first_[a] + s * second_[a];
    }
  }
  // u_t = α_t(−sin α e₁ + cos α e₂)
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      const double x = lattice.position(i), angle = alpha(t, x), rate = alpha_t(t, x);
      const double c = rate * std::cos(angle), s = rate * std::sin(angle);
      for (std::size_t a = 0; a < 3; ++a) out[static_cast<std::size_t>(3 * i) + a] = c * second_[a] - s * first_[a];
    }
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

  double A, q;
  const std::array<double, 3> first_{std::cos(0.4), 0, -std::sin(0.4)};
  const std::array<double, 3> second_{std::sin(0.4) * std::sin(0.7), std::cos(0.7), std::cos(0.4) * std::sin(0.7)};
};

}  // namespace

std::unique_ptr<State> great_circle(const StateRequest& request, const Lattice& lattice) {
  const Modes modes(lattice);
  const int n = modes.read(request, 1);
  if (2 * std::abs(n) > modes.most())
    throw BadInput("initial.wavenumber", "initial.wavenumber = " + std::to_string(n) + ": the shorter wave has " +
                                             std::to_string(2 * std::abs(n)) + " periods, and " +
                                             std::to_string(lattice.sites()) + " sites resolve at most " +
                                             std::to_string(modes.most()) + "; raise lattice.sites");
  return std::make_unique<GreatCircle>(finite("initial.amplitude", request.amplitude, 1), modes.wavenumber(n));
}

}  // namespace delf::initial
