// SPDX-License-Identifier: MIT
#include <limits>
#include <utility>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/kink_profile.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/pulse.hpp"

namespace delf::initial {
namespace {

class Kink final : public Pulse {
 public:
  Kink(const Lattice& lattice, const StateRequest& request, const PulseFrame& frame, bool mirrored,
       std::unique_ptr<KinkProfile> profile)
      : Pulse(lattice, request, frame),
        sign_(mirrored ? -1 : 1),
        speed_(frame.speed),
        gamma_(lorentz_factor(frame.speed)),
        position_(frame.position),
        profile_(std::move(profile)) {}

 protected:
  // φ = f(±γ(x − x₀ − vt)),   φ_t = ∓γv f′
  FieldPoint at(double, double s) const override {
    const double boosted = sign_ * gamma_ * s;
    return {profile_->f(boosted), -sign_ * gamma_ * speed_ * profile_->slope(boosted)};
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

double lasts_until(const StateRequest& request, const Lattice& lattice, double position, double speed,
                   const KinkProfile& profile) {
  if (request.theory == "sine-gordon-impurity") return 0;
  // at rest between walls that keep their values, any piece of the kink is a solution
  if (!lattice.is_circle() && speed == 0 && lattice.left() == Wall::fixed && lattice.right() == Wall::fixed)
    return std::numeric_limits<double>::infinity();
  const double rate = lorentz_factor(speed) * profile.tail_rate();
  return clear_until(lattice, position, speed, reach(profile.tail_factor(), rate));
}

std::unique_ptr<State> any_kink(const StateRequest& request, const Lattice& lattice, bool mirrored) {
  if (request.theory == "phi4" && lattice.is_circle())
    throw BadInput("initial.state", "initial.state = " + request.name +
                                        ": in phi4 it joins -1 and 1, and a circle cannot; use lattice.space=interval");
  const double x0 = centre(request, lattice), v = subluminal(request, 0, request.name);
  auto profile = kink_profile(request);
  const PulseFrame frame{x0, v, mirrored ? -1 : 1, lasts_until(request, lattice, x0, v, *profile)};
  return std::make_unique<Kink>(lattice, request, frame, mirrored, std::move(profile));
}

}  // namespace

std::unique_ptr<State> kink(const StateRequest& r, const Lattice& lattice) { return any_kink(r, lattice, false); }
std::unique_ptr<State> antikink(const StateRequest& r, const Lattice& lattice) { return any_kink(r, lattice, true); }

}  // namespace delf::initial
