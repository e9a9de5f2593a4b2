// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// A pendulum at the angle A from straight down, pushed sideways so that its azimuth grows by ω. Where ω² cos A = 1 it goes
/// round on a cone for ever, which is an exact solution:
///
///     q = (sin A cos ωt, sin A sin ωt, −cos A)
///
class SphericalSwing final : public State {
 public:
  SphericalSwing(double angle, std::optional<double> rate)
      : A(angle), conical(!rate), w(rate.value_or(1 / std::sqrt(std::cos(angle)))) {}

  int components() const override { return 3; }
  void at(double t, double, std::span<FieldPoint> out) const override {
    const double s = std::sin(A);
    out[0] = {s * std::cos(w * t), -s * w * std::sin(w * t), 0};
    out[1] = {s * std::sin(w * t), s * w * std::cos(w * t), 0};
    out[2] = {-std::cos(A), 0, 0};
  }
  bool exact() const override { return conical; }
  std::string description() const override {
    return "spherical-swing: q = (sin A cos wt, sin A sin wt, -cos A)" +
           std::string(conical ? ", w^2 cos A = 1" : " and q_t at t = 0") + ", A = " + text(A) + ", w = " + text(w);
  }

 private:
  double A;
  bool conical;
  double w;
};

std::unique_ptr<State> spherical_swing(const StateBuild& build) {
  const double A = build.number("initial.amplitude");
  const auto rate = build.values.maybe<double>("initial.azimuth_rate");
  if (!rate && !(std::abs(A) < std::numbers::pi / 2))
    throw BadInput("initial.amplitude",
                   "initial.amplitude = " + text(A) +
                       ": no pendulum goes round on a cone there; choose |amplitude| < pi/2, or give "
                       "initial.azimuth_rate");
  return std::make_unique<SphericalSwing>(A, rate);
}

}  // namespace
}  // namespace initial

extern const StateEntry spherical_swing_state;
const StateEntry spherical_swing_state{
    .name = "spherical-swing",
    .formula = "(sin A cos wt, sin A sin wt, -cos A)",
    .parameters =
        {initial::amplitude_parameter(1),
         {"initial.azimuth_rate", 0.0, "w: how fast the azimuth grows", "1/time", {}, {}, "1/sqrt(cos A): on a cone"}},
    .exact = {"spherical-pendulum"},
    .approximate = {},
    .place = Place::point,
    .build = initial::spherical_swing,
    .sources = {"arnold-1989"}};

}  // namespace delf
