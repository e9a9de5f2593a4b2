// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/solitons/train_profile.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// n kinks (n < 0: antikinks) side by side around a circle: φ = π ± 2 am(2K(x − x₀ − vt)/Λ; κ), Λ = L/|n|.
class KinkTrain final : public State {
 public:
  KinkTrain(TrainProfile profile, int winding, double position, double mass)
      : train_(profile), winding_(winding), sign_(winding < 0 ? -1 : 1), position_(position), mass_(mass) {}

  // φ_t = −v φ_x
  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double xi = x - position_ - train_.speed * t, phi = train_.phi(xi), slope = train_.slope(xi);
    out[0] = {sign_ > 0 ? phi : 2 * std::numbers::pi - phi, -sign_ * train_.speed * slope, sign_ * slope};
  }
  bool exact() const override { return true; }
  int winding() const override { return winding_; }
  std::string description() const override {
    const Jacobi& j = train_.jacobi;
    return std::string("kink-train: phi = pi ") + (sign_ > 0 ? "+" : "-") +
           " 2 am(2 K (x - x0 - v t)/period; kappa), period = " + text(train_.period) + ", x0 = " + text(position_) +
           ", v = " + text(train_.speed) + ", m = " + text(mass_) +
           ", 1 - kappa = " + text(j.complementary_modulus() * j.complementary_modulus() / (1 + j.modulus())) +
           ", winding = " + std::to_string(winding_);
  }

 private:
  TrainProfile train_;
  int winding_;
  double sign_, position_, mass_;
};

TrainProfile train_profile(const StateBuild& build) {
  const double m = pulse_mass(build),
               period = build.lattice.length() / std::abs(static_cast<double>(build.request.winding.value_or(1)));
  return build.values.has("initial.speed") ? TrainProfile::from_speed(subluminal(build, "kink"), period, m)
                                           : TrainProfile::from_epsilon(build.number("initial.epsilon"), period, m);
}

std::unique_ptr<State> kink_train(const StateBuild& build) {
  const int n = build.request.winding.value_or(1), sites = build.lattice.sites();
  if (n == 0)
    throw BadInput("boundary.winding", "boundary.winding = 0: a train has at least one kink; choose 1, -1, 2, ...");
  if (std::abs(static_cast<double>(n)) > sites / 2)
    throw BadInput("boundary.winding", "boundary.winding = " + std::to_string(n) + ": " + std::to_string(sites) +
                                           " sites resolve at most " + std::to_string(sites / 2) +
                                           " kinks; raise lattice.sites");
  return std::make_unique<KinkTrain>(train_profile(build), n, centre(build), pulse_mass(build));
}

Parameter speed() {
  Parameter p = speed_parameter(0);
  p.otherwise = "that of epsilon";
  return p;
}

}  // namespace
}  // namespace initial

extern const StateEntry kink_train_state;
const StateEntry kink_train_state{
    .name = "kink-train",
    .formula = "pi + 2 am(2 K (x - x0 - v t)/l; kappa), l = L/|winding|, m l = 2 kappa K sqrt(1 - v^2)",
    .parameters = {initial::position_parameter(), initial::speed(), initial::epsilon_parameter()},
    .exact = {"sine-gordon"},
    .approximate = {},
    .place = Place::circle,
    .build = initial::kink_train,
    .width = [](const StateBuild& build) { return initial::train_profile(build).width(); },
    .sources = {"scott-chu-mclaughlin-1973", "dlmf"}};

}  // namespace delf
