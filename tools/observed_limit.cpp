// SPDX-License-Identifier: MIT
#include "tools/observed_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "lattice/error.hpp"
#include "tools/interrupt.hpp"

namespace delf {

namespace {

constexpr double noise = 1e-8;      // small enough for sin φ = φ
constexpr double blown_up = 1e6;    // no ghost that grows like the number of steps comes so far
constexpr double faster = 100;      // between two quarters of a run: steps³ makes it 13, steps 2
constexpr double like_steps = 1.7;  // 2 for what grows like the number of steps

double largest_field(const Simulation& simulation, std::vector<double>& row) {
  simulation.copy_row(0, row);
  double largest = 0;
  for (const double y : row)
    if (!(std::abs(y) <= largest)) largest = std::abs(y);
  return largest;
}

std::vector<std::vector<double>> random_rows(const Simulation& simulation, int sites, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<std::vector<double>> rows(static_cast<std::size_t>(simulation.starting_rows()));
  for (auto& row : rows) {
    row.resize(static_cast<std::size_t>(sites) * simulation.components().size());
    for (double& y : row) y = noise * (std::ldexp(static_cast<double>(generator() >> 11), -52) - 1);
  }
  return rows;
}

// The even number of sites near `sites` that best has the wave number θ among its own.
int sites_for(double theta, int sites) {
  int best = sites;
  double least = 1;
  for (int n = sites; n <= 4 * sites; n += 2) {
    const double waves = theta * n / (2 * std::numbers::pi), off = std::abs(waves - std::round(waves)) / n;
    if (off < 0.99 * least) least = off, best = n;
  }
  return best;
}

// Stable on N and on N − 1 sites, or not stable; and where theory knows of a narrow band of waves that grow, which fall
// between those that N sites have, on a circle that has them, for as long as it takes.
class Runs {
 public:
  Runs(const Problem& scheme, double mass_step, const LimitRequest& request)
      : scheme_(scheme), mass_step_(mass_step), request_(request) {}

  const ObservedGrowth& on(int sites, double courant, int steps = 0) {
    const auto [at, made] = done_.try_emplace({sites, courant});
    if (made)
      at->second = observe_growth(linear_problem(scheme_, mass_step_, courant, sites), std::max(steps, request_.steps),
                                  request_.seed);
    return at->second;
  }
  const ObservedGrowth& worst(double courant) {
    const ObservedGrowth* worst = &on(request_.sites, courant);
    if (worst->stable() && odd_)
      if (const ObservedGrowth& other = on(request_.sites - 1, courant); other.kind > worst->kind) worst = &other;
    if (!worst->stable()) return *worst;
    const WorstWave wave = worst_wave(scheme_, mass_step_, courant);
    if (!(wave.amplification > 1)) return *worst;
    const double needed = 4 * std::log(faster) / std::log(wave.amplification);
    const ObservedGrowth& other =
        on(sites_for(wave.theta, request_.sites), courant, static_cast<int>(std::min(needed, 200.0 * request_.steps)));
    return other.kind > worst->kind ? other : *worst;
  }
  void even_only() { odd_ = false; }

 private:
  const Problem& scheme_;
  double mass_step_;
  const LimitRequest& request_;
  std::map<std::pair<int, double>, ObservedGrowth> done_;
  bool odd_ = true;
};

double middle(const CourantInterval& i) { return 0.5 * (i.from + i.to); }

// Courant numbers to run at: a grid that knows nothing, and the middles of what theory calls stable and unstable.
std::vector<double> places(const LinearTheory& theory, const LimitRequest& request) {
  constexpr int grid = 24;
  std::vector<double> all;
  for (int i = 1; i <= grid; ++i) all.push_back(request.most * (i - 0.37) / grid);  // on no round number
  double end = 0;
  const auto add = [&](CourantInterval i) {
    if (i.to - i.from > 2 * request.agreement * i.to) all.push_back(middle(i));
  };
  for (const CourantInterval& i : theory.stable) {
    add({end, i.from});
    add(i);
    end = i.to;
  }
  add({end, request.most});
  std::ranges::sort(all);
  return all;
}

// Between a Courant number that is stable, or 0, and one that is not. Nothing stable at a thousandth of it: the limit is 0.
double bisected(Runs& runs, double stable, double unstable) {
  if (stable == 0) {
    stable = unstable / 1000;
    if (!runs.worst(stable).stable()) return 0;
  }
  while (unstable - stable > 0.003 * unstable && !Interrupt::asked()) {
    const double half = 0.5 * (stable + unstable);
    (runs.worst(half).stable() ? stable : unstable) = half;
  }
  return 0.5 * (stable + unstable);
}

void scale(LinearTheory& theory, double factor) {
  for (CourantInterval& i : theory.stable) i.from *= factor, i.to *= factor;
}

void compare(Limit& limit, const LimitRequest& request) {
  const auto told = [](double courant) { return std::isfinite(courant) ? fmt::format("{:.6g}", courant) : "none"; };
  const double difference = std::abs(limit.observed - limit.theory);
  const bool same =
      limit.observed == limit.theory || difference <= request.agreement * std::max(limit.observed, limit.theory);
  if (!same)
    limit.disagreements.push_back(fmt::format("{}, mh = {:g}: theory's limit is {}, and runs find {}", limit.scheme,
                                              limit.mass_step, told(limit.theory), told(limit.observed)));
  for (const Probe& p : limit.probes) {
    const bool stable = p.observed == Growth::bounded || p.observed == Growth::linear;
    if (p.observed != Growth::refused && stable != p.theory_stable)
      limit.disagreements.push_back(fmt::format("{}, mh = {:g}, h/k = {:.4g}: {} by theory, {} when run", limit.scheme,
                                                limit.mass_step, p.courant, p.theory_stable ? "stable" : "unstable",
                                                to_string(p.observed)));
  }
}

/// From random rows; where rows are not enough (a composition), from the first and the rates that lead to the second.
void start_from_noise(Simulation& simulation, const Problem& problem, std::uint64_t seed) {
  const auto rows = random_rows(simulation, problem.lattice.sites(), seed);
  try {
    simulation.start(rows);
  } catch (const BadInput& refused) {
    if (refused.key() != "initial.start" || rows.size() < 2) throw;
    std::vector<double> rates(rows[1]);
    for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (rates[i] - rows[0][i]) / problem.time_step;
    simulation.start_legendre(rows[0], rates);
  }
}

}  // namespace

const char* to_string(Growth growth) {
  switch (growth) {
    case Growth::bounded:
      return "bounded";
    case Growth::linear:
      return "grows linearly";
    case Growth::exponential:
      return "grows exponentially";
    case Growth::refused:
      return "refused";
  }
  return "";
}

ObservedGrowth observe_growth(const Problem& problem, int steps, std::uint64_t seed) {
  const double infinite = std::numeric_limits<double>::infinity();
  try {
    Simulation simulation(problem);
    start_from_noise(simulation, problem, seed);
    std::vector<double> row(static_cast<std::size_t>(problem.lattice.sites() * simulation.count(Role::field)));
    const int stride = std::max(1, steps / 256);
    double second = 0, fourth = 0;
    for (int n = 1; n <= steps; ++n) {
      const bool looked_at = n % stride == 0;
      simulation.step(looked_at);
      if (!looked_at) continue;
      const double largest = largest_field(simulation, row);
      if (!(largest < blown_up * noise)) return {Growth::exponential, std::log(largest / noise) / n, {}};
      if (4 * n > steps && 2 * n <= steps) second = std::max(second, largest);
      if (4 * n > 3 * steps) fourth = std::max(fourth, largest);
    }
    if (!(second > 0)) return {};  // friction, or nothing at all
    const double ratio = fourth / second, rate = std::log(ratio) / (0.5 * steps);
    return {ratio > faster ? Growth::exponential : ratio > like_steps ? Growth::linear : Growth::bounded, rate, {}};
  } catch (const NotFinite&) {
    return {Growth::exponential, infinite, {}};
  } catch (const NoConvergence& error) {
    return {Growth::refused, 0, error.what()};
  } catch (const BadInput& error) {
    return {Growth::refused, 0, error.what()};
  }
}

Limit find_limit(const std::string& name, const Problem& scheme, double mass_step, const LimitRequest& request) {
  Limit limit;
  limit.scheme = name;
  limit.mass_step = mass_step;
  const double infinite = std::numeric_limits<double>::infinity();
  try {
    limit.symbol = linear_theory(scheme, mass_step, request.most);
  } catch (const BadInput& error) {
    limit.left_out = error.what();
    return limit;
  }
  scale(limit.symbol, request.theory_factor);
  limit.theory = limit.symbol.first_limit(request.most);

  Runs runs(scheme, mass_step, request);
  bool odd = true;
  try {  // bricks close on an even number of sites only
    Simulation(linear_problem(scheme, mass_step, 0.5, request.sites - 1));
  } catch (const BadInput&) {
    odd = false;
    runs.even_only();
  }
  double below = 0;
  bool found = false;
  for (const double courant : places(limit.symbol, request)) {
    if (Interrupt::asked()) return limit;
    const Growth observed = runs.worst(courant).kind;
    if (limit.symbol.is_clear(courant, request.agreement))
      limit.probes.push_back({courant, limit.symbol.is_stable(courant), observed});
    if (observed == Growth::refused) {
      limit.left_out = runs.worst(courant).reason;
      if (!found && below == 0) return limit;
    }
    if (found || observed == Growth::refused) continue;
    if (observed == Growth::exponential) {
      limit.observed = bisected(runs, below, courant);
      found = true;
    } else {
      below = courant;
    }
  }
  if (!found) limit.observed = infinite;
  if (!limit.symbol.stable.empty()) {
    const double inside = middle(limit.symbol.stable.front());
    limit.even = runs.on(request.sites, inside).kind;
    if (odd) limit.odd = runs.on(request.sites - 1, inside).kind;
  }
  compare(limit, request);
  return limit;
}

}  // namespace delf
