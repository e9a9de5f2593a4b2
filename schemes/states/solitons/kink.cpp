// SPDX-License-Identifier: MIT
#include <limits>
#include <utility>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/pulse.hpp"
#include "schemes/states/solitons/kink_profile.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

class Kink final : public Pulse {
 public:
  Kink(const StateBuild& build, const PulseFrame& frame, bool mirrored, std::unique_ptr<KinkProfile> profile)
      : Pulse(build, frame),
        sign_(mirrored ? -1 : 1),
        speed_(frame.speed),
        gamma_(lorentz_factor(frame.speed)),
        position_(frame.position),
        profile_(std::move(profile)) {}

 protected:
  // φ = f(±γ(x − x₀ − vt)),   φ_t = ∓γv f′,   φ_x = ±γf′
  FieldPoint pulse(double, double s) const override {
    const double boosted = sign_ * gamma_ * s, slope = profile_->slope(boosted);
    return {profile_->f(boosted), -sign_ * gamma_ * speed_ * slope, sign_ * gamma_ * slope};
  }
  std::string formula() const override {
    return std::string(sign_ > 0 ? "kink" : "antikink") + ": phi = " + profile_->formula() +
           ", s = " + (sign_ > 0 ? "" : "-") + "gamma (x - x0 - v t), x0 = " + text(position_) +
           ", v = " + text(speed_);
  }

 private:
  double sign_, speed_, gamma_, position_;
  std::unique_ptr<KinkProfile> profile_;
};

double kink_lasts_until(const StateBuild& build, double position, double speed, const KinkProfile& profile) {
  if (!build.exact) return 0;
  const Lattice& lattice = build.lattice;
  // at rest between walls that keep their values, any piece of the kink is a solution
  if (!lattice.is_circle() && speed == 0 && lattice.left() != Wall::natural && lattice.right() != Wall::natural)
    return std::numeric_limits<double>::infinity();
  const double rate = lorentz_factor(speed) * profile.tail_rate();
  return clear_until(lattice, position, speed, reach(profile.tail_factor(), rate));
}

std::unique_ptr<State> any_kink(const StateBuild& build, bool mirrored) {
  if (build.request.theory == "phi4" && build.lattice.is_circle())
    throw BadInput("initial.state", "initial.state = " + build.request.name +
                                        ": in phi4 it joins -1 and 1, and a circle cannot; use lattice.space=interval");
  const double x0 = centre(build), v = subluminal(build, build.entry.name);
  auto profile = kink_profile(build);
  const PulseFrame frame{x0, v, mirrored ? -1 : 1, kink_lasts_until(build, x0, v, *profile)};
  return std::make_unique<Kink>(build, frame, mirrored, std::move(profile));
}

// 1/(γ rate)
double kink_width(const StateBuild& build) {
  return 1 / (lorentz_factor(subluminal(build, build.entry.name)) * kink_profile(build)->tail_rate());
}

}  // namespace
}  // namespace initial

extern const StateEntry kink_state;
const StateEntry kink_state{
    .name = "kink",
    .formula =
        "4 atan exp(m s), s = gamma (x - x0 - v t); phi4: tanh(sqrt(lambda/2) s); double-sine-gordon: "
        "2 arccot(-(m/mu) sinh(mu s)), mu^2 = m^2 + 2 lambda",
    .parameters = {initial::position_parameter(), initial::speed_parameter(0)},
    .exact = {"sine-gordon", "double-sine-gordon", "phi4"},
    .approximate = {"sine-gordon-impurity"},
    .place = Place::line,
    .build = [](const StateBuild& build) { return initial::any_kink(build, false); },
    .width = initial::kink_width,
    .sources = {"perring-skyrme-1962", "campbell-schonfeld-wingate-1983", "campbell-peyrard-sodano-1986",
                "fei-kivshar-vazquez-1992"}};  // of each theory

extern const StateEntry antikink_state;
const StateEntry antikink_state{.name = "antikink",
                                .formula = "the kink with s = -gamma (x - x0 - v t)",
                                .parameters = {initial::position_parameter(), initial::speed_parameter(0)},
                                .exact = {"sine-gordon", "double-sine-gordon", "phi4"},
                                .approximate = {"sine-gordon-impurity"},
                                .place = Place::line,
                                .build = [](const StateBuild& build) { return initial::any_kink(build, true); },
                                .width = initial::kink_width,
                                .sources = {"perring-skyrme-1962", "campbell-schonfeld-wingate-1983",
                                            "campbell-peyrard-sodano-1986", "fei-kivshar-vazquez-1992"}};

}  // namespace delf
