// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/scaled_hyperbolic.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

constexpr double pi = std::numbers::pi;

/// Two kinks that scatter at (0, 0), or one that bounces off a wall there, Tyranowski–Desbrun (164):
///
///     φ_SS = 4 atan( v sinh(γmx)/cosh(γmvt) )
///
FieldPoint scattering(double mass, double v, double t, double x) {
  const double b = lorentz_factor(v) * mass, bx = b * x, bt = b * v * t, M = std::max(std::abs(bx), std::abs(bt));
  const double F = v * scaled_sinh(bx, M), G = scaled_cosh(bt, M), r = std::hypot(F, G);
  return {4 * std::atan2(F, G), -4 * (F / r) * (b * v * scaled_sinh(bt, M) / r),
          4 * v * b * (scaled_cosh(bx, M) / r) * (G / r)};
}

/// A kink between two walls ℓ apart that keep the values 0 and 2π, or two of them in twice that, their mirror images about
/// the middle. It meets the left wall at τ = 0, the right one at 2T, and so on, (168):
///
///     φ = φ_SS(x, τ) for |τ| ≤ T,    2π + φ_SS(x − ℓ, τ − 2T) for |τ − 2T| ≤ T,    φ_SS(ℓ/2, T) = π
///
class Bounce final : public State {
 public:
  Bounce(const StateBuild& build, bool two)
      : two_(two),
        left_(build.lattice.position(0)),
        room_(build.lattice.length() / (two ? 2 : 1)),
        mass_(pulse_mass(build)),
        v_(subluminal(build, build.entry.name)) {
    if (!(v_ > 0))
      throw BadInput("initial.speed",
                     "initial.speed = " + text(v_) + ": a soliton that bounces moves; choose 0 < speed < 1");
    const double b = lorentz_factor(v_) * mass_;
    const double argument = v_ * std::sinh(b * room_ / 2);
    if (!(argument > 1e4 && std::isfinite(argument)))
      throw BadInput("lattice.length",
                     "initial.state = " + build.entry.name +
                         ": the formula holds where the walls are far from each other, or not too far for "
                         "numbers; choose another lattice.length");
    quarter_ = std::acosh(argument) / (b * v_);
    // one: at the middle of its way to the right; two: they meet at d/2v
    start_ = two ? -build.number("initial.separation", build.lattice.length() / 2) / (2 * v_) : quarter_;
  }

  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double s = x - left_ - (two_ ? room_ : 0), sign = s < 0 ? -1 : 1;
    // φ(−s) = −φ(s)
    double tau = std::remainder(start_ + t - quarter_, 4 * quarter_) + quarter_;  // in [−T, 3T]
    const bool right = tau > quarter_;
    FieldPoint p = scattering(mass_, v_, right ? tau - 2 * quarter_ : tau, right ? std::abs(s) - room_ : std::abs(s));
    if (right) p.phi += 2 * pi;
    // walls keep their values
    if (std::abs(s) == 0) p = {0, 0, p.phi_x};
    if (std::abs(s) == room_) p = {2 * pi, 0, p.phi_x};
    out[0] = {sign * p.phi, sign * p.phi_t, p.phi_x};
  }
  bool exact() const override { return exact_; }
  void not_exact() { exact_ = false; }
  std::string description() const override {
    return std::string(two_ ? "two solitons that bounce off each other and off both walls"
                            : "a soliton that bounces between two walls") +
           ", piecewise phi = 4 atan(v sinh(gamma x)/cosh(gamma v t)), Tyranowski-Desbrun (168): v = " + text(v_) +
           ", m = " + text(mass_) + ", exact up to the tail of a kink at half the way between walls";
  }

 private:
  bool two_, exact_ = true;
  double left_, room_, mass_, v_, quarter_ = 0, start_ = 0;
};

Parameter distance_parameter() {
  Parameter separation = separation_parameter();
  separation.otherwise = "L/2";
  return separation;
}

std::unique_ptr<State> bounce(const StateBuild& build, bool two) {
  auto state = std::make_unique<Bounce>(build, two);
  if (!build.exact) state->not_exact();
  return state;
}
// 1/(γm)
double bounce_width(const StateBuild& build) {
  return 1 / (lorentz_factor(subluminal(build, build.entry.name)) * pulse_mass(build));
}

}  // namespace
}  // namespace initial

extern const StateEntry soliton_bounce_state;
const StateEntry soliton_bounce_state{.name = "soliton-bounce",
                                      .formula = "a kink that starts in the middle and bounces between two walls",
                                      .parameters = {initial::speed_parameter(0.9)},
                                      .exact = {"sine-gordon"},
                                      .approximate = {},
                                      .place = Place::interval,
                                      .build = [](const StateBuild& build) { return initial::bounce(build, false); },
                                      .width = initial::bounce_width,
                                      .sources = {"tyranowski-desbrun-2019"}};

extern const StateEntry two_soliton_bounce_state;
const StateEntry two_soliton_bounce_state{.name = "two-soliton-bounce",
                                          .formula = "two kinks that bounce off each other and off two walls",
                                          .parameters = {initial::speed_parameter(0.9), initial::distance_parameter()},
                                          .exact = {"sine-gordon"},
                                          .approximate = {},
                                          .place = Place::interval,
                                          .build = [](const StateBuild& build) { return initial::bounce(build, true); },
                                          .width = initial::bounce_width,
                                          .sources = {"tyranowski-desbrun-2019"}};

}  // namespace delf
