// SPDX-License-Identifier: MIT
#include "schemes/verify/reversal/time_reversal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/reversal/element_reversal.hpp"

namespace delf {
namespace {

using Row = std::vector<double>;
using Rows = std::vector<Row>;
using Values = std::vector<LatticeSystem::Value>;

// ---- the equations

Rows random_rows(const LatticeSystem& system, int count, double amplitude, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  Rows rows(delf::at(count), Row(delf::at(system.lattice().sites() * system.components())));
  for (Row& row : rows)
    for (double& y : row) y = amplitude * (2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0);
  return rows;
}

/// E at the middle one of these rows.
Values equations_in_the_middle(const LatticeSystem& system, std::int64_t first_row, Rows rows) {
  const std::int64_t middle = first_row + static_cast<std::int64_t>(rows.size() / 2);
  Values values;
  system.equations(system.window(first_row, std::move(rows), 0), middle, values);
  return values;
}

/// True for the same E up to rounding, or its negative, at every site that has an equation of a field.
bool agree(const LatticeSystem& system, const Values& one, const Values& other, double sign) {
  double scale = 0, difference = 0;
  for (std::size_t n = 0; n < one.size(); ++n) {
    const std::size_t C = system.components();
    if (system.component(static_cast<int>(n % C)).role == Role::multiplier) continue;
    if (system.lattice().is_fixed(static_cast<int>(n / C))) continue;
    scale = std::max({scale, one[n].absolute, other[n].absolute});
    difference = std::max(difference, std::abs(one[n].sum - sign * other[n].sum));
  }
  return difference <= 1e-11 * scale;
}

bool all_finite(const Values& values) {
  return std::ranges::all_of(values, [](const auto& value) { return std::isfinite(value.absolute); });
}

bool reads_place(const LatticeSystem& system) {
  return std::ranges::any_of(system.families(), [](const auto& family) { return family->is_placed(); });
}

/// A scheme without a Lagrangian has nothing else that could be said for it when it loses its way.
bool must_return(const LatticeSystem& system, const MakeSimulation& make) {
  constexpr std::uint64_t seed = 20260117;
  if (!is_variational(system)) return true;
  if (!reads_place(system)) return reversible(system, seed);
  return reversible(system, make(mirror_time(system))->evolution().system(), seed);
}

/// max_c Σ_a |∂E_c/∂y_a| of fields and nodes in the midst of space: what an error of the values makes of momenta.
double coefficients(const LatticeSystem& system) {
  double most = 0;
  for (int c = 0; c < system.components(); ++c) {
    const Role role = system.component(c).role;
    if (role != Role::field && role != Role::inner) continue;
    double sum = 0;
    for (const Coefficient& a : system.linearised({0, system.lattice().sites() / 2}, c)) sum += std::abs(a.value);
    most = std::max(most, sum);
  }
  return most;
}

// ---- rows

double largest(const Row& row) {
  double most = 0;
  for (const double y : row) most = std::max(most, std::abs(y));
  return most;
}

/// max |a − b|; not a number if there is one among them.
double largest_difference(const Rows& a, const Rows& b) {
  double most = 0;
  for (std::size_t r = 0; r < a.size(); ++r)
    for (std::size_t n = 0; n < a[r].size(); ++n) {
      const double difference = std::abs(a[r][n] - b[r][n]);
      if (!std::isnan(most) && !(difference <= most)) most = difference;
    }
  return most;
}

// ---- there and back

/// The way starts at rows 2 and 3. Given rows need not satisfy what rows must by themselves: a fixed wall that keeps
/// its value, a constraint, a wall whose equation has no inertia. No way back could find them again.
constexpr std::int64_t first_row = 2;

/// The whole state of a scheme: two rows of fields, or, of elements in time, a row and its momenta.
struct Ends {
  Row first, second;
  std::optional<double> density = {};  ///< of reversible steps: of the last one
};
struct TurningPoint {
  std::int64_t steps;
  Ends state;
  double time;  ///< of the newest row
};

/// The state as it is read, turned round, and begun from.
class Motion {
 public:
  Motion(const LatticeSystem& system, bool by_momenta)
      : by_momenta_(by_momenta), constrained_(std::ranges::any_of(system.all_components(), [](const Component& c) {
          return c.role == Role::multiplier && !c.momentum;
        })) {}

  Ends read(const Simulation& simulation) const {
    if (by_momenta_) {
      const LatticeSystem& system = simulation.evolution().system();
      Ends ends{simulation.evolution().stepper().row(0), simulation.momenta(), simulation.step_density()};
      for (std::size_t n = 0; n < ends.first.size(); ++n) {
        if (!is_of_row(system, n)) ends.first[n] = ends.second[n] = 0;
        if (is_held(system, n)) ends.second[n] = 0;  // the wall's own
      }
      return ends;
    }
    const auto size =
        delf::at(simulation.evolution().system().lattice().sites()) * delf::at(simulation.count(Role::field));
    Ends ends{Row(size), Row(size), simulation.step_density()};
    simulation.copy_row(1, ends.first);
    simulation.copy_row(0, ends.second);
    return ends;
  }
  /// (y_n, y_{n+1}) ↦ (y_{n+1}, y_n), (q, p) ↦ (q, −p)
  Ends mirrored(Ends ends) const {
    if (!by_momenta_) std::swap(ends.first, ends.second);
    else
      for (double& p : ends.second) p = -p;
    return ends;
  }
  /// Under a constraint, of the rows alone: momenta across its surface are the multiplier's.
  double distance(const Ends& a, const Ends& b) const {
    if (by_momenta_ && constrained_) return largest_difference({a.first}, {b.first});
    return largest_difference({a.first, a.second}, {b.first, b.second});
  }
  /// Begins from two rows; elements, and steps that rows choose, from the first, moved by the difference: any will do.
  void begin(Simulation& simulation, const Rows& rows) const {
    if (!by_momenta_ && !simulation.step_density()) return simulation.start(rows);
    Row velocity(rows[0].size());
    const double h = simulation.evolution().system().time_step();
    for (std::size_t n = 0; n < velocity.size(); ++n) velocity[n] = (rows[1][n] - rows[0][n]) / h;
    simulation.start_legendre(rows[0], velocity);
  }
  /// And so many steps on.
  void go(Simulation& simulation, const Ends& from, std::int64_t steps) const {
    std::int64_t made = 0;
    if (by_momenta_) {
      simulation.start_momenta(in_all_nodes(simulation.evolution().system(), from.first), from.second, from.density);
      made = simulation.newest();
    } else {
      simulation.start({all_components(simulation, from.first), all_components(simulation, from.second)}, from.density);
    }
    for (; made < steps; ++made) simulation.step();
  }

 private:
  static std::pair<int, int> place(const LatticeSystem& system, std::size_t n) {
    const std::size_t C = system.components();
    return {static_cast<int>(n / C), static_cast<int>(n % C)};
  }
  static bool is_held(const LatticeSystem& system, std::size_t n) {
    const auto [site, component] = place(system, n);
    return system.is_held(site, component);
  }
  /// A value at the row itself: no multiplier, no node between rows, and none beyond the last wall.
  static bool is_of_row(const LatticeSystem& system, std::size_t n) {
    const auto [site, component] = place(system, n);
    const Component& c = system.component(component);
    return c.at.time == 0 && (c.role == Role::field || c.role == Role::inner) &&
           !system.touching({0, site}, component).empty();
  }
  /// Puts the row's value into the nodes above it too: between rows a wall holds what it holds there.
  static Row in_all_nodes(const LatticeSystem& system, Row row) {
    for (std::size_t n = 0; n < row.size(); ++n) {
      const auto [site, component] = place(system, n);
      const Component& c = system.component(component);
      if (c.at.time == 0 || c.role != Role::inner) continue;
      for (int other = 0; other < system.components(); ++other) {
        const Component& below = system.component(other);
        const bool same = below.field == c.field && below.at.time == 0 && below.at.space == c.at.space;
        if (same && (below.role == Role::field || below.role == Role::inner))
          row[n] = row[n - delf::at(component) + delf::at(other)];
      }
    }
    return row;
  }
  /// A row of all components, with a zero for what is not a field: a start does not read it.
  static Row all_components(const Simulation& simulation, const Row& fields) {
    const auto& components = simulation.components();
    Row all;
    for (std::size_t at = 0; at < fields.size();)
      for (const Component& component : components) all.push_back(component.role == Role::field ? fields[at++] : 0.0);
    return all;
  }

  bool by_momenta_, constrained_;
};

/// 1, 2, 4, … and the last; bricks find their places again after an even number of steps.
std::vector<std::int64_t> turning_steps(std::int64_t last, bool bricks) {
  std::vector<std::int64_t> list;
  for (std::int64_t m = bricks ? 2 : 1; m <= last; m *= 2) list.push_back(m);
  if (!list.empty() && list.back() != last && !(bricks && last % 2 != 0)) list.push_back(last);
  return list;
}

std::string in_words(std::int64_t steps) { return steps == 1 ? "1 step" : fmt::format("{} steps", steps); }

/// The start, after 0 steps, and those turning points that the way forward reaches; `failure` says why it ends early.
std::vector<TurningPoint> forward(const Motion& motion, Simulation& simulation, const Rows& start_rows,
                                  const std::vector<std::int64_t>& planned, std::string& failure) {
  std::vector<TurningPoint> points;
  const auto reach_after = [&](std::int64_t m) {
    while (simulation.newest() < first_row + m + 1) simulation.step();
    points.push_back({m, motion.read(simulation), simulation.time(simulation.newest())});
  };
  try {
    motion.begin(simulation, start_rows);
    reach_after(0);
    for (const std::int64_t m : planned) reach_after(m);
  } catch (const NumericalFailure& stop) {
    failure = fmt::format("the way forward ends: {}", stop.what());
  }
  return points;
}

/// The distance from the start after the way back; not a number if a step failed, and `failure` says how.
double way_back(const Motion& motion, Simulation& simulation, const TurningPoint& turn, const Ends& start,
                std::string& failure) {
  try {
    motion.go(simulation, motion.mirrored(turn.state), turn.steps);
  } catch (const NumericalFailure& stop) {
    failure = fmt::format("the way back after {} ends: {}", in_words(turn.steps), stop.what());
    return std::numeric_limits<double>::quiet_NaN();
  }
  return motion.distance(start, motion.mirrored(motion.read(simulation)));
}

/// The slope of the straight line through (log m, log distance) with the least squares. Distances below the last digit
/// of the field count as that.
double slope(const std::vector<std::int64_t>& steps, const std::vector<double>& distance) {
  double count = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    if (std::isnan(distance[n])) continue;
    const double u = std::log(static_cast<double>(steps[n]));
    const double v = std::log(std::max(distance[n], std::numeric_limits<double>::epsilon()));
    count += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  // (n Σuv − Σu Σv) / (n Σu² − (Σu)²)
  if (count < 3) return std::numeric_limits<double>::quiet_NaN();
  return (count * xy - x * y) / (count * xx - x * x);
}

Check check_of(const Reversal& reversal, double scale, std::size_t size, double tolerance, const std::string& failure) {
  Check check;
  check.name = "time reversal";
  check.tolerance = tolerance, check.normaliser = scale;
  check.count = static_cast<std::int64_t>(2 * size);
  check.samples = static_cast<std::int64_t>(reversal.steps.size());
  const std::int64_t m = reversal.steps.empty() ? 0 : reversal.steps.front();
  check.value = reversal.distance.empty() ? std::numeric_limits<double>::quiet_NaN() : reversal.distance.front();
  check.region = fmt::format("from row {}, after {} forward and as many back", first_row, in_words(m));
  check.failure =
      fmt::format("the way back misses the start by {:.2g} of the field after {}: the scheme is not its own inverse",
                  check.value, in_words(m));
  if (std::isnan(check.value) && !failure.empty()) check.failure = failure;
  return check;
}

}  // namespace

bool reversible(const LatticeSystem& system, std::uint64_t seed) { return reversible(system, system, seed); }

// Row r is seen as row 2·height − r, of bricks as the next one.
double mirror_time(const LatticeSystem& system) {
  return (2 * system.height() + (system.placement() == Placement::brick_wall ? 1 : 0)) * system.time_step();
}

bool reversible(const LatticeSystem& system, const LatticeSystem& mirrored, std::uint64_t seed) {
  const int rows = 2 * system.height() + 1;
  const std::int64_t first_mirrored = system.placement() == Placement::brick_wall ? 1 : 0;
  // Fields of order one suit most densities; where one is not defined there, smaller ones do.
  for (double amplitude = 2; amplitude > 1e-8; amplitude /= 10) {
    Rows section = random_rows(system, rows, amplitude, seed);
    const Values ahead = equations_in_the_middle(system, 0, section);
    std::ranges::reverse(section);
    const Values back = equations_in_the_middle(mirrored, first_mirrored, section);
    if (all_finite(ahead) && all_finite(back)) return agree(system, ahead, back, 1) || agree(system, ahead, back, -1);
  }
  return false;
}

std::optional<Reversal> time_reversal(const MakeSimulation& make, const std::vector<std::vector<double>>& start_rows,
                                      std::int64_t steps, double tolerance) {
  const auto simulation = make(std::nullopt);
  const LatticeSystem& system = simulation->evolution().system();
  const std::vector<std::int64_t> planned = turning_steps(steps, system.placement() == Placement::brick_wall);
  const auto has = [&](Role role) { return simulation->count(role) > 0; };
  // two rows of fields are enough to start from; of elements in time a row and its momenta are
  const bool elements = has(Role::inner) && !has(Role::trace) && is_variational(system) && system.height() == 1;
  const bool rows_suffice = !has(Role::inner) && !has(Role::trace) && !has(Role::slaved);
  if (start_rows.size() != 2 || (!elements && simulation->starting_rows() != 2) || planned.empty() ||
      !(rows_suffice || elements))
    return std::nullopt;
  // A start from momenta applies the processor, and a kernel's own momenta have it behind them.
  if (elements && simulation->is_processed()) return std::nullopt;

  const Motion motion(system, elements);
  Reversal reversal;
  reversal.promised = elements ? reversible_elements(system) : must_return(system, make);
  std::string failure;
  const std::vector<TurningPoint> points = forward(motion, *simulation, start_rows, planned, failure);
  const Ends start = points.empty() ? Ends{} : points[0].state;
  const double size = std::max(largest(start.first), largest(start.second)), scale = size > 0 ? size : 1;
  for (std::size_t n = 1; n < points.size(); ++n) {
    double distance = 0;
    try {
      distance = way_back(motion, *make(points[n].time), points[n], start, failure);
    } catch (const BadInput&) {  // a start from momenta is not to be had
      return std::nullopt;
    }
    // A way of one step that fails is a failure; of longer ones it says that rounding has grown too far.
    if (std::isnan(distance) && n > 1) break;
    reversal.steps.push_back(points[n].steps);
    reversal.distance.push_back(distance / scale);
    if (std::isnan(distance)) break;
  }
  reversal.end = failure;
  reversal.growth = slope(reversal.steps, reversal.distance);
  // Momenta are differences of values, as coefficients times the values are large: Σ|∂E/∂y| ~ 1/h.
  constexpr double digits = 8 * std::numeric_limits<double>::epsilon();
  if (elements) tolerance = std::max(tolerance, digits * coefficients(system) * largest(start.first) / scale);
  if (reversal.promised) reversal.check = check_of(reversal, scale, start.first.size(), tolerance, failure);
  return reversal;
}

}  // namespace delf
