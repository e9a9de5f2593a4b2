// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/pulse.hpp"
#include "schemes/states/scaled_hyperbolic.hpp"
#include "schemes/states/solitons/kink_profile.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// Two pulses, of sine-Gordon first, that come together with speeds ±v around a centre at rest: with
/// a = γm(vt − d/2), b = γm(x − x₀), tan(φ/4) = F/G. Of other theories m is the rate of the kink's tail.
struct Pair {
  double position, speed, separation, mass;

  double gamma() const { return lorentz_factor(speed); }
  double a(double t) const { return gamma() * mass * (speed * t - separation / 2); }
  double b(double s) const { return gamma() * mass * s; }
  double a_t() const { return gamma() * mass * speed; }
  double b_x() const { return gamma() * mass; }
  std::string text() const {
    return "a = gamma m (v t - d/2), b = gamma m (x - x0), x0 = " + initial::text(position) +
           ", v = " + initial::text(speed) + ", d = " + initial::text(separation) + ", m = " + initial::text(mass);
  }
};

class KinkAntikink final : public Pulse {
 public:
  KinkAntikink(const StateBuild& build, const PulseFrame& f, const Pair& p) : Pulse(build, f), pair(p) {}

 protected:
  // φ = 4 atan( sinh a/(v cosh b) ),   φ_t = 4 F_t G/(F² + G²),   φ_x = −4 F G_x/(F² + G²)
  FieldPoint pulse(double t, double s) const override {
    const double a = pair.a(t), b = pair.b(s), M = std::max(std::abs(a), std::abs(b));
    const double F = scaled_sinh(a, M), G = pair.speed * scaled_cosh(b, M), r = std::hypot(F, G);
    return {4 * std::atan2(F, G), 4 * pair.a_t() * (scaled_cosh(a, M) / r) * (G / r),
            -4 * (F / r) * pair.speed * pair.b_x() * (scaled_sinh(b, M) / r)};
  }
  std::string formula() const override {
    return "kink-antikink (the antikink on the left until they meet): phi = 4 atan(sinh a/(v cosh b)), " + pair.text();
  }

 private:
  Pair pair;
};

/// A kink f on the left and its mirror image on the right, come together with speeds ±v. Where the theory has no solution
/// of two kinks, this solves the field equation up to the tail of one at the other:
///
///     φ = f(γ(s + d/2 − vt)) + f(−γ(s − d/2 + vt)) − f(+∞),   s = x − x₀
///
class Superposed final : public Pulse {
 public:
  Superposed(const StateBuild& build, const PulseFrame& f, const Pair& p, std::unique_ptr<KinkProfile> profile)
      : Pulse(build, f), pair(p), profile_(std::move(profile)) {}

 protected:
  // φ_t = −γv (f′(left) + f′(right)),   φ_x = γ (f′(left) − f′(right))
  FieldPoint pulse(double t, double s) const override {
    const double gamma = pair.gamma(), half = pair.separation / 2 - pair.speed * t;
    const double left = gamma * (s + half), right = -gamma * (s - half);
    const double f_left = profile_->slope(left), f_right = profile_->slope(right);
    return {profile_->f(left) + profile_->f(right) - profile_->upper(), -gamma * pair.speed * (f_left + f_right),
            gamma * (f_left - f_right)};
  }
  // f(−∞) = 2 f(0) − f(∞): kinks are odd about their centres
  double vacuum() const override { return 2 * profile_->f(0) - profile_->upper(); }
  std::string formula() const override {
    return "kink-antikink (the kink on the left): phi = f(gamma (s + d/2 - v t)) + f(-gamma (s - d/2 + v t)) - f(inf), "
           "f(s) = " +
           profile_->formula() + ", x0 = " + text(pair.position) + ", v = " + text(pair.speed) +
           ", d = " + text(pair.separation);
  }

 private:
  Pair pair;
  std::unique_ptr<KinkProfile> profile_;
};

class KinkKink final : public Pulse {
 public:
  KinkKink(const StateBuild& build, const PulseFrame& f, const Pair& p) : Pulse(build, f), pair(p) {}

 protected:
  // φ = 4 atan( v sinh b/cosh a ),   φ_t = −4 F G_t/(F² + G²),   φ_x = 4 F_x G/(F² + G²)   Tyranowski–Desbrun (164)
  FieldPoint pulse(double t, double s) const override {
    const double a = pair.a(t), b = pair.b(s), M = std::max(std::abs(a), std::abs(b));
    const double F = pair.speed * scaled_sinh(b, M), G = scaled_cosh(a, M), r = std::hypot(F, G);
    return {4 * std::atan2(F, G), -4 * (F / r) * pair.a_t() * (scaled_sinh(a, M) / r),
            4 * pair.speed * pair.b_x() * (scaled_cosh(b, M) / r) * (G / r)};
  }
  std::string formula() const override { return "kink-kink: phi = 4 atan(v sinh b/cosh a), " + pair.text(); }

 private:
  Pair pair;
};

Pair read(const StateBuild& build) {
  const double L = build.lattice.length(), v = subluminal(build, "kink");
  if (!(v > 0))
    throw BadInput("initial.speed",
                   "initial.speed = " + text(v) + ": the two kinks come together at this speed; choose 0 < speed < 1");
  const double d = build.number("initial.separation", L / 4);
  if (!(d >= 0 && d < L))
    throw BadInput(
        "initial.separation",
        "initial.separation = " + text(d) + ": two kinks do not fit that way; choose 0 <= separation < lattice.length");
  return {centre(build), v, d, kink_profile(build)->tail_rate()};
}

// Away from the collision the pulses are at x₀ ± (|vt − d/2| + |ln v|/(γm)).
double pair_lasts_until(const StateBuild& build, const Pair& pair) {
  if (!build.exact) return 0;
  const double rate = pair.gamma() * pair.mass, L = build.lattice.length();
  const double to_the_edge = build.lattice.is_circle() ? L / 2 : std::min(pair.position, L - pair.position);
  const double room = to_the_edge - reach(4, rate) + std::log(pair.speed) / rate;
  return room < pair.separation / 2 ? 0.0 : (room + pair.separation / 2) / pair.speed;
}

template <class Pulses>
std::unique_ptr<State> kink_pair(const StateBuild& build, int winding) {
  const Pair pair = read(build);
  return std::make_unique<Pulses>(build, PulseFrame{pair.position, 0, winding, pair_lasts_until(build, pair)}, pair);
}

// The exact solution of integrable theories.
std::unique_ptr<State> kink_antikink(const StateBuild& build) {
  auto profile = kink_profile(build);
  if (profile->integrable()) return kink_pair<KinkAntikink>(build, 0);
  const Pair pair = read(build);
  return std::make_unique<Superposed>(build, PulseFrame{pair.position, 0, 0, 0}, pair, std::move(profile));
}

// 1/(γm)
double pair_width(const StateBuild& build) {
  const Pair pair = read(build);
  return 1 / (pair.gamma() * pair.mass);
}

std::vector<Parameter> pair_parameters() {
  Parameter separation = separation_parameter();
  separation.otherwise = "L/4";
  return {position_parameter(), speed_parameter(0.5), separation};
}

}  // namespace
}  // namespace initial

extern const StateEntry kink_antikink_state;
const StateEntry kink_antikink_state{
    .name = "kink-antikink",
    .formula =
        "4 atan(sinh(gamma m (v t - d/2))/(v cosh(gamma m (x - x0)))); phi4, double-sine-gordon: "
        "f(gamma (s + d/2 - v t)) + f(-gamma (s - d/2 + v t)) - f(inf), f their kink",
    .parameters = initial::pair_parameters(),
    .exact = {"sine-gordon"},
    .approximate = {"sine-gordon-impurity", "phi4", "double-sine-gordon"},
    .place = Place::line,
    .build = initial::kink_antikink,
    .width = initial::pair_width,
    .sources = {"perring-skyrme-1962", "campbell-schonfeld-wingate-1983", "campbell-peyrard-sodano-1986",
                "fei-kivshar-vazquez-1992"}};  // of each theory

extern const StateEntry kink_kink_state;
const StateEntry kink_kink_state{
    .name = "kink-kink",
    .formula = "4 atan(v sinh(gamma m (x - x0))/cosh(gamma m (v t - d/2)))",
    .parameters = initial::pair_parameters(),
    .exact = {"sine-gordon"},
    .approximate = {"sine-gordon-impurity"},
    .place = Place::line,
    .build = [](const StateBuild& build) { return initial::kink_pair<initial::KinkKink>(build, 2); },
    .width = initial::pair_width,
    .sources = {"perring-skyrme-1962", "fei-kivshar-vazquez-1992"}};

}  // namespace delf
