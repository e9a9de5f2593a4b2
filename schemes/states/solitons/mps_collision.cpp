// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "lattice/index.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/solitons/train_profile.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// The collision of Marsden–Patrick–Shkoller §5.2: one kink of a train of period L/4 on the first quarter of the
/// circle, its mirror image on the last, the vacuum 2π between. With x̄ = L − x and each soliton translated exactly,
///
///     φ̃(x − ct − L/8)   on [0, L/4),     2π   on [L/4, 3L/4),     φ̃(x̄ − ct − L/8)   on [3L/4, L)
///
/// where φ̃ is centred at 0; the paper writes the last as 2π − φ̃(x − 3L/4 + ct), which is the same. It solves no
/// field equation: there is a corner at each quarter.
class MpsCollision final : public State {
 public:
  MpsCollision(TrainProfile profile, double epsilon, double mass) : train_(profile), epsilon_(epsilon), mass_(mass) {}

  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double L = 4 * train_.period, turns = std::floor(x / L), y = x - turns * L;
    const double quarter = train_.period * (1 - 1e-12);  // the site at L/4 belongs to the middle
    out[0] = y < quarter       ? soliton(t, y, 1)
             : y < 3 * quarter ? FieldPoint{2 * std::numbers::pi}
                               : soliton(t, L - y, -1);
  }
  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    at_every_site(&FieldPoint::phi, t, lattice, out);
  }
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    at_every_site(&FieldPoint::phi_t, t, lattice, out);
  }
  bool exact() const override { return false; }
  bool knows_second_row() const override { return true; }
  std::string description() const override {
    return "mps-collision (Marsden-Patrick-Shkoller 5.2): a kink pi + 2 am(P (x - c t - L/8)/(L/4); kappa) on the "
           "first "
           "quarter, its mirror image on the last, 2 pi between; 1 - kappa = " +
           text(epsilon_) + ", P = " + text(2 * train_.jacobi.K()) + ", c = " + text(train_.speed) +
           ", m = " + text(mass_);
  }

 private:
  /// φ̃(x − ct − L/8), or its mirror image (side −1) at x̄.
  FieldPoint soliton(double t, double x, int side) const {
    const double xi = x - train_.period / 2 - train_.speed * t, slope = train_.slope(xi);
    return {train_.phi(xi), -train_.speed * slope, side * slope};
  }
  // The last quarter of the sites takes mirror images, so that sites i and N − i agree to the bit.
  void at_every_site(double FieldPoint::*part, double t, const Lattice& lattice, std::span<double> out) const {
    const int N = lattice.sites();
    FieldPoint point;
    for (int i = 0; i < N; ++i) {
      const bool mirrored = std::int64_t{4} * i >= std::int64_t{3} * N && lattice.position(0) == 0;
      if (mirrored) point = soliton(t, lattice.position(N - i), -1);
      else at(t, lattice.position(i), {&point, 1});
      out[i] = point.*part;
    }
  }

  TrainProfile train_;
  double epsilon_, mass_;
};

TrainProfile collision_profile(const StateBuild& build) {
  return TrainProfile::from_epsilon(build.number("initial.epsilon"), build.lattice.length() / 4, pulse_mass(build));
}

std::unique_ptr<State> mps_collision(const StateBuild& build) {
  return std::make_unique<MpsCollision>(collision_profile(build), build.number("initial.epsilon"), pulse_mass(build));
}

}  // namespace
}  // namespace initial

extern const StateEntry mps_collision_state;
const StateEntry mps_collision_state{
    .name = "mps-collision",
    .formula =
        "phi~(x - c t) | 2 pi | 2 pi - phi~(x - 3L/4 + c t) on the first, middle two and last quarters of the circle, "
        "phi~ = pi + 2 am(P (x - L/8)/(L/4); 1 - epsilon)",
    .parameters = {initial::epsilon_parameter()},
    .exact = {},
    .approximate = {"sine-gordon"},
    .place = Place::circle,
    .build = initial::mps_collision,
    .width = [](const StateBuild& build) { return initial::collision_profile(build).width(); },
    .sources = {"marsden-patrick-shkoller-1998"}};

}  // namespace delf
