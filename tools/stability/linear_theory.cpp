// SPDX-License-Identifier: MIT
#include "tools/stability/linear_theory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "schemes/monodromy.hpp"
#include "schemes/stability/dispersion.hpp"
#include "schemes/stability/linear_stability.hpp"
#include "schemes/stability/stable_set.hpp"
#include "schemes/stepping/evolution.hpp"

namespace delf {

namespace {

constexpr int sites = 32;  // of a circle that is only asked for its equations: bricks close, wide stencils find room

LatticeSystem system_of(const Problem& problem) { return Simulation(problem).evolution().system(); }

}  // namespace

LinearTheory linear_theory(const LinearWaves& waves, double most, int samples) {
  const auto make = [&](double courant) { return system_of(waves.on_circle(courant, sites)); };
  StableSearch search;
  search.samples = samples;
  search.tolerance = 3e-9 * most;
  LinearTheory theory;
  for (const StableInterval& i : stable_courants(make, most, search)) theory.stable.push_back({i.from, i.to});
  if (theory.stable.empty()) return theory;
  const double inside = 0.5 * (theory.stable.front().from + theory.stable.front().to);
  for (const Ghost& g : linear_stability(make(inside)).ghosts) theory.ghosts.push_back({g.theta, g.z, g.words});
  return theory;
}

WaveGrowth::WaveGrowth(const LinearWaves& waves, double courant) : symbol_(system_of(waves.on_circle(courant, sites))) {
  const StabilityVerdict v = linear_stability(symbol_);
  worst_ = {v.worst_theta, v.amplification};
}

WorstWave WaveGrowth::nearest(int n) const {
  const double theta = 2 * std::numbers::pi * std::round(worst_.theta * n / (2 * std::numbers::pi)) / n;
  return {theta, symbol_.amplification(theta)};
}

WorstWave WaveGrowth::on_circle(int n) const {
  WorstWave worst;
  for (int j = 0; 2 * j <= n; ++j) {
    const double theta = 2 * std::numbers::pi * j / n, amplification = symbol_.amplification(theta);
    if (amplification > worst.amplification) worst = {theta, amplification};
  }
  return worst;
}

int WaveGrowth::best_circle(int least, int most, int stride) const {
  int best = least;
  double fewest = std::numeric_limits<double>::infinity(), nearest_yet = fewest;
  for (int n = least; n <= most; n += stride) {
    const WorstWave wave = nearest(n);
    const double off = std::abs(wave.theta - worst_.theta);
    if (off >= nearest_yet) continue;  // more sites, and no nearer
    nearest_yet = off;
    if (const double updates = n / wave.rate(); updates < fewest) fewest = updates, best = n;
  }
  return best;
}

std::vector<FrequencyPoint> frequencies(const Problem& scheme, double courant, double mass_space_step, int count) {
  const double mass_step = mass_space_step * courant;
  std::vector<FrequencyPoint> points;
  for (const DispersionPoint& p :
       dispersion(Symbol(system_of(LinearWaves{scheme, mass_step}.on_circle(courant, sites))), mass_step, count))
    points.push_back({p.wave_number, p.numerical / courant, p.exact / courant});
  return points;
}

double LinearTheory::first_limit(double most) const {
  if (stable.empty() || stable.front().from > 1e-3 * most) return 0;
  return stable.front().to >= most * (1 - 1e-9) ? std::numeric_limits<double>::infinity() : stable.front().to;
}

bool LinearTheory::is_stable(double courant) const {
  return std::ranges::any_of(stable, [&](const CourantInterval& i) { return courant >= i.from && courant <= i.to; });
}

bool LinearTheory::is_clear(double courant, double relative) const {
  return std::ranges::none_of(stable, [&](const CourantInterval& i) {
    return std::abs(courant - i.from) <= relative * i.from || std::abs(courant - i.to) <= relative * i.to;
  });
}

Problem LinearWaves::on_circle(double courant, int sites) const {
  Problem p = scheme;
  p.circle_valued = false;
  p.winding = 0, p.parameters[gain_key] = 0.0;
  const double k = mass_step ? 1 / courant : scheme.lattice.space_step();
  p.time_step = courant * k;
  p.lattice = Lattice::circle(sites, sites * k);
  if (!mass_step) return p;
  p.theory = "klein-gordon";
  p.parameters["theory.mass"] = *mass_step;
  p.time_step = 1;
  return p;
}

std::string LinearWaves::in_words() const {
  return mass_step ? fmt::format("mh = {:g}", *mass_step) : fmt::format("k = {:.4g}", scheme.lattice.space_step());
}

}  // namespace delf
