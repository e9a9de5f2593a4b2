// SPDX-License-Identifier: MIT
#include "tools/warnings/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/smooth_state.hpp"
#include "schemes/stability/linear_stability.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/constraint_slopes.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tools/compare/refined_scene.hpp"
#include "tools/compare/solution_error.hpp"
#include "tools/rows/at_the_ends.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/exact_solution.hpp"
#include "tools/warnings/energy_warnings.hpp"
#include "tools/warnings/exact_energy.hpp"
#include "tools/warnings/linear_limit.hpp"
#include "tools/warnings/normal_part.hpp"
#include "tools/warnings/vacuum_symbol.hpp"

namespace delf {

namespace {

constexpr double one_percent = 0.01;

// The scene gives the solution itself.
bool is_formula(const State* exact) { return dynamic_cast<const SmoothState*>(exact) != nullptr; }

struct ValueRange {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double x) { least = std::min(least, x), most = std::max(most, x); }
  double width() const { return std::max(0.0, most - least); }
};

// The largest range of a component, of so many rows of the solution until `end`.
double range_of(const State& state, const Lattice& lattice, double end) {
  const std::size_t d = state.components(), N = delf::at(lattice.sites());
  const int times = std::clamp(2048 / lattice.sites(), 2, 64);
  std::vector<double> row(N * d);
  std::vector<ValueRange> ranges(d);
  for (int n = 0; n < times; ++n) {
    state.values(end * n / (times - 1), lattice, row);
    for (std::size_t at = 0; at < row.size(); ++at) ranges[at % d].add(row[at]);
  }
  double most = 0;
  for (const ValueRange& range : ranges) most = std::max(most, range.width());
  return most;
}

}  // namespace

Warnings::Warnings(const Scene& scene, const InitialRows& initial, const Simulation& simulation)
    : scene_(scene),
      initial_(initial),
      simulation_(simulation),
      work_(simulation, scene.problem.lattice, initial.monodromy()) {
  if (initial.state()) width_ = width_of(scene.initial, scene.problem.lattice);
  const double end = scene.end();
  has_pulse_ = initial.exact() && std::isfinite(width_);
  if (!has_pulse_ || end > initial.exact()->exact_until()) return;
  // The last stretch of time in which the solution's pulse moves by some cells: it is slower than light.
  const Lattice& lattice = scene.problem.lattice;
  const double at_end = exact_centre(end), some_cells = 5 * lattice.space_step();
  for (double stretch = some_cells; stretch <= end && !std::isfinite(late_); stretch *= 1.3)
    if (std::abs(separation(lattice, at_end, exact_centre(end - stretch))) > some_cells) late_ = end - stretch;
}

/// The keys that make steps finer.
std::string Warnings::finer() const {
  return scene_.problem.lattice.space() == Space::point ? "reduce lattice.time_step"
                                                        : "raise lattice.sites, unless the lattice itself is the model";
}
/// The remedy for an energy that is off at row 0: finer steps where these bring it nearer. They do not where the state
/// has a jump at the ends of the lattice.
std::string Warnings::finer_or_why_not(const Outcome& outcome, double energy_of_start) const {
  const State& state = *initial_.state();
  const double off = std::abs(outcome.energy_initial - energy_of_start);
  if (!(off > one_percent * std::abs(energy_of_start)) || scene_.problem.lattice.space() == Space::point)
    return finer();
  if (const EndChange ends = at_the_ends(scene_, state).value;
      ends.change > 0.01 * std::max(1.0, std::abs(monodromy())))
    return fmt::format(
        "the state {}, by {:.2g}, and more sites do not help: choose lattice.length and boundary keys "
        "that fit it",
        ends.words, ends.change);
  constexpr double helps = 0.8;  // an error of first order halves
  try {
    const Scene fine = refined(scene_);
    const InitialRows rows(fine);
    Simulation simulation = build(fine, rows.winding());
    rows.start(simulation);
    if (std::abs(simulation.monitors().energy - energy_of_start) <= helps * off) return finer();
  } catch (const Error&) {
    return finer();
  }
  return "more sites do not bring it nearer: the state is rough, or the lattice itself is the model";
}
/// Elements have several, and are as fine as their nodes.
int Warnings::nodes_in_cell() const {
  std::set<double> places;
  for (const Component& component : simulation_.components()) places.insert(component.at.space);
  return static_cast<int>(places.size());
}
double Warnings::monodromy() const { return initial_.monodromy(); }
double Warnings::centre(std::span<const double> fields) const {
  return gradient_centre(scene_.problem.lattice, fields, simulation_.count(Role::field), monodromy());
}
double Warnings::exact_centre(double time) const {
  const State& state = *initial_.exact();
  std::vector<double> row(scene_.problem.lattice.sites() * state.components());
  state.values(time, scene_.problem.lattice, row);
  return gradient_centre(scene_.problem.lattice, row, state.components(), monodromy());
}

void Warnings::see(double time, std::span<const double> fields, std::span<const double> monitors) {
  constexpr double larger = 1.01;
  largest_.resize(monitors.size()), rises_.resize(monitors.size());
  for (std::size_t m = 0; m < monitors.size(); ++m) {
    if (!(monitors[m] > largest_[m].value)) continue;
    largest_[m] = {time, monitors[m]};
    if (rises_[m].empty() || monitors[m] > larger * rises_[m].back().value) rises_[m].push_back(largest_[m]);
  }
  if (has_pulse_) centres_.push_back({time, centre(fields)});
  work_.see();
}

void Warnings::visit(SavedState& state) {
  state("centres of the pulse", centres_);
  state("largest values of monitors", largest_), state("rises of monitors", rises_);
  turn_.visit(state), work_.visit(state);
}

std::vector<std::string> Warnings::of(const Outcome& outcome, const Trace& energy_errors,
                                      std::span<const double> last_row) const {
  std::vector<std::string> all;
  const Found at_ends = ends(outcome);
  // An energy that walls or the density's own t change leaves any band.
  const auto band = [&] {
    return at_ends || work_.reads_time() ? Found()
                                         : energy_off_band(energy_errors, "reduce lattice.time_step, or run less far");
  };
  // The energy of the state is that of all its rates.
  const std::string normal = normal_part(scene_, initial_, simulation_.theory());
  if (!normal.empty()) all.push_back(normal);
  for (Found& found : std::vector<Found>{narrow_pulse(), linear_limit(outcome), spurious_mode(last_row),
                                         at_ends || !normal.empty() ? Found() : energy(outcome), band(),
                                         at_ends ? Found() : error(outcome), at_ends, driven_off_constraint(outcome),
                                         without_solution(), pinned(outcome, last_row), phase(outcome, last_row)})
    if (found) all.push_back(std::move(*found));
  std::ranges::move(grown(), std::back_inserter(all));
  std::ranges::move(continued(outcome), std::back_inserter(all));
  return all;
}

/// Driven ends have no equation: their formulas are checked themselves.
Found Warnings::driven_off_constraint(const Outcome& outcome) const {
  const FieldTheory& theory = simulation_.theory();
  const auto constraint = theory.constraint();
  if (!constraint) return {};
  constexpr int times = 256;
  ConstraintSlopes G(*constraint, at(theory.components()));
  double most = 0, terms = 0;
  for (const char* key : {left_end, right_end}) {
    const FormulasOfTime motion = motion_of_end(theory, scene_.problem, key);
    for (int n = 0; n <= times && !motion.empty(); ++n) {
      std::vector<double> fields;
      for (const FormulaOfTime& of : motion) fields.push_back(of(outcome.time * n / times));
      for (std::size_t m = 0; m < G.constraints(); ++m) {
        most = std::max(most, std::abs(G.at(m, fields)));
        terms = std::max(terms, constraint_terms(G.slopes(), fields));
      }
    }
  }
  return off_constraint(most, terms, scene_.problem.tolerance);
}

Found Warnings::narrow_pulse() const {
  const State* state = initial_.state();
  const double two_cells = 2 * scene_.problem.lattice.space_step() / nodes_in_cell();
  if (!state || !(width_ < two_cells) || scene_.problem.lattice.space() == Space::point) return {};
  if (simulation_.evolution().system().moves()) return {};  // cells are narrow where the pulse is
  return fmt::format("a pulse of the initial state is {:.3g} wide, less than two cells, or {:.3g}; {}", width_,
                     two_cells, finer());
}

Found Warnings::linear_limit(const Outcome& outcome) const {
  return beyond_linear_limit(scene_, simulation_, outcome.steps);
}

/// A mode that the scheme has and the theory has not, as far as it is there in the last row.
Found Warnings::spurious_mode(std::span<const double> last_row) const {
  const Lattice& lattice = scene_.problem.lattice;
  if (!lattice.is_circle() || lattice.sites() % 2 != 0) return {};
  // The amplitude a of (−1)ⁱ a: Σ (−1)ⁱ (y_{i−1} − 2y_i + y_{i+1}) = −4 N a, in which a winding plays no part.
  const int N = lattice.sites(), d = simulation_.count(Role::field);
  double largest = 0, range = 0;
  for (int c = 0; c < d; ++c) {
    const auto y = [&](int i) {
      return last_row[lattice.wrapped(i) * d + c] + (i < 0 ? -monodromy() : i >= N ? monodromy() : 0);
    };
    double sum = 0;
    ValueRange values;
    for (int i = 0; i < N; ++i) sum += (i % 2 == 0 ? 1 : -1) * (y(i - 1) - 2 * y(i) + y(i + 1)), values.add(y(i));
    largest = std::max(largest, std::abs(sum) / (4 * N));
    range = std::max(range, values.width());
  }
  if (!(largest > one_percent * range)) return {};
  const auto symbol = symbol_of(scene_, simulation_);
  if (!symbol) return {};
  for (const Ghost& ghost : linear_stability(*symbol, 3).ghosts)
    if (std::abs(ghost.theta - std::numbers::pi) < 1e-6)
      return fmt::format("the last row has {:.2g} of a mode that the theory has not, {}; take lattice.sites odd",
                         largest, ghost.words);
  return {};
}

Found Warnings::energy(const Outcome& outcome) const {
  const State* state = initial_.state();
  // The energy is taken from vertices alone: of an element it says little.
  if (!state || nodes_in_cell() > 1 || !key_of_driven_end(scene_.problem).empty()) return {};
  const auto exact = exact_energy(*state, simulation_.theory().density(), scene_.problem.lattice, width_, 0);
  if (!exact) return {};
  if (work_.reads_time() && std::isnan(work_.value())) return {};
  const KnownWork known = work_.reads_time() ? KnownWork{work_.value(), work_.uncertainty()} : KnownWork{};
  if (!energy_off_start(outcome, *exact, one_percent, "", known)) return {};
  return energy_off_start(outcome, *exact, one_percent, finer_or_why_not(outcome, *exact), known);
}

Found Warnings::error(const Outcome& outcome) const {
  if (!(outcome.error_linf > 0)) return {};
  const double range = range_of(*initial_.exact(), scene_.problem.lattice, outcome.time);
  return error_beyond_range(outcome, range, finer());
}

/// A formula on the line is compared with a run on a circle, or between walls.
Found Warnings::ends(const Outcome& outcome) const {
  if (!(outcome.error_linf > 0) || !is_formula(initial_.exact())) return {};
  const EndChange ends = at_the_ends(scene_, *initial_.exact()).value;
  if (!(ends.change > 0.1 * outcome.error_linf)) return {};
  return fmt::format("the exact solution {}, by {:.2g}, and the error is {:.2g}: it is not the scheme's alone; {}",
                     ends.words, ends.change, outcome.error_linf,
                     scene_.problem.lattice.is_circle() ? "keep the pulse away from both ends of lattice.length"
                     : key_of_driven_end(scene_.problem).empty()
                         ? "give boundary.left and boundary.right as formulas of t that it follows, a solution that "
                           "keeps its value there, or a longer lattice.length"
                         : "give a solution that moves as the boundary keys say, or a longer lattice.length");
}

Found Warnings::without_solution() const {
  if (!is_formula(initial_.exact())) return {};
  const std::string found = delf::without_value(scene_, *initial_.exact());
  if (found.empty()) return {};
  return fmt::format("the exact solution {}: no error is known there; correct it, or run less far", found);
}

Found Warnings::pinned(const Outcome& outcome, std::span<const double> last_row) const {
  const auto late = std::ranges::find_if(centres_, [&](const Moment& m) { return m.time >= late_; });
  if (late == centres_.end() || !(outcome.time > late->time)) return {};
  const Lattice& lattice = scene_.problem.lattice;
  const double k = lattice.space_step(), now = centre(last_row);
  const double moved = separation(lattice, now, late->value);
  const double wanted = separation(lattice, exact_centre(outcome.time), exact_centre(late->time));
  if (!(std::abs(wanted) > 4 * k && std::abs(moved) < k)) return {};
  return fmt::format(
      "the pulse has stood still at x = {:.4g} since t = {:.4g}, and ought to have moved by {:.3g}: pinned "
      "by the lattice; {}",
      now < 0 ? now + lattice.length() : now, late->time, wanted, finer());
}

/// The phase error. Copies that end before the run does only estimate its end: it must be a fifth more.
Found Warnings::phase(const Outcome& outcome, std::span<const double> last_row) const {
  constexpr double thirty_percent = 0.3, little = 0.02;
  const double turn = turn_.value();
  if (static_cast<double>(outcome.steps) * turn * turn * turn / 12 < little) return {};
  if (outcome.status != "done" || !outcome.continued.empty()) return {};
  const auto found = step_error(scene_, initial_, simulation_, outcome.steps, last_row);
  if (!found || (found->error <= thirty_percent && found->at_end <= 1.2 * thirty_percent)) return {};
  return fmt::format(
      "half the step moves the field by {:.2g} of its range until t = {:.4g}{}: its phase is off; reduce "
      "lattice.time_step",
      found->error, found->time,
      found->at_end > found->error ? fmt::format(", and so by {:.2g} in the end", found->at_end) : "");
}

/// A monitor that passes a limit of 1; and one that ends a hundred times above all that it is in the first tenth of the run.
std::vector<std::string> Warnings::grown() const {
  std::vector<std::string> all;
  const std::vector<Monitor>& monitors = find_method(scene_.problem.method).monitors;
  for (std::size_t m = 0; m < std::min(monitors.size(), largest_.size()); ++m) {
    const Moment& most = largest_[m];
    if (monitors[m].when_above_1 && most.value > 1)
      all.push_back(fmt::format("{} is {:.3g} at t = {:.4g}, and should stay below 1: {}", monitors[m].name, most.value,
                                most.time, monitors[m].when_above_1));
    const auto after = std::ranges::find_if(rises_[m], [&](const Moment& r) { return r.time > scene_.end() / 10; });
    if (!monitors[m].when_it_grows || after == rises_[m].begin()) continue;
    const Moment& early = *std::prev(after);
    if (!(most.value > 100 * early.value)) continue;
    all.push_back(fmt::format("{} grows from {:.2g} at t = {:.4g} to {:.2g} at t = {:.4g}, like exp({:.3g} t): {}",
                              monitors[m].name, early.value, early.time, most.value, most.time,
                              std::log(most.value / early.value) / (most.time - early.time),
                              monitors[m].when_it_grows));
  }
  return all;
}

std::vector<std::string> Warnings::continued(const Outcome& outcome) const {
  std::vector<std::string> all;
  for (const auto& [why, steps] : outcome.continued)
    all.push_back(fmt::format(
        "{} of {} steps took Newton's method, which is {} times as dear: {}; {}", steps, outcome.steps_taken,
        why == Continued::stiff || why == Continued::far ? "a thousand" : "a hundred to a thousand", in_words(why),
        why == Continued::out_of_iterations
            ? fmt::format("raise scheme.max_iterations, which is {}", scene_.problem.max_iterations)
            : "reduce lattice.time_step"));
  return all;
}

}  // namespace delf
