// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/pulse.hpp"
#include "schemes/states/solitons/kink_profile.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// n kinks and antikinks in turn, so far apart that their sum solves the field equation up to their tails. Places and
/// speeds are drawn from the seed, r and r′ uniform in [−1, 1):
///
///     φ = f(−∞) + Σ_{j even} (f(s_j) − f(−∞)) + Σ_{j odd} (f(−s_j) − f(+∞)),   s_j = γ_j (x − x_j − v_j t),
///     x_j = (j + ½ + ¼ r_j) L/n,   v_j = r′_j v,   f the kink of the theory
///
class KinkGas final : public State {
 public:
  KinkGas(const Lattice& lattice, int count, double fastest, std::uint64_t seed, std::unique_ptr<KinkProfile> profile)
      : profile_(std::move(profile)), count_(count), fastest_(fastest), seed_(seed) {
    std::mt19937_64 generator(seed);
    // the top 53 bits, the same with every library
    const auto uniform = [&] { return 2 * std::ldexp(static_cast<double>(generator() >> 11), -53) - 1; };
    const double L = lattice.length(), spacing = L / count;
    std::vector<Kink> kinks;
    for (int j = 0; j < count; ++j) {
      const double x = (j + 0.5 + 0.25 * uniform()) * spacing, v = uniform() * fastest;
      kinks.push_back({x, v, lorentz_factor(v), j % 2 == 0});
    }
    // a circle repeats them on either side
    for (int turn = lattice.is_circle() ? -1 : 0; turn <= (lattice.is_circle() ? 1 : 0); ++turn)
      for (Kink kink : kinks) kink.x += turn * L, kinks_.push_back(kink);
  }

  void at(double t, double x, std::span<FieldPoint> out) const override {
    // tails beyond this distance are below rounding, at γ ≥ 1
    const double far = 40 / profile_->tail_rate() + fastest_ * std::abs(t);
    auto kink = std::ranges::lower_bound(kinks_, x - far, {}, &Kink::x);
    // left of all kinks that are near: the vacuum that the first of them begins in
    const double lower = 2 * profile_->f(0) - profile_->upper(), upper = profile_->upper();
    const bool below = kink == kinks_.end() ? kinks_.back().falls() : kink->rises;
    FieldPoint sum{below ? lower : upper, 0, 0};
    for (; kink != kinks_.end() && kink->x < x + far; ++kink) {
      const double sign = kink->rises ? 1 : -1, s = sign * kink->gamma * (x - kink->x - kink->v * t);
      const double slope = sign * kink->gamma * profile_->slope(s);
      sum.phi += profile_->f(s) - (kink->rises ? lower : upper);
      sum.phi_t -= kink->v * slope;
      sum.phi_x += slope;
    }
    out[0] = sum;
  }
  bool exact() const override { return false; }
  bool knows_second_row() const override { return true; }
  std::string description() const override {
    return std::to_string(count_) + " kinks and antikinks in turn, at random places and speeds up to " +
           text(fastest_) + ", f(s) = " + profile_->formula() + ", seed = " + std::to_string(seed_);
  }

 private:
  struct Kink {
    double x, v, gamma;
    bool rises;
    bool falls() const { return !rises; }
  };
  std::unique_ptr<KinkProfile> profile_;
  int count_;
  double fastest_;
  std::uint64_t seed_;
  std::vector<Kink> kinks_;  ///< from left to right
};

std::unique_ptr<State> kink_gas(const StateBuild& build) {
  const std::string key = "initial.kinks";
  const double n = build.number(key), L = build.lattice.length(), v = subluminal(build, "kink");
  if (n != std::round(n) || n < 1)
    throw BadInput(key, key + " = " + text(n) + ": the number of kinks and antikinks; choose an integer from 1 up");
  if (build.lattice.is_circle() && std::fmod(n, 2) != 0)
    throw BadInput(key,
                   key + " = " + text(n) + ": around a circle kinks and antikinks take turns; choose an even number");
  // two kinks are at least ½ L/n apart; neither reaches the other
  auto profile = kink_profile(build);
  const double room = 2 * reach(profile->tail_factor(), profile->tail_rate());
  if (!(L / n >= room))
    throw BadInput(key, key + " = " + text(n) + ": kinks a distance of " + text(L / n) +
                            " apart overlap; choose lattice.length >= " + text(std::ceil(room * n)) +
                            ", or fewer kinks");
  return std::make_unique<KinkGas>(build.lattice, static_cast<int>(n), v, build.request.seed, std::move(profile));
}

// 1/(γ rate) of the fastest
double kink_gas_width(const StateBuild& build) {
  return 1 / (lorentz_factor(subluminal(build, build.entry.name)) * kink_profile(build)->tail_rate());
}

std::vector<Parameter> kink_gas_parameters() {
  Parameter speed = speed_parameter(0.5);
  speed.help = "v: speeds are from -v to v, |v| < 1";
  return {{"initial.kinks", 10.0, "n: how many kinks and antikinks"}, speed};
}

}  // namespace
}  // namespace initial

extern const StateEntry kink_gas_state;
const StateEntry kink_gas_state{
    .name = "kink-gas",
    .formula =
        "n kinks and antikinks in turn, f(s) and f(-s), s = gamma (x - x0 - v t), at places and speeds drawn from run.seed",
    .parameters = initial::kink_gas_parameters(),
    .exact = {},
    .approximate = {"sine-gordon", "sine-gordon-impurity", "phi4", "double-sine-gordon"},
    .place = Place::line,
    .build = initial::kink_gas,
    .width = initial::kink_gas_width,
    .sources = {"delf"}};

}  // namespace delf
