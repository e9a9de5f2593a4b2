// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
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
  void at(double t, double, std::span<FieldPoint> out) const override {
    const double E = anomaly(t), rate = 1 / ((1 - e) + e * versine(E));
    out[0] = {(1 - e) - versine(E), -rate * std::sin(E), 0};
    out[1] = {minor * std::sin(E), rate * minor * std::cos(E), 0};
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

std::unique_ptr<State> kepler_orbit(const StateBuild& build) {
  const double e = build.number("initial.eccentricity");
  if (!(e >= 0 && e < 1))
    throw BadInput("initial.eccentricity",
                   "initial.eccentricity = " + text(e) + ": the orbit does not close; choose 0 <= eccentricity < 1");
  return std::make_unique<KeplerOrbit>(e);
}

}  // namespace
}  // namespace initial

extern const StateEntry kepler_orbit_state;
const StateEntry kepler_orbit_state{.name = "kepler-orbit",
                                    .formula = "(cos E - e, sqrt(1 - e^2) sin E), E - e sin E = t",
                                    .parameters = {{"initial.eccentricity", 0.6, "e: eccentricity of an orbit"}},
                                    .exact = {"kepler"},
                                    .approximate = {},
                                    .place = Place::point,
                                    .build = initial::kepler_orbit,
                                    .sources = {"hairer-lubich-wanner-2006"}};

}  // namespace delf
