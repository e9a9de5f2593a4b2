// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/states/modes.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

// The top 53 bits of the generator as a number in [0, 1): the same with every library, unlike std's distributions.
double uniform(std::mt19937_64& generator) { return std::ldexp(static_cast<double>(generator() >> 11), -53); }

struct Mode {
  int n;
  double amplitude, phase;
};

/// Smooth noise around φ = 0 (it depends on the seed and the modes only, not on the number of sites):
///
///     φ(0) = S Σ_{n=1}^{M} (r_n/n) X_n,    φ_t(0) = S Σ_{n=1}^{M} (r′_n/n) q_n X′_n,    r, r′ uniform in [−1, 1),
///
/// X_n = cos(q_n x + phase) around a circle, the standing mode between walls, and S such that max |φ(0)| = A. Each
/// component has its own r, r′, phases and S.
class Noise final : public State {
 public:
  Noise(const Lattice& lattice, double amplitude, int most, std::uint64_t seed, int components)
      : modes_(lattice), circle_(lattice.is_circle()), A(amplitude), seed_(seed) {
    std::mt19937_64 generator(seed);
    for (int a = 0; a < components; ++a) fields_.push_back(draw(generator, lattice, most));
  }

  int components() const override { return static_cast<int>(fields_.size()); }
  void at(double, double x, std::span<FieldPoint> out) const override {
    for (std::size_t a = 0; a < fields_.size(); ++a) {
      const Field& f = fields_[a];
      out[a] = {f.scale * sum(f.value, x), f.scale * sum(f.velocity, x), f.scale * slope(f.value, x)};
    }
  }
  bool exact() const override { return false; }
  std::string description() const override {
    return "noise: " + std::to_string(fields_.front().value.size()) +
           " modes of random amplitude (falling as 1/n) and phase, max |phi| = " + text(A) +
           (fields_.size() > 1 ? " in each component" : "") + ", seed = " + std::to_string(seed_);
  }

 private:
  struct Field {
    std::vector<Mode> value, velocity;
    double scale = 0;
  };

  Field draw(std::mt19937_64& generator, const Lattice& lattice, int most) const {
    const auto mode = [&](int n, double decay) {
      const double r = 2 * uniform(generator) - 1;
      return Mode{n, r * decay, 2 * std::numbers::pi * uniform(generator)};
    };
    Field field;
    for (int n = 1; n <= most; ++n) {
      field.value.push_back(mode(n, 1.0 / n));
      field.velocity.push_back(mode(n, modes_.wavenumber(n) / n));
    }
    // max |φ| over a grid of 64 points to the shortest wave
    double highest = 0;
    const int points = 64 * most;
    for (int i = 0; i <= points; ++i)
      highest = std::max(highest, std::abs(sum(field.value, lattice.length() * i / points)));
    field.scale = highest > 0 ? A / highest : 0;
    return field;
  }
  double sum(const std::vector<Mode>& modes, double x) const {
    double total = 0;
    for (const Mode& mode : modes)
      total += mode.amplitude *
               (circle_ ? std::cos(modes_.wavenumber(mode.n) * x + mode.phase) : modes_.standing(mode.n, x));
    return total;
  }
  double slope(const std::vector<Mode>& modes, double x) const {
    double total = 0;
    for (const Mode& mode : modes) {
      const double q = modes_.wavenumber(mode.n);
      total += mode.amplitude * (circle_ ? -q * std::sin(q * x + mode.phase) : modes_.standing_slope(mode.n, x));
    }
    return total;
  }

  Modes modes_;
  bool circle_;
  double A;
  std::uint64_t seed_;
  std::vector<Field> fields_;  ///< one for each component
};

std::unique_ptr<State> noise(const StateBuild& build) {
  const std::string key = "initial.wavenumber";
  const double M = build.number(key);
  if (M != std::round(M) || M < 1)
    throw BadInput(key, key + " = " + text(M) + ": the number of modes in the noise; choose an integer from 1 up");
  // M < N/2
  const int most = std::max(1, static_cast<int>(std::min(M, static_cast<double>((build.lattice.sites() - 1) / 2))));
  return std::make_unique<Noise>(build.lattice, build.number("initial.amplitude"), most, build.request.seed,
                                 build.request.components);
}

Parameter modes() {
  Parameter p = wavenumber_parameter(8);
  p.help = "M: how many modes";
  return p;
}

}  // namespace
}  // namespace initial

extern const StateEntry noise_state;
const StateEntry noise_state{
    .name = "noise",
    .formula =
        "a sum of M smooth modes of random amplitude and phase, drawn from run.seed, scaled to max |phi| = A in each "
        "component",
    .parameters = {initial::amplitude_parameter(0.1), initial::modes()},
    .exact = {},
    .approximate = {},
    .place = Place::line,
    .build = initial::noise,
    .any_theory = true,
    .but = {"kepler", "solar-system", "wave-map", "spherical-pendulum"},
    .sources = {"delf"}};  // singular at 0; not on the sphere

}  // namespace delf
