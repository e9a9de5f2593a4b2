// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/pulse.hpp"
#include "schemes/states/scaled_hyperbolic.hpp"

namespace delf::initial {
namespace {

/// Two pulses of sine-Gordon that come together with speeds ±v around a centre at rest: with
/// a = γm(vt − d/2), b = γm(x − x₀), tan(φ/4) = F/G.
struct Pair {
  double position, speed, separation, mass;

  double gamma() const { return lorentz_factor(speed); }
  double a(double t) const { return gamma() * mass * (speed * t - separation / 2); }
  double b(double s) const { return gamma() * mass * s; }
  double a_t() const { return gamma() * mass * speed; }
  std::string text() const {
    return "a = gamma m (v t - d/2), b = gamma m (x - x0), x0 = " + initial::text(position) +
           ", v = " + initial::text(speed) + ", d = " + initial::text(separation) + ", m = " + initial::text(mass);
  }
};

class KinkAntikink final : public Pulse {
 public:
  KinkAntikink(const Lattice& l, const StateRequest& r, const PulseFrame& f, const Pair& p) : Pulse(l, r, f), pair(p) {}

 protected:
  // φ = 4 atan( sinh a/(v cosh b) ),   φ_t = 4 F_t G/(F² + G²)
  FieldPoint at(double t, double s) const override {
    const double a = pair.a(t), b = pair.b(s), M = std::max(std::abs(a), std::abs(b));
    const double F = scaled_sinh(a, M), G = pair.speed * scaled_cosh(b, M), r = std::hypot(F, G);
    return {4 * std::atan2(F, G), 4 * pair.a_t() * (scaled_cosh(a, M) / r) * (G / r)};
  }
  std::string formula() const override {
    return "kink-antikink (the antikink on the left until they meet): phi = 4 atan(sinh a/(v cosh b)), " + pair.text();
  }

 private:
  Pair pair;
};

class KinkKink final : public Pulse {
 public:
  KinkKink(const Lattice& l, const StateRequest& r, const PulseFrame& f, const Pair& p) : Pulse(l, r, f), pair(p) {}

 protected:
  // φ = 4 atan( v sinh b/cosh a ),   φ_t = −4 F G_t/(F² + G²)                   Tyranowski–Desbrun (164)
  FieldPoint at(double t, double s) const override {
    const double a = pair.a(t), b = pair.b(s), M = std::max(std::abs(a), std::abs(b));
    const double F = pair.speed * scaled_sinh(b, M), G = scaled_cosh(a, M), r = std::hypot(F, G);
    return {4 * std::atan2(F, G), -4 * (F / r) * pair.a_t() * (scaled_sinh(a, M) / r)};
  }
  std::string formula() const override { return "kink-kink: phi = 4 atan(v sinh b/cosh a), " + pair.text(); }

 private:
  Pair pair;
};

Pair read(const StateRequest& request, const Lattice& lattice) {
  const double L = lattice.length(), v = subluminal(request, 0.5, "kink");
  if (!(v > 0))
    throw BadInput("initial.speed",
                   "initial.speed = " + text(v) + ": the two kinks come together at this speed; choose 0 < speed < 1");
  const double d = finite("initial.separation", request.separation, L / 4);
  if (!(d >= 0 && d < L))
    throw BadInput(
        "initial.separation",
        "initial.separation = " + text(d) + ": two kinks do not fit that way; choose 0 <= separation < lattice.length");
  return {centre(request, lattice), v, d, pulse_mass(request)};
}

// Away from the collision the pulses are at x₀ ± (|vt − d/2| + |ln v|/(γm)).
double lasts_until(const StateRequest& request, const Lattice& lattice, const Pair& pair) {
  if (request.theory == "sine-gordon-impurity") return 0;
  const double rate = pair.gamma() * pair.mass, L = lattice.length();
  const double to_the_edge = lattice.is_circle() ? L / 2 : std::min(pair.position, L - pair.position);
  const double room = to_the_edge - reach(4, rate) + std::log(pair.speed) / rate;
  return room < pair.separation / 2 ? 0.0 : (room + pair.separation / 2) / pair.speed;
}

}  // namespace

std::unique_ptr<State> kink_antikink(const StateRequest& request, const Lattice& lattice) {
  const Pair pair = read(request, lattice);
  const PulseFrame frame{pair.position, 0, 0, lasts_until(request, lattice, pair)};
  return std::make_unique<KinkAntikink>(lattice, request, frame, pair);
}

std::unique_ptr<State> kink_kink(const StateRequest& request, const Lattice& lattice) {
  const Pair pair = read(request, lattice);
  const PulseFrame frame{pair.position, 0, 2, lasts_until(request, lattice, pair)};
  return std::make_unique<KinkKink>(lattice, request, frame, pair);
}

}  // namespace delf::initial
