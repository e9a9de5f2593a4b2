// SPDX-License-Identifier: MIT
#include "tools/stability/point_limits.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <chrono>
#include <cmath>
#include <optional>

#include "lattice/error.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/state.hpp"
#include "tools/run/seconds_since.hpp"

namespace delf {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Pair = std::array<double, 2>;

/// The scheme on a theory of one coordinate, with m = 1.
Problem with_theory(Problem p, const char* theory, double h) {
  p.theory = theory, p.circle_valued = false, p.time_step = h;
  p.parameters["theory.mass"] = 1.0;
  return p;
}

/// What a method of elements starts from is (q, p); other schemes start from two rows.
bool by_momenta(const Problem& p) { return find_method(p.method).start == StartRule::legendre; }

/// Starts at (q, p), or with the rows y₀ and y₁.
void start(Simulation& s, const Problem& p, const Pair& state) {
  std::vector<double> row, other;
  for (const Component& c : s.components()) {
    const bool field = c.role == Role::field;
    row.push_back(c.role == Role::multiplier ? 0 : state[0]);
    other.push_back(field ? state[1] : 0);
  }
  if (by_momenta(p)) s.start_momenta(row, other);
  else s.start({row, other});
}

double newest(const Simulation& s) {
  std::vector<double> q(1);
  s.copy_row(0, q);
  return q[0];
}

/// The state a step later, which is linear in the state.
Pair stepped(const Problem& p, const Pair& state) {
  Simulation s(p);
  start(s, p, state);
  if (by_momenta(p)) return {newest(s), s.momenta().front()};
  s.step();
  return {state[1], newest(s)};
}

/// |tr M|/(1 + det M) of a step M: the roots of μ² − (tr M) μ + det M leave the unit circle where it is above 1, if
/// det M = 1, as it is of what has a Lagrangian.
double half_trace(const Problem& scheme, double z) {
  const Problem p = with_theory(scheme, "harmonic-oscillator", z);
  try {
    const Pair a = stepped(p, {1, 0}), b = stepped(p, {0, 1});
    return std::abs(a[0] + b[1]) / (1 + a[0] * b[1] - a[1] * b[0]);
  } catch (const NumericalFailure&) {  // a step has no solution
    return infinity;
  }
}
constexpr double round_off = 1e-11;

/// Where it is looked at: evenly, and at the highest point wherever it comes near 1 between two of these. There roots meet
/// on the circle, and leave it for a narrow interval or not at all.
std::vector<Pair> samples_of(const Problem& scheme, double most) {
  constexpr int count = 320;
  std::vector<Pair> all;
  for (int n = 0; n < count; ++n) {
    const double z = most * (n + 0.5) / count;
    all.push_back({z, half_trace(scheme, z)});
  }
  std::vector<Pair> between;
  for (std::size_t n = 1; n + 1 < all.size(); ++n) {
    if (all[n][1] > 1 || all[n][1] < 0.9 || all[n][1] < all[n - 1][1] || all[n][1] < all[n + 1][1]) continue;
    const auto below = [&](double z) { return -half_trace(scheme, z); };
    const auto [z, highest] = boost::math::tools::brent_find_minima(below, all[n - 1][0], all[n + 1][0], 40);
    between.push_back({z, -highest});
  }
  all.insert(all.end(), between.begin(), between.end());
  std::ranges::sort(all);
  return all;
}

std::vector<std::pair<double, double>> stable_intervals(const Problem& scheme, double most) {
  const auto stable = [](double half) { return half <= 1 + round_off; };
  const auto edge = [&](double in, double out) {
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (in + out);
      (stable(half_trace(scheme, middle)) ? in : out) = middle;
    }
    return in;
  };
  std::vector<std::pair<double, double>> list;
  double before = 0;
  bool inside = false;
  for (const auto& [z, half] : samples_of(scheme, most)) {
    const bool now = stable(half);
    if (now && !inside) list.emplace_back(before == 0 ? 0 : edge(z, before), most);
    if (!now && inside) list.back().second = edge(before, z);
    inside = now, before = z;
  }
  return list;
}

/// Whether an oscillator stays where it can be.
bool stays(const Problem& scheme, double z, int steps) {
  const Problem p = with_theory(scheme, "harmonic-oscillator", z);
  try {
    Simulation s(p);
    start(s, p, {1, 0.3});
    for (int n = 0; n < steps; ++n) {
      s.step();
      if (!(std::abs(newest(s)) < 1e4)) return false;
    }
    return true;
  } catch (const NumericalFailure&) {
    return false;
  }
}

/// Finds the limit by running, near the one of theory, if it is there. Where stability returns soon, runs are looked at in
/// the middle of the interval between, and are as long as its growth asks for, within reason.
void observe_limit(const Problem& scheme, double again, const PointRequest& request, PointFinding& f) {
  constexpr double folds = 20, longest = 100;
  double in = f.theory * (1 - request.agreement);
  double out = std::min(f.theory * (1 + request.agreement), 0.5 * (f.theory + again));
  const double steps = folds / std::acosh(std::max(1.0, half_trace(scheme, out)));
  f.too_narrow = steps > longest * request.steps && again < f.theory * (1 + request.agreement);
  if (f.too_narrow) return;
  const int taken = static_cast<int>(std::clamp(steps, 1.0 * request.steps, longest * request.steps));
  f.agrees = stays(scheme, in, taken) && !stays(scheme, out, taken);
  if (!f.agrees) return;
  while (out - in > 0.05 * request.agreement * f.theory) {
    const double middle = 0.5 * (in + out);
    (stays(scheme, middle, taken) ? in : out) = middle;
  }
  f.observed = 0.5 * (in + out);
}

struct Swing {
  Simulation simulation;
  std::unique_ptr<State> state;

  Swing(const Problem& scheme, double h) : simulation(with_theory(scheme, "pendulum", h)) {
    StateRequest request;
    request.name = "pendulum-swing", request.theory = "pendulum";
    state = make_state(request, Lattice::point());
    std::vector<std::vector<double>> rows;
    const auto row = [&](double t, bool rate) {
      std::vector<double> one(1), all;
      if (rate) state->velocities(t, Lattice::point(), one);
      else state->values(t, Lattice::point(), one);
      for (const Component& c : simulation.components()) all.push_back(c.role == Role::multiplier ? 0 : one[0]);
      return all;
    };
    if (by_momenta(scheme)) simulation.start_legendre(row(0, false), row(0, true));
    else simulation.start({row(0, false), row(h, false)});
  }
};

constexpr double swing_time = 10;

/// The largest error on the way, in n steps: at one time errors may cancel.
double swing_error(const Problem& scheme, int n) {
  Swing swing(scheme, swing_time / n);
  std::vector<double> exact(1);
  double most = 0;
  while (swing.simulation.newest() < n) {
    swing.simulation.step();
    swing.state->values(static_cast<double>(swing.simulation.newest()) * swing_time / n, Lattice::point(), exact);
    most = std::max(most, std::abs(newest(swing.simulation) - exact[0]));
  }
  return most;
}

/// The slope of log error over log h, by least squares over the finest four numbers of steps that rounding does not reach.
double order_of(const Problem& scheme) {
  constexpr double far_from_rounding = 3e-13;  // for each step
  constexpr double refinement = 1.4;
  constexpr std::size_t points = 4;
  std::vector<Pair> logs;
  for (double n = 12; n < 400; n *= refinement) {
    const int steps = static_cast<int>(std::lround(n));
    const double error = swing_error(scheme, steps);
    if (error < steps * far_from_rounding && logs.size() >= 2) break;
    logs.push_back({std::log(swing_time / steps), std::log(error)});
  }
  if (logs.size() > points) logs.erase(logs.begin(), logs.end() - points);
  // (n Σuv − Σu Σv)/(n Σu² − (Σu)²)
  double count = 0, u = 0, v = 0, uu = 0, uv = 0;
  for (const auto& [x, y] : logs) count += 1, u += x, v += y, uu += x * x, uv += x * y;
  return (count * uv - u * v) / (count * uu - u * u);
}

void find_cost(const Problem& scheme, PointFinding& f) {
  constexpr int steps = 2000, rounds = 3;
  double best = infinity, iterations = 0;
  for (int round = 0; round < rounds; ++round) {
    Swing swing(scheme, 0.1);
    iterations = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (int n = 0; n < steps; ++n) swing.simulation.step(), iterations += swing.simulation.iterations();
    best = std::min(best, seconds_since(begin));
  }
  f.microseconds = 1e6 * best / steps, f.iterations = iterations / steps;
}

}  // namespace

PointFinding find_point_limit(const NamedScheme& scheme, const PointRequest& request) {
  PointFinding f{.scheme = scheme.name, .left_out = {}, .stable = {}};
  try {
    f.stable = stable_intervals(scheme.problem, request.most);
    f.theory = f.stable.empty() || f.stable[0].first > 0         ? 0
               : f.stable[0].second >= request.most * (1 - 1e-9) ? infinity
                                                                 : f.stable[0].second;
    f.theory *= request.theory_factor;
    if (std::isinf(f.theory)) {
      bool all = true;
      for (int n = 1; n <= 8; ++n) all = all && stays(scheme.problem, request.most * (n - 0.37) / 8, request.steps);
      f.observed = all ? infinity : PointFinding::unknown;
      f.agrees = all;
    } else if (f.theory > 0) {
      const double again = f.stable.size() > 1 ? f.stable[1].first * request.theory_factor : infinity;
      observe_limit(scheme.problem, again, request, f);
    }
    f.order = order_of(scheme.problem);
    find_cost(scheme.problem, f);
  } catch (const BadInput& bad) {
    f.left_out = bad.what();
  }
  return f;
}

}  // namespace delf
