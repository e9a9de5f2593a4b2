// SPDX-License-Identifier: MIT
#include "tools/stability/point_limits.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <chrono>
#include <cmath>
#include <optional>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/stability/symbol.hpp"
#include "schemes/state.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Pair = std::array<double, 2>;

/// The scheme on q_tt = −V′(q), as a theory of the library, or in phase space for schemes that take nothing else.
struct Model {
  const char *theory, *density;
};
constexpr Model oscillator{"harmonic-oscillator", "p*q_t - 0.5*p^2 - 0.5*q^2"},
    swinging{"pendulum", "p*q_t - 0.5*p^2 + cos(q)"};

Problem of_second_order(Problem p, const Model& model, double h) {
  p.theory = model.theory, p.circle_valued = false, p.time_step = h;
  p.parameters["theory.mass"] = 1.0;
  return p;
}
Problem in_phase_space(Problem p, const Model& model, double h) {
  p = of_second_order(std::move(p), model, h);
  p.theory = "text";
  p.parameters["theory.density"] = model.density, p.parameters["theory.fields"] = "q, p";
  return p;
}
bool takes_phase_space_alone(const Problem& scheme) {
  try {
    Simulation(of_second_order(scheme, oscillator, 0.1));
    return false;
  } catch (const BadInput&) {
    return true;
  }
}

/// A scheme of mechanics, as a problem for each h.
struct Mechanics {
  explicit Mechanics(const Problem& given) : scheme(given), phase_space(takes_phase_space_alone(given)) {}
  Problem with(const Model& model, double h) const {
    return phase_space ? in_phase_space(scheme, model, h) : of_second_order(scheme, model, h);
  }

  const Problem& scheme;
  bool phase_space;
};

/// True for methods of elements, which start from (q, p); others start from two rows, or in phase space from one.
bool by_momenta(const Problem& p) { return find_method(p.method).start == StartRule::legendre; }

/// Starts at (q, p), or with the rows y₀ and y₁.
void start(Simulation& s, const Problem& p, bool phase_space, const Pair& state) {
  std::vector<double> row, other;
  for (const Component& c : s.components()) {
    const bool field = c.role == Role::field, multiplier = c.role == Role::multiplier;
    row.push_back(multiplier ? 0 : state[phase_space ? at(c.field) : 0]);
    other.push_back(field ? state[1] : 0);
  }
  if (phase_space) s.start({row});
  else if (by_momenta(p)) s.start_momenta(row, other);
  else s.start({row, other});
}

double newest(const Simulation& s) {
  std::vector<double> values(s.count(Role::field));
  s.copy_row(0, values);
  return values[0];
}

/// The state a step later, which is linear in the state.
Pair stepped(const Problem& p, const Pair& state) {
  Simulation s(p);
  start(s, p, false, state);
  if (by_momenta(p)) return {newest(s), s.momenta().front()};
  s.step();
  return {state[1], newest(s)};
}

/// |tr M|/(1 + det M) of a step M: the roots of μ² − (tr M) μ + det M leave the unit circle where it is above 1, if
/// det M = 1, as it is of what has a Lagrangian. Of a step of more than two numbers, such as both traces of q and p, the
/// largest |μ|.
double growth(const Mechanics& scheme, double z) {
  const Problem p = scheme.with(oscillator, z);
  try {
    if (scheme.phase_space) return Symbol(Simulation(p).evolution().system()).amplification(0);
    const Pair a = stepped(p, {1, 0}), b = stepped(p, {0, 1});
    return std::abs(a[0] + b[1]) / (1 + a[0] * b[1] - a[1] * b[0]);
  } catch (const NumericalFailure&) {  // a step has no solution
    return infinity;
  }
}
constexpr double round_off = 1e-11;

/// The samples of the map: evenly, and at the highest point wherever it comes near 1 between two of these. There roots
/// meet on the circle, and leave it for a narrow interval or not at all.
std::vector<Pair> samples_of(const Mechanics& scheme, double most) {
  constexpr int count = 320;
  std::vector<Pair> all;
  for (int n = 0; n < count; ++n) {
    const double z = most * (n + 0.5) / count;
    all.push_back({z, growth(scheme, z)});
  }
  std::vector<Pair> between;
  for (std::size_t n = 1; n + 1 < all.size(); ++n) {
    if (all[n][1] > 1 || all[n][1] < 0.9 || all[n][1] < all[n - 1][1] || all[n][1] < all[n + 1][1]) continue;
    if (all[n][1] == all[n + 1][1]) continue;  // on the unit circle
    const auto below = [&](double z) { return -growth(scheme, z); };
    const auto [z, highest] = boost::math::tools::brent_find_minima(below, all[n - 1][0], all[n + 1][0], 40);
    between.push_back({z, -highest});
  }
  all.insert(all.end(), between.begin(), between.end());
  std::ranges::sort(all);
  return all;
}

std::vector<std::pair<double, double>> stable_intervals(const Mechanics& scheme, double most) {
  const auto stable = [](double half) { return half <= 1 + round_off; };
  const auto edge = [&](double in, double out) {
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (in + out);
      (stable(growth(scheme, middle)) ? in : out) = middle;
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

/// True if an oscillator stays where it can be.
bool stays(const Mechanics& scheme, double z, int steps) {
  const Problem p = scheme.with(oscillator, z);
  try {
    Simulation s(p);
    start(s, p, scheme.phase_space, {1, 0.3});
    for (int n = 0; n < steps; ++n) {
      s.step();
      if (!(std::abs(newest(s)) < 1e4)) return false;
    }
    return true;
  } catch (const NumericalFailure&) {
    return false;
  }
}

/// Finds the limit by running, near the one of theory, if it is there. Where stability returns soon, runs are checked
/// in the middle of the interval between, and are as long as its growth asks for, within reason.
void observe_limit(const Mechanics& scheme, double again, const PointRequest& request, PointFinding& f) {
  constexpr double folds = 20, longest = 100;
  double in = f.theory * (1 - request.agreement);
  double out = std::min(f.theory * (1 + request.agreement), 0.5 * (f.theory + again));
  const double rate = std::max(1.0, growth(scheme, out));
  const double steps = folds / (scheme.phase_space ? std::log(rate) : std::acosh(rate));
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

  Swing(const Mechanics& scheme, double h) : simulation(scheme.with(swinging, h)) {
    StateRequest request;
    request.name = "pendulum-swing", request.theory = "pendulum";
    state = make_state(request, Lattice::point());
    std::vector<double> q(1), v(1), later(1);
    state->values(0, Lattice::point(), q);
    state->velocities(0, Lattice::point(), v);
    state->values(h, Lattice::point(), later);
    // p = q_t
    start(simulation, scheme.scheme, scheme.phase_space,
          {q[0], scheme.phase_space || by_momenta(scheme.scheme) ? v[0] : later[0]});
  }
};

constexpr double swing_time = 10;

/// The largest error on the way, in n steps: at one time errors may cancel.
double swing_error(const Mechanics& scheme, int n) {
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
double order_of(const Mechanics& scheme) {
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

void find_cost(const Mechanics& scheme, PointFinding& f) {
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

PointFinding find_point_limit(const NamedScheme& named, const PointRequest& request) {
  PointFinding f{.scheme = named.name, .left_out = {}, .stable = {}};
  try {
    const Mechanics scheme(named.problem);
    f.stable = stable_intervals(scheme, request.most);
    f.theory = f.stable.empty() || f.stable[0].first > 0         ? 0
               : f.stable[0].second >= request.most * (1 - 1e-9) ? infinity
                                                                 : f.stable[0].second;
    f.theory *= request.theory_factor;
    if (std::isinf(f.theory)) {
      bool all = true;
      for (int n = 1; n <= 8; ++n) all = all && stays(scheme, request.most * (n - 0.37) / 8, request.steps);
      f.observed = all ? infinity : PointFinding::unknown;
      f.agrees = all;
    } else if (f.theory > 0) {
      const double again = f.stable.size() > 1 ? f.stable[1].first * request.theory_factor : infinity;
      observe_limit(scheme, again, request, f);
    }
    f.order = order_of(scheme);
    find_cost(scheme, f);
  } catch (const BadInput& bad) {
    f.left_out = bad.what();
  }
  return f;
}

}  // namespace delf
