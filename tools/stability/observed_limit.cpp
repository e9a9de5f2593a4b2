// SPDX-License-Identifier: MIT
#include "tools/stability/observed_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "tools/report/interrupt.hpp"

namespace delf {

namespace {

constexpr double noise_size = 1e-8;         // small enough for sin φ = φ
constexpr double exponential_growth = 1e6;  // no ghost that grows like the number of steps comes so far
constexpr double faster = 100;              // between two quarters of a run: steps³ makes it 13, steps 2
constexpr double like_steps = 1.7;          // 2 for what grows like the number of steps

double largest_field(const Simulation& simulation, std::vector<double>& row) {
  simulation.copy_row(0, row);
  double largest = 0;
  for (const double y : row)
    if (!(std::abs(y) <= largest)) largest = std::abs(y);
  return largest;
}

std::vector<std::vector<double>> random_rows(const Simulation& simulation, int sites, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<std::vector<double>> rows(simulation.starting_rows());
  for (auto& row : rows) {
    row.resize(delf::at(sites) * simulation.components().size());
    for (double& y : row) y = noise_size * (std::ldexp(static_cast<double>(generator() >> 11), -52) - 1);
  }
  return rows;
}

// A wave that grows |z|-fold a step is seen to grow for certain when it has grown faster⁴-fold: by `faster` from one
// quarter to the next, whatever else there is.
double steps_for(double growth) { return 4 * std::log(faster) / growth; }

// Runs at one Courant number, as far as was needed to see whether it is stable.
struct Look {
  ObservedGrowth seen;
  int sites = 0, steps = 0;
  double growth = 0;  // theory, of this circle
  std::optional<Unresolved> unresolved;
  std::string contradiction;  // of a run, and theory on its circle
};

// On N and on N − 1 sites; if both are stable, and theory knows of waves that grow, on a circle that has them, for as
// long as it takes.
class Runs {
 public:
  Runs(const LinearWaves& waves, const LimitRequest& request)
      : waves_(waves), request_(request), odd_(closes_on(waves, request.sites - 1)) {}

  bool has_odd() const { return odd_; }
  Growth on(int sites, double courant) const { return grown(sites, courant, request_.steps).kind; }
  const Look& at(double courant) {
    const auto [known, made] = done_.try_emplace(courant);
    if (made) look(courant, known->second);
    return known->second;
  }

 private:
  ObservedGrowth grown(int sites, double courant, int steps) const {
    return observe_growth(waves_.on_circle(courant, sites), steps, request_.seed);
  }

  void look(double courant, Look& look) const {
    const WaveGrowth waves(waves_, courant / request_.waves_factor);
    const bool some_grow = waves.of_all().amplification > 1;
    run(courant, request_.sites, request_.steps, some_grow ? waves.on_circle(request_.sites) : WorstWave{}, look);
    if (odd_ && look.seen.stable())
      run(courant, request_.sites - 1, request_.steps, some_grow ? waves.on_circle(request_.sites - 1) : WorstWave{},
          look);
    if (!some_grow || !look.seen.stable()) return;

    const int sites = waves.best_circle(request_.sites, 16 * request_.sites, odd_ ? 1 : 2);
    const WorstWave wave = waves.on_circle(sites);
    const double steps = std::ceil(steps_for(wave.rate()));
    if (!(steps * sites <= request_.work * request_.steps * request_.sites)) {
      look.unresolved = {courant, waves.of_all().theta, waves.of_all().rate(), sites, steps};
      return;
    }
    run(courant, sites, std::max(static_cast<int>(steps), request_.steps), wave, look);
  }

  // Keeps what has grown most.
  void run(double courant, int sites, int steps, const WorstWave& wave, Look& look) const {
    const ObservedGrowth seen = grown(sites, courant, steps);
    const bool must_grow = steps >= steps_for(wave.rate()), cannot = steps * wave.rate() < 1;
    if (seen.kind != Growth::refused && (seen.stable() ? must_grow : cannot))
      look.contradiction = fmt::format(
          "{} sites, {} steps: {} by theory of these sites, {} when run", sites, steps,
          cannot ? "nothing grows"
                 : fmt::format("theta = {:.6g} grows, |z| - 1 = {:.3g},", wave.theta, wave.amplification - 1),
          to_string(seen.kind));
    if (look.sites == 0 || seen.kind >= look.seen.kind)
      look.seen = seen, look.sites = sites, look.steps = steps, look.growth = wave.rate();
  }

  const LinearWaves& waves_;
  const LimitRequest& request_;
  std::map<double, Look> done_;
  bool odd_;
};

double middle(const CourantInterval& i) { return 0.5 * (i.from + i.to); }

// A Courant number to run at; clear: not so near to an end of an interval that theory and runs may differ.
struct Place {
  double courant;
  bool clear;
};

// A grid that knows nothing, and the middles of what theory calls stable and unstable, however narrow.
std::vector<Place> places(const LinearTheory& theory, const LimitRequest& request) {
  constexpr double rounding = 1e-6;  // ends are known to 1e-8
  std::vector<Place> all;
  for (int i = 1; i <= request.grid; ++i) {
    const double courant = request.most * (i - 0.37) / request.grid;  // on no round number
    all.push_back({courant, theory.is_clear(courant, request.agreement)});
  }
  double end = 0;
  const auto add = [&](CourantInterval i) {
    if (i.to - i.from > rounding * i.to) all.push_back({middle(i), true});
  };
  for (const CourantInterval& i : theory.stable) {
    add({end, i.from});
    add(i);
    end = i.to;
  }
  add({end, request.most});
  std::ranges::sort(all, {}, &Place::courant);
  return all;
}

// Between a Courant number that is stable, or 0, and one that is not. Nothing stable at a thousandth of it: the limit is 0.
double bisected(Runs& runs, double stable, double unstable) {
  if (stable == 0) {
    stable = unstable / 1000;
    if (!runs.at(stable).seen.stable()) return 0;
  }
  while (unstable - stable > 0.003 * unstable && !Interrupt::asked()) {
    const double half = 0.5 * (stable + unstable);
    (runs.at(half).seen.stable() ? stable : unstable) = half;
  }
  return 0.5 * (stable + unstable);
}

void scale(LinearTheory& theory, double factor) {
  for (CourantInterval& i : theory.stable) i.from *= factor, i.to *= factor;
}

// True if runs find a limit above theory's because nothing unstable between them grows so that a run could tell.
bool unresolved_between(Runs& runs, const Limit& limit, const LimitRequest& request) {
  constexpr int points = 4;  // of each unstable interval
  const double most = std::min(limit.observed * (1 - request.agreement), request.most);
  if (!(limit.theory < most)) return false;
  double from = 0;
  const auto unresolved = [&](double to) {
    to = std::min(to, most);
    for (int i = 0; i < points && from < to; ++i)
      if (!runs.at(from + (to - from) * (i + 0.5) / points).unresolved) return false;
    return true;
  };
  for (const CourantInterval& i : limit.symbol.stable) {
    if (!unresolved(i.from)) return false;
    from = i.to;
  }
  return unresolved(most);
}

void compare_limits(Runs& runs, Limit& limit, const LimitRequest& request) {
  const auto shown = [](double courant) { return std::isfinite(courant) ? fmt::format("{:.6g}", courant) : "none"; };
  const double observed = std::min(limit.observed, request.most), theory = std::min(limit.theory, request.most);
  if (std::abs(observed - theory) <= request.agreement * std::max(observed, theory)) return;
  limit.limit_unresolved = unresolved_between(runs, limit, request);
  if (!limit.limit_unresolved)
    limit.disagreements.push_back(fmt::format("{}, {}: theory's limit is {}, and runs find {}", limit.scheme,
                                              limit.waves, shown(limit.theory), shown(limit.observed)));
}

void compare(Runs& runs, Limit& limit, const Place& place) {
  const Look& look = runs.at(place.courant);
  const bool stable = limit.symbol.is_stable(place.courant);
  if (look.unresolved) limit.unresolved.push_back(*look.unresolved);
  if (place.clear)
    limit.probes.push_back(
        {place.courant, stable, look.seen.kind, look.sites, look.steps, look.growth, !look.unresolved});
  if (look.seen.kind == Growth::refused) return;
  const auto where = [&] { return fmt::format("{}, {}, h/k = {:.6g}", limit.scheme, limit.waves, place.courant); };
  if (place.clear && look.seen.stable() != stable && !look.unresolved)
    limit.disagreements.push_back(fmt::format("{}: {} by theory, {} when run, {} sites, {} steps", where(),
                                              stable ? "stable" : "unstable", to_string(look.seen.kind), look.sites,
                                              look.steps));
  else if (!look.contradiction.empty()) limit.disagreements.push_back(where() + ", " + look.contradiction);
}

Limit unknown_limit(const std::string& name, const LinearWaves& waves) {
  Limit limit;
  limit.scheme = name;
  limit.mass_step = waves.mass_step;
  limit.waves = waves.in_words();
  return limit;
}

/// Starts from random rows; where rows are not enough (a composition), from the first and the rates of the second.
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

bool closes_on(const LinearWaves& waves, int sites) {
  try {
    Simulation(waves.on_circle(0.5, sites));
    return true;
  } catch (const BadInput&) {
    return false;
  }
}

ObservedGrowth observe_growth(const Problem& problem, int steps, std::uint64_t seed) {
  const double infinite = std::numeric_limits<double>::infinity();
  try {
    Simulation simulation(problem);
    start_from_noise(simulation, problem, seed);
    std::vector<double> row(problem.lattice.sites() * simulation.count(Role::field));
    const int stride = std::max(1, steps / 256);
    double second = 0, fourth = 0;
    for (int n = 1; n <= steps; ++n) {
      const bool looked_at = n % stride == 0;
      simulation.step(looked_at);
      if (!looked_at) continue;
      const double largest = largest_field(simulation, row);
      if (!(largest < exponential_growth * noise_size))
        return {Growth::exponential, std::log(largest / noise_size) / n, {}};
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

double LimitRequest::least_growth() const { return steps_for(1) / (work * steps); }

Limit find_limit(const std::string& name, const LinearWaves& waves, const LimitRequest& request) {
  LinearTheory theory;
  try {
    theory = linear_theory(waves, request.most, request.samples);
    if (theory.stable.empty())
      if (const WorstWave worst = WaveGrowth(waves, 0.5 * request.most).of_all(); std::isinf(worst.amplification))
        throw BadInput("", fmt::format("on a circle no step determines the waves of theta = {:.4g}", worst.theta));
  } catch (const BadInput& error) {
    Limit limit = unknown_limit(name, waves);
    limit.left_out = error.what();
    return limit;
  }
  scale(theory, request.theory_factor);
  return compare_with_runs(name, waves, theory, request);
}

Limit compare_with_runs(const std::string& name, const LinearWaves& waves, const LinearTheory& intervals,
                        const LimitRequest& request) {
  Limit limit = unknown_limit(name, waves);
  limit.symbol = intervals;
  limit.theory = intervals.first_limit(request.most);
  Runs runs(waves, request);
  double below = 0;
  bool found = false;
  for (const Place& place : places(limit.symbol, request)) {
    if (Interrupt::asked()) return limit;
    compare(runs, limit, place);
    const ObservedGrowth& seen = runs.at(place.courant).seen;
    if (seen.kind == Growth::refused) {
      limit.left_out = seen.reason;
      if (!found && below == 0) return limit;
    }
    if (found || seen.kind == Growth::refused) continue;
    if (seen.kind == Growth::exponential) {
      limit.observed = bisected(runs, below, place.courant);
      found = true;
    } else {
      below = place.courant;
    }
  }
  if (!found) limit.observed = std::numeric_limits<double>::infinity();
  if (!limit.symbol.stable.empty()) {
    const double inside = middle(limit.symbol.stable.front());
    limit.even = runs.on(request.sites, inside);
    if (runs.has_odd()) limit.odd = runs.on(request.sites - 1, inside);
  }
  compare_limits(runs, limit, request);
  return limit;
}

}  // namespace delf
