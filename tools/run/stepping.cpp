// SPDX-License-Identifier: MIT
#include "tools/run/stepping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "schemes/driven_ends.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/theories/angles.hpp"
#include "schemes/without_value.hpp"
#include "tools/compare/placed_row.hpp"
#include "tools/run/moves_walls.hpp"
#include "tools/run/without_inertia.hpp"

namespace delf {

namespace {

constexpr auto momentum_dataset = "momentum";

// Momenta that no method records are half of an equation: at row 0 of the stencils above it, which must hold no more than
// the starting rows.
bool has_momenta_of_all_rows(const Simulation& simulation, const RowNames& names) {
  return std::ranges::find(names.datasets, momentum_dataset, &Simulation::DatasetInfo::name) != names.datasets.end() ||
         (simulation.starting_rows() >= 2 && simulation.evolution().system().height() <= 1);
}

void require_momenta_of_all_rows(const Simulation& simulation, const RowNames& names) {
  if (!has_momenta_of_all_rows(simulation, names))
    throw BadInput(
        "output.section",
        "this method has no momenta at row 0, which a section needs; leave it out, or use a method that starts "
        "from two rows or records /momentum");
}

// The rows that are measured beside the recorded ones, so that a step takes 5 % longer at most. To measure a row costs as
// much as an implicit step by rows or a slab on a point, two to four explicit steps, five slabs of elements on a lattice (its
// momenta are solved for) and some sixty on a moving mesh.
WatchedRows watched_rows(const Scene& scene, const Simulation& simulation) {
  const Stepper& stepper = simulation.evolution().stepper();
  const bool by_rows = stepper.layout() != nullptr, point = scene.problem.lattice.space() == Space::point;
  const bool moves = simulation.evolution().system().moves();
  constexpr std::int64_t most_values = 16384;  // some tenth of a millisecond
  struct Watched {
    std::int64_t rows, apart;
  };
  const auto [rows, apart] = !stepper.iterates() ? Watched{64, 256}
                             : by_rows           ? Watched{64, 64}
                             : point             ? Watched{64, 32}
                             : moves             ? Watched{2, 256}
                                                 : Watched{8, 128};
  const auto sums = static_cast<std::int64_t>(1 + 2 * simulation.conserved_names().size());  // each costs twice as much
  const std::int64_t values = static_cast<std::int64_t>(scene.problem.lattice.sites()) *
                              static_cast<std::int64_t>(simulation.components().size());
  return {std::min(rows, most_values / values) / sums, apart * sums, scene.initial.seed};
}

/// The start, or the first step after it: where its equations cannot be solved because the density has no inertia in a
/// direction, the failure says so.
template <class Step>
void first_step(const Simulation& simulation, const InitialRows& initial, const Step& step) {
  try {
    step();
  } catch (const NoConvergence& failed) {
    std::vector<std::string> fields;
    for (const Component& c : simulation.components())
      if (c.role == Role::field) fields.push_back(c.name);
    const std::string why = without_inertia(simulation.theory().density(), fields, initial.row0());
    if (why.empty()) throw;
    throw NoConvergence(
        fmt::format("{}: {}; add a kinetic term in that direction to it, which a constraint may hold "
                    "at zero",
                    failed.what(), why));
  }
}

/// The error of a row against the exact solution, at the row's own sites, which may move.
FieldError error_of(const RecordedRow& row, const RowNames& names, const State& exact, double time,
                    const Lattice& lattice) {
  const std::vector<double>& fields = row[Role::field];
  const auto& mesh = names.mesh;
  if (!mesh) {
    std::vector<double> solution(fields.size());
    exact.values(time, lattice, solution);
    return field_error(fields, solution, lattice.space_step());
  }
  const std::size_t width = names.of[Role::field].size(), step = names.of[mesh->role].size();
  PlacedRow placed;
  for (std::size_t n = 0; n < fields.size(); ++n)
    if (mesh->role != Role::field || n % width != mesh->index) placed.fields.push_back(fields[n]);
  for (std::size_t n = mesh->index; n < row[mesh->role].size(); n += step)
    placed.positions.push_back(row[mesh->role][n]);
  return field_error(placed, exact, time);
}

}  // namespace

std::string threads_in_words(const Simulation& simulation, int asked) {
  if (asked == 1) return {};
  const int sites = simulation.evolution().system().lattice().sites();
  const int each = simulation.evolution().stepper().report(false).sites_of_an_arc;
  if (each == 0)
    return fmt::format("1 of {}: only rows on a circle, solved by a number or two recurrences, are shared", asked);
  const int used = std::clamp(sites / each / 2 * 2, 1, asked);
  if (used == asked) return fmt::to_string(asked);
  return fmt::format("{} of {}: each takes {} sites or more", used, asked, each);
}

std::vector<std::string> names_of_modified(const Scene& scene) {
  std::vector<std::string> names{"energy_modified"};
  if (scene.problem.lattice.space() != Space::point) names.emplace_back("momentum_modified");
  return names;
}

Stepping::Stepping(const Scene& scene, const InitialRows& initial, Simulation& simulation, const RowNames& names,
                   const std::optional<ModifiedEnergy>& modified, const std::optional<OwnEnergy>& own, Outcome& outcome)
    : RowLoop(scene, outcome, simulation, watched_rows(scene, simulation)),
      scene_(scene),
      initial_(initial),
      simulation_(simulation),
      outcome_(outcome),
      names_(names),
      modified_(modified),
      own_energy_(own),
      warnings_(scene, initial, simulation),
      measures_(scene, initial.winding(), simulation) {
  const std::size_t sites = scene.problem.lattice.sites();
  for (const Role role : all_roles) row_[role].resize(sites * names.of[role].size());
  if (!scene.section.empty() && scene.problem.lattice.space() == Space::point) {
    try {
      require_lagrangian(simulation.evolution().system());
      require_momenta_of_all_rows(simulation, names);
      std::vector<int> angles = angles_of(scene.problem.theory, simulation.theory(), scene.problem.parameters);
      if (scene.problem.circle_valued) angles = {0};
      section_.emplace(scene.section, simulation.count(Role::field), scene.problem.time_step, angles);
    } catch (const BadInput& bad) {
      throw scene.settings.located(bad);
    }
  }
  if (scene.fields) datasets_.resize(names.datasets.size());
  for (const std::string& name : simulation.conserved_names())
    outcome.conserved.push_back({name, Outcome::unknown, Outcome::unknown, Outcome::unknown});
  if (modified)
    for (const std::string& name : names_of_modified(scene))
      outcome.conserved.push_back({name, Outcome::unknown, Outcome::unknown, Outcome::unknown});
  if (own)
    outcome.conserved.push_back(
        {names.further.back() + ", " + own->entry->name, Outcome::unknown, Outcome::unknown, Outcome::unknown});
  if (names.further.size() > 0 && names.further.back() == energy_less_work) {
    work_.emplace(simulation.evolution().system(), simulation.theory().shared_density(),
                  end_fluxes(simulation.theory(), scene.problem));
    density_work_.emplace(simulation, scene.problem.lattice, initial.monodromy());
    outcome.conserved.push_back({energy_less_work, Outcome::unknown, Outcome::unknown, Outcome::unknown});
  }
  outcome.iterates = simulation.evolution().stepper().iterates();
  outcome.threads = threads_in_words(simulation, scene.problem.threads);
}

void Stepping::make_first_rows() {
  first_step(simulation_, initial_, [&] { initial_.start(simulation_); });
  add_work();
  const auto monitors = this->monitors();
  outcome_.energy_initial = monitors.energy;
  outcome_.momentum_initial = monitors.momentum;
  require_energy(monitors.energy);
  for (std::size_t j = 0; j < outcome_.conserved.size(); ++j) {
    const double initial = monitors.conserved[j];
    // energies are conserved sums too, and of no symmetry here
    const auto symmetry =
        std::ranges::find(simulation_.symmetries(), outcome_.conserved[j].name, &LinearSymmetry::name);
    const bool at_walls =
        symmetry != simulation_.symmetries().end() && moves_walls(*symmetry, initial_.row0(), scene_.problem);
    outcome_.conserved[j] = {outcome_.conserved[j].name, initial, initial, 0, at_walls};
  }
  if (!names_.of[Role::multiplier].empty()) outcome_.constraint_max = 0;
  for (int back = static_cast<int>(simulation_.newest()); back >= 0; --back) {
    if (section_) section_->see(phase_point(back));
    see_step(back);
  }
}

/// (q, p) of the row `back` rows before the newest: the momenta that the method records, or those of its equations.
std::vector<double> Stepping::phase_point(int back) const {
  const std::size_t d = simulation_.count(Role::field);
  std::vector<double> point(d), p;
  simulation_.copy_row(back, point);
  for (std::size_t which = 0; which < names_.datasets.size() && p.empty(); ++which)
    if (names_.datasets[which].name == momentum_dataset) p = simulation_.dataset(which, back);
  if (p.empty()) p = simulation_.momenta(back);  // of all components, fields first
  point.insert(point.end(), p.begin(), p.begin() + static_cast<std::ptrdiff_t>(d));
  return point;
}

/// The momenta of a recorded row, for a phase portrait; not numbers where a row has none, nothing where no row has any.
std::vector<double> Stepping::drawn_momenta(int back) const {
  const std::size_t d = simulation_.count(Role::field);
  if (scene_.problem.lattice.space() != Space::point || !has_momenta_of_all_rows(simulation_, names_)) return {};
  std::vector<double> p(d, Outcome::unknown);
  if (!started() || starts_again_) return p;
  try {
    const std::vector<double> point = phase_point(back);
    std::copy_n(point.end() - static_cast<std::ptrdiff_t>(d), d, p.begin());
  } catch (const BadInput&) {  // equations that are no derivatives of an action
  }
  return p;
}

void Stepping::visit_rows(SavedState& state) {
  simulation_.visit(state);
  warnings_.visit(state);
  if (work_) work_->visit(state), density_work_->visit(state);
  measures_.visit(state);
  if (section_) section_->visit(state);
}

void Stepping::run(Recorder& recorder, Checkpoints& checkpoints) {
  recorder_ = &recorder;
  RowLoop::run(recorder, checkpoints);
}

void Stepping::step(bool looked_at) {
  if (outcome_.steps_taken > 0) simulation_.step(looked_at);
  else first_step(simulation_, initial_, [&] { simulation_.step(looked_at); });
  add_work();
  if (const Continued why = simulation_.evolution().stepper().continued(); why != Continued::no)
    ++outcome_.continued[why];
  if (section_) section_->see(phase_point(0));
  see_step(0);
}

void Stepping::watch() {
  const auto monitors = this->monitors();
  const double residual = simulation_.residual();
  judge(monitors, residual);
  take(monitors, residual);
  recorder_->watch(simulation_.time(newest()), energy_error(monitors.energy));
}

bool Stepping::record_start() {
  starts_again_ = true;
  record(0);
  return true;
}

void Stepping::add_work() {
  const Stepper& stepper = simulation_.evolution().stepper();
  if (!work_) return;
  if (stepper.newest() > 1 || work_->by_elements())
    work_->add(stepper.window(static_cast<int>(std::min<std::int64_t>(3, stepper.newest() + 1))));
  density_work_->see();
}

/// The energy less the work of the ends and of the density.
double Stepping::energy_gained(double energy) const {
  return work_ ? energy - work_->sum() - density_work_->sum() : energy;
}

/// (E − E₀)/|E₀|; where ends do work W, E − W in place of E, and relative to E where that is larger.
double Stepping::energy_error(double energy) const {
  const double gap = energy_gained(energy) - outcome_.energy_initial;
  if (work_ && gap == 0) return 0;
  return gap / std::max(std::abs(outcome_.energy_initial), work_ ? std::abs(energy) : 0.0);
}

/// Maxima of the run.
void Stepping::take(const Simulation::Monitors& monitors, double residual) {
  if (!(residual <= outcome_.residual_max)) outcome_.residual_max = residual;
  if (!row_[Role::multiplier].empty() && !(monitors.constraint <= outcome_.constraint_max))
    outcome_.constraint_max = monitors.constraint;
  std::vector<double>& extremes = outcome_.of_method;
  const std::vector<Monitor>& declared = find_method(scene_.problem.method).monitors;
  extremes.resize(monitors.of_method.size(), Outcome::unknown);
  for (std::size_t m = 0; m < extremes.size(); ++m) {
    const double value = monitors.of_method[m];
    if (std::isnan(extremes[m]) || (declared[m].least ? value < extremes[m] : value > extremes[m])) extremes[m] = value;
  }
  for (std::size_t j = 0; j < outcome_.conserved.size(); ++j)
    outcome_.conserved[j].take(monitors.conserved[j], monitors.conserved_scale[j]);
}

void Stepping::record(std::int64_t row) {
  Record record;
  record.row = row;
  record.time = simulation_.time(row);
  std::vector<double> of_method;
  const bool has_monitors = started() && !starts_again_;
  if (!has_monitors) {
    const std::size_t sites = scene_.problem.lattice.sites();
    row_[Role::field] = initial_.row0();
    record.energy = record.energy_error = record.momentum = record.charge = Outcome::unknown;
    record.further.assign(names_.further.size(), Outcome::unknown);
    for (std::size_t d = 0; d < datasets_.size(); ++d)
      datasets_[d].assign(sites * names_.datasets[d].components.size(), Outcome::unknown);
  } else {
    const int back = static_cast<int>(newest() - row);
    record.residual = row == newest() ? simulation_.residual() : 0;  // the starting rows solve no equation
    const auto monitors = this->monitors();
    judge(monitors, record.residual);
    take(monitors, record.residual);
    simulation_.observe(back, row_[Role::field]);
    for (const Role role : all_roles)
      if (role != Role::field && !row_[role].empty()) simulation_.copy_row(back, row_[role], role);
    for (std::size_t d = 0; d < datasets_.size(); ++d) datasets_[d] = simulation_.dataset(d, back);
    record.energy = monitors.energy;
    record.energy_error = energy_error(monitors.energy);
    record.momentum = monitors.momentum;
    record.charge = monitors.charge;
    put(monitors, record);
    of_method = monitors.of_method;
    record.iterations = last_iterations();
  }
  if (has_monitors) {
    warnings_.see(record.time, row_[Role::field], of_method);
    measure(record, static_cast<int>(newest() - row));
  }
  outcome_.energy_final = record.energy;
  outcome_.momentum_final = record.momentum;
  outcome_.charge_final = record.charge;
  const bool drawn = has_monitors && recorder_->thinned_rows();
  const int back = static_cast<int>(newest() - row);
  recorder_->append(record, row_, datasets_, drawn ? rates(back) : std::vector<double>(),
                    recorder_->thinned_rows() ? drawn_momenta(back) : std::vector<double>());
  ++outcome_.records;
}

/// A row that does not solve its equations, or has no energy, is no result.
void Stepping::judge(const Simulation::Monitors& monitors, double residual) const {
  require_energy(monitors.energy);
  if (std::isnan(residual) && !outcome_.failure.empty()) return;  // a step that failed may have left no equations
  if (is_solution(residual, scene_.problem.tolerance) || !varies()) return;
  throw NoConvergence(
      fmt::format("step {}, t = {:.6g}: the residual of the field equations is {:.2g} of their terms: the "
                  "field is too large, or too steep, for double precision; reduce lattice.time_step",
                  newest(), simulation_.time(newest()), residual));
}

void Stepping::require_energy(double energy) const {
  // Schemes whose momenta tell no velocities have no energy from the start on.
  if (std::isfinite(energy) || (started() && std::isnan(outcome_.energy_initial))) return;
  const Evolution& evolution = simulation_.evolution();
  const std::string reason = evolution.stepper().held() >= 2 && evolution.stepper().newest() >= 1
                                 ? without_value(evolution.system(), evolution.stepper().window(2))
                                 : std::string();
  if (!started() && std::isnan(energy) && reason.empty()) return;
  const std::int64_t row = simulation_.newest();
  throw NotFinite(
      fmt::format("step {}, t = {:.6g}: the energy is not finite{}; reduce lattice.time_step, or begin "
                  "where the density has values all along",
                  row, simulation_.time(row), reason.empty() ? "" : ": " + reason));
}

/// Near a vacuum all terms are rounding, and their sum has no scale.
bool Stepping::varies() const {
  constexpr double little = 1e-8;
  std::vector<double> row(row_[Role::field].size()), before(row);
  simulation_.copy_row(0, row), simulation_.copy_row(1, before);
  const std::size_t d = simulation_.count(Role::field);
  double largest = 0, change = 0;
  for (std::size_t n = 0; n < row.size(); ++n) {
    largest = std::max(largest, std::abs(row[n]));
    change = std::max({change, std::abs(row[n] - before[n]), std::abs(row[n] - row[n % d])});
  }
  return !(change <= little * largest);
}

// Measures at a place see every step, recorded or not, and warnings the first ones.
void Stepping::see_step(int back) {
  const std::int64_t row = simulation_.newest() - back;
  const bool is_early = row < TurnOfStep::rows;
  if (!is_early && !measures_.sees_steps()) return;
  seen_.resize(row_[Role::field].size());
  if (is_early) {
    simulation_.copy_row(back, seen_);
    warnings_.see_early(seen_);
  }
  if (!measures_.sees_steps() || (!scene_.until && row > scene_.steps)) return;
  simulation_.observe(back, seen_);
  measures_.see_step({simulation_.time(row), seen_, {}});
}

// The row before it, or after row 0, is held by schemes that start from two rows.
void Stepping::measure(const Record& record, int back) {
  if (measures_.empty()) return;
  std::vector<double> other;
  const int neighbour = back + 1 < simulation_.starting_rows() ? back + 1 : back - 1;
  if (neighbour >= 0 && neighbour < simulation_.starting_rows()) {
    other.resize(row_[Role::field].size());
    simulation_.observe(neighbour, other);  // as the row itself
  }
  measures_.see({record.time, row_[Role::field], other, record.energy_error, record.energy});
}

/// (φ − φ′)/h of the row and the one before it, or after row 0; none where that is not held.
std::vector<double> Stepping::rates(int back) const {
  if (newest() < 1 || simulation_.evolution().stepper().held() < 2) return {};
  const int other = back == 0 ? 1 : back - 1;
  std::vector<double> rates(row_[Role::field].size());
  simulation_.observe(other, rates);
  const double h = simulation_.time(newest() - back) - simulation_.time(newest() - other);
  for (std::size_t n = 0; n < rates.size(); ++n) rates[n] = (row_[Role::field][n] - rates[n]) / h;
  return rates;
}

Simulation::Monitors Stepping::monitors() const {
  Simulation::Monitors all = simulation_.monitors();
  if (modified_) {
    std::vector<double> earlier(row_[Role::field].size()), later(earlier);
    simulation_.copy_row(1, earlier), simulation_.copy_row(0, later);
    const auto [energy, momentum] = modified_->of(earlier, later, simulation_.time(newest() - 1));
    for (const double value : {energy, momentum}) all.conserved.push_back(value);
    if (scene_.problem.lattice.space() == Space::point) all.conserved.pop_back();
    // a momentum may be zero: its error is one beside the energy
    while (all.conserved_scale.size() < all.conserved.size()) all.conserved_scale.push_back(std::abs(energy));
  }
  if (own_energy_) {
    all.conserved.push_back(newest_own_energy(*own_energy_, simulation_));
    all.conserved_scale.push_back(std::abs(all.conserved.back()));
  }
  if (work_) {
    all.conserved.push_back(energy_gained(all.energy));
    all.conserved_scale.push_back(std::max(std::abs(all.energy), std::abs(all.energy - all.conserved.back())));
  }
  return all;
}

// The constraint, the monitors of the method, and the conserved sums.
void Stepping::put(const Simulation::Monitors& monitors, Record& record) const {
  if (!row_[Role::multiplier].empty()) record.further.push_back(monitors.constraint);
  for (const auto& values : {monitors.of_method, monitors.conserved})
    record.further.insert(record.further.end(), values.begin(), values.end());
}

void Stepping::finish() {
  if (section_) section_->finish();
  outcome_.energy_error_max = recorder_->largest_energy_error();
  measure_error();
  outcome_.measures = measures_.results();
  if (!started()) return;
  outcome_.reads_time = warnings_.work().reads_time(), outcome_.energy_work = warnings_.work().value();
  outcome_.warnings = warnings_.of(outcome_, recorder_->energy_errors(), row_[Role::field]);
  if (section_ && section_->points() == 0)
    outcome_.warnings.push_back(
        fmt::format("no row crosses output.section = {} where its conditions hold: section.csv is "
                    "empty; choose other values, or run longer",
                    scene_.section));
  warn_of_alias();
}

void Stepping::warn_of_alias() {
  const ThinnedRows* thinned = recorder_->thinned_rows();
  if (!thinned || !thinned->is_aliased()) return;
  // The excess of pulses is in proportion to the time between frames.
  const double apart = static_cast<double>(scene_.every * thinned->stride()),
               wanted = apart * ThinnedRows::aliased / thinned->alias();
  const auto every = std::max<std::int64_t>(1, std::llround(std::floor(wanted)));
  constexpr std::int64_t most_frames = 600;
  const bool fits = every < scene_.every && outcome_.steps / every <= most_frames;
  outcome_.warnings.push_back(fmt::format(
      "the frames of the figures are {:.4g} apart in time, too far for this motion: what moves in them may be an alias; {}",
      apart * scene_.problem.time_step,
      fits ? fmt::format("set output.every = {} or less", every)
           : fmt::format("a figure shows {} steps of this run at most: run less far", most_frames * every)));
}

void Stepping::measure_error() {
  const State* exact = initial_.exact();
  if (!exact || recorded() < 0 || outcome_.time > exact->exact_until()) return;
  // row_ is the last one still
  const FieldError error = error_of(row_, names_, *exact, outcome_.time, scene_.problem.lattice);
  outcome_.error_linf = error.linf;
  outcome_.error_l2 = error.l2;
}

}  // namespace delf
