// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
namespace {

/// E − e sin E = M for |M| ≤ π, by Newton's method, and by halves where it would leave the bracket.
double eccentric_anomaly(double mean_anomaly, double e) {
  // |M| ≤ |E| ≤ min(|M| + e, π)
  const double M = std::abs(mean_anomaly);
  if (M == 0) return 0;
  double low = M, high = std::min(M + e, std::numbers::pi), E = high;
  for (int i = 0; i < 100; ++i) {
    const double excess = E - e * std::sin(E) - M;
    (excess > 0 ? high : low) = E;
    double next = E - excess / (1 - e * std::cos(E));
    if (!(next >= low && next <= high)) next = low + (high - low) / 2;
    if (next == E) break;
    E = next;
  }
  return std::copysign(E, mean_anomaly);
}

/// The ellipse of semi-major axis 1 around its focus, from the pericentre at t = 0, one turn in 2π:
///
///     q = (cos E − e, √(1 − e²) sin E),   E − e sin E = t,   E_t = 1/(1 − e cos E)
///
class KeplerOrbit final : public State {
 public:
  explicit KeplerOrbit(double eccentricity) : e(eccentricity), minor(std::sqrt((1 - e) * (1 + e))) {}

  int components() const override { return 2; }
  void values(double t, const Lattice&, std::span<double> out) const override {
    const double E = anomaly(t);
    out[0] = (1 - e) - versine(E);
    out[1] = minor * std::sin(E);
  }
  void velocities(double t, const Lattice&, std::span<double> out) const override {
    const double E = anomaly(t), rate = 1 / ((1 - e) + e * versine(E));
    out[0] = -rate * std::sin(E);
    out[1] = rate * minor * std::cos(E);
  }
  bool exact() const override { return true; }
  std::string description() const override {
    return "kepler-orbit: q = (cos E - e, sqrt(1 - e^2) sin E), E - e sin E = t, e = " + text(e);
  }

 private:
  // 1 − cos E = 2 sin²(E/2), without the loss near the pericentre
  static double versine(double E) { return 2 * std::sin(E / 2) * std::sin(E / 2); }
  double anomaly(double t) const { return eccentric_anomaly(std::remainder(t, 2 * std::numbers::pi), e); }

  double e, minor;
};

}  // namespace

std::unique_ptr<State> kepler_orbit(const StateRequest& request, const Lattice&) {
  const double e = finite("initial.eccentricity", request.eccentricity, 0.6);
  if (!(e >= 0 && e < 1))
    throw BadInput("initial.eccentricity",
                   "initial.eccentricity = " + text(e) + ": the orbit does not close; choose 0 <= eccentricity < 1");
  return std::make_unique<KeplerOrbit>(e);
}

}  // namespace delf::initial
