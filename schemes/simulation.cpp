// SPDX-License-Identifier: MIT
#include "schemes/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "schemes/declared.hpp"
#include "schemes/families/mirror_check.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/energy.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/plan_report.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/system/slab_extent.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "schemes/without_value.hpp"

namespace delf {
namespace {

SchemeParts make_parts(const FieldTheory& theory, const Problem& p) {
  if (!(p.time_step > 0) || !std::isfinite(p.time_step))
    throw BadInput("lattice.time_step", "lattice.time_step must be a positive, finite number");
  SchemeParts parts = find_method(p.method).build(theory, p);
  // on a point one value starts, and there is nothing beside it that it would have to be lifted to
  const auto is_of_one_field = [&](const Component& c) {
    return c.role == Role::field || (c.role == Role::inner && p.lattice.space() == Space::point);
  };
  if (p.circle_valued && (std::ranges::count(parts.components, Role::field, &Component::role) > 1 ||
                          !std::ranges::all_of(parts.components, is_of_one_field)))
    throw BadInput("theory.fibre",
                   "theory.fibre = S1: for one field, without multipliers, and on space without nodes "
                   "inside the cells; use R");
  return parts;
}

Evolution make_evolution(SchemeParts parts, const Problem& p) {
  return {p.lattice,
          std::move(parts.families),
          p.time_step,
          {p.tolerance, p.seed_order, p.max_iterations, p.circle_valued ? Fibre::circle : Fibre::real,
           2 * std::numbers::pi * p.winding, p.threads, std::move(parts.processor), p.step_control.has_value()},
          std::move(parts.components)};
}

}  // namespace

struct Simulation::Impl {
  Problem problem;
  const MethodEntry& method;
  std::unique_ptr<FieldTheory> theory;
  std::vector<LinearSymmetry> symmetries;
  std::vector<std::string> remarks;  ///< of the method, for the plan
  Evolution evolution;
  Stepper& stepper;
  const LatticeSystem& system;
  std::unique_ptr<RowLayout> own_layout;  ///< of the monitors, where steps do not go by rows
  RowBuffer cell_weights, positions, last_rows;
  std::vector<const double*> monitored;
  int winding;
  bool has_multipliers;  ///< it has constraints
  int field_lag;         ///< rows from the newest row of fields up to the newest slab
  std::optional<StepDensity> chosen_steps;  ///< where rows choose them
  std::vector<std::string> conserved_names;

  Impl(const Problem& p, std::unique_ptr<FieldTheory> t, SchemeParts parts)
      : problem(p),
        method(find_method(p.method)),
        theory(std::move(t)),
        symmetries(std::move(parts.symmetries)),
        remarks(std::move(parts.remarks)),
        evolution(make_evolution(std::move(parts), p)),
        stepper(evolution.stepper()),
        system(evolution.system()),
        winding(p.winding),
        has_multipliers(std::ranges::count(system.all_components(), Role::multiplier, &Component::role) > 0),
        field_lag(has_multipliers ? slab_extent(system, evolution.plan()).field_lag : 0) {
    if (!method.energy && system.fields() != theory->components())
      throw std::logic_error("scheme.method = " + method.name + ": has other fields than the theory, and no energy");
    if (p.step_control) take_step_control();
    // Stencils of more than two rows would need rows that are no longer held.
    for (const LinearSymmetry& s : symmetries)
      if (system.height() <= 1) conserved_names.push_back(s.name);
  }

  std::vector<double> of_role(Role role, int back) const {
    const std::vector<double> row = stepper.row(back);
    std::vector<double> values;
    for (std::size_t at = 0; at < row.size(); ++at)
      if (system.component(static_cast<int>(at) % system.components()).role == role) values.push_back(row[at]);
    return values;
  }
  void take_step_control() {
    const SlabExtent extent = slab_extent(system, evolution.plan());
    if (!method.row_density || system.height() != 1 || extent.field_lag != 0 || extent.above != 0)
      throw BadInput("lattice.time_steps",
                     fmt::format("lattice.time_steps = reversible: scheme.method = {} has steps of one length; use "
                                 "scheme.method = r-adaptive, or leave it out",
                                 method.name));
    chosen_steps.emplace(problem.time_step);
    system.times()->begin(problem.time_step);
  }
  /// What row 0 and its momenta, or the newest row, ask of the steps.
  RowDensity row_density(const std::vector<double>& row0, std::span<const double> momenta) const {
    return method.row_density(
        {*theory, system, system.window(0, {row0}, 2 * std::numbers::pi * winding), 0, problem.time_step}, momenta,
        *problem.step_control);
  }
  RowDensity row_density() const {
    const RowsInTime rows = newest_rows();
    return method.row_density(rows, half_equations(system, rows.rows, rows.newest, Side::below), *problem.step_control);
  }
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta,
                      std::optional<double> density) {
    if (chosen_steps)
      system.times()->begin(density ? chosen_steps->go_on_from(*density)
                                    : chosen_steps->first(row_density(row0, momenta)));
    stepper.start_legendre(row0, momenta);
  }
  void step_by(double h, bool looked_at) {
    system.times()->add(h);
    try {
      with_reasons([&] { stepper.step(looked_at); });
    } catch (...) {
      system.times()->drop();
      throw;
    }
  }
  void step(bool looked_at) {
    if (!chosen_steps) return with_reasons([&] { stepper.step(looked_at); });
    const StepDensity before = *chosen_steps;
    try {
      step_by(chosen_steps->next(row_density()), looked_at);
    } catch (...) {
      chosen_steps = before;
      throw;
    }
  }

  RowsInTime newest_rows() const {
    const std::int64_t newest = stepper.newest();
    return {*theory, system, stepper.window(2), newest, system.times()->step(newest - 1)};
  }
  EnergyMomentum energy_momentum() const {
    if (method.energy) return method.energy(newest_rows());
    const double h = problem.time_step;
    const double t = (static_cast<double>(stepper.newest()) - (stepper.is_processed() ? 0.5 : 1)) * h;
    if (theory->density().slots() > 3) {
      CellJets jets(theory->density(), problem.lattice, h, 2 * std::numbers::pi * winding);
      return delf::energy_momentum(theory->density(), problem.lattice, jets, of_role(Role::field, 1),
                                   of_role(Role::field, 0), t + 0.5 * h);
    }
    return delf::energy_momentum(theory->density(),
                                 {&layout(), monitored.data(), positions.rows() ? positions.row(0) : nullptr, t, h,
                                  problem.lattice.space_step()},
                                 cell_weights.row(0));
  }

  /// Carries out steps; where they fail because the density has no value, the failure says so.
  template <class Steps>
  void with_reasons(const Steps& steps) const {
    try {
      steps();
    } catch (const NotFinite& failure) {
      throw NotFinite(with_reason(failure));
    } catch (const NoConvergence& failure) {
      throw NoConvergence(with_reason(failure));
    }
  }
  std::string with_reason(const NumericalFailure& failure) const {
    const std::string reason = stepper.newest() < 1 ? std::string() : without_value(system, stepper.window(2));
    return reason.empty() ? failure.what() : fmt::format("{}; {}", failure.what(), reason);
  }

  const RowLayout& layout() const { return own_layout ? *own_layout : *stepper.layout(); }

  /// max |G| over the constraints of the newest slab, each at the row that the plan has it in.
  double constraint() const {
    if (!has_multipliers || stepper.newest() < 2) return 0;
    const std::int64_t slab = stepper.newest() + field_lag;
    double worst = 0;
    std::map<std::int64_t, std::vector<LatticeSystem::Value>> of_row;
    for (int c = 0; c < system.components(); ++c)
      for (int i = 0; i < problem.lattice.sites(); ++i) {
        if (system.component(c).role != Role::multiplier || !evolution.plan().solved(i, c)) continue;
        // a slab may know a trace of the row above it; that row is whole with the next
        const std::int64_t row =
            std::min(stepper.newest(), slab - evolution.plan().shift(i, c, static_cast<int>(slab & 1)));
        const auto [at, fresh] = of_row.try_emplace(row);
        if (fresh)
          system.equations(stepper.window(std::max(3, static_cast<int>(stepper.newest() - row) + 2)), row, at->second);
        worst = std::max(worst, std::abs(at->second[static_cast<std::size_t>(i * system.components() + c)].sum));
      }
    return worst;
  }

  /// S¹: chooses for every value the representative next to its neighbour, so that the section is continuous; from there
  /// on differences are those of real numbers, and Stepper watches that they stay small enough to be told apart.
  std::vector<std::vector<double>> lifted(std::vector<std::vector<double>> rows) const {
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t i = 0; i < rows[r].size(); ++i) {
        if (r == 0 && i == 0) continue;
        const double near = r == 0 ? rows[0][i - 1] : rows[r - 1][i];
        const double difference = wrap(rows[r][i] - near);
        if (!(std::abs(difference) <= largest_wrapped_difference))
          throw NotFinite(
              fmt::format("row {}, site {}: on the fibre S1 the starting values jump by {:.3g}, above 0.9 pi; "
                          "refine the lattice or use theory.fibre = R",
                          r, i, difference));
        rows[r][i] = near + difference;
      }
    if (!problem.lattice.is_circle()) return rows;
    const double gained = rows[0].back() + wrap(rows[0].front() - rows[0].back()) - rows[0].front();
    if (const int turns = static_cast<int>(std::lround(gained / (2 * std::numbers::pi))); turns != winding)
      throw BadInput("boundary.winding",
                     fmt::format("boundary.winding = {}: the starting rows wind {} times around the circle; set "
                                 "boundary.winding = {}",
                                 winding, turns, turns));
    return rows;
  }

  /// A fixed wall does not move: the nodes of a step on it have the value of its vertex, and no velocity.
  void hold_walls(std::vector<double>& row, bool velocity) const {
    const int C = system.components();
    for (int c = 0; c < C; ++c) {
      const Component& component = system.component(c);
      const bool inner = component.role == Role::inner || component.role == Role::trace;
      if (!inner && !(velocity && component.role == Role::field)) continue;
      for (const int i : {0, system.lattice().sites() - 1})
        if (system.is_held(i, c))
          row[static_cast<std::size_t>(i * C + c)] =
              velocity ? 0 : row[static_cast<std::size_t>(i * C + system.field_component(component.field))];
    }
  }

  /// Stencils that go on beyond a wall by mirror images: whether the density has any about the wall's value.
  void check_mirrors(const std::vector<double>& row) const {
    const int C = system.components();
    for (const auto& family : system.families()) {
      const Placement at = family->pattern().placement;
      if (at != Placement::left_mirror && at != Placement::right_mirror) continue;
      const bool left = at == Placement::left_mirror;
      const int site = left ? 0 : system.lattice().sites() - 1;
      const bool fixed = system.lattice().is_fixed(site);
      std::vector<double> wall;
      for (int a = 0; a < theory->components(); ++a)
        wall.push_back(row[static_cast<std::size_t>(site * C + system.field_component(a))]);
      if (has_mirror_images(theory->density(), fixed ? Mirror::odd : Mirror::even, wall)) continue;
      throw BadInput(
          left ? "boundary.left" : "boundary.right",
          fmt::format("boundary.{0} = {1}: beyond this wall wide stencils go on by mirror images, and the "
                      "density is not even {2}; use lattice.space = circle or scheme.method = multisymplectic",
                      left ? "left" : "right", fixed ? "fixed" : "natural",
                      fixed ? fmt::format("about the wall's value {:.6g}", fmt::join(wall, ", ")) : "in phi_x"));
    }
  }

  std::size_t monitor_bytes() const {
    return cell_weights.bytes() + positions.bytes() + last_rows.bytes() + (own_layout ? own_layout->bytes() : 0);
  }
  std::size_t monitor_bytes_of_run() const {
    if (cell_weights.rows()) return monitor_bytes();
    const auto bytes = [&](const RowLayout& layout, int own_rows) {
      return RowBuffer::bytes_of(layout.doubles(), 1 + (theory->is_placed() ? 1 : 0) + own_rows);
    };
    if (stepper.layout()) return bytes(*stepper.layout(), 0);
    const RowLayout own(problem.lattice, 1);
    return bytes(own, 3 * theory->components()) + own.bytes();
  }

  /// What monitors look at, where steps do not go by rows.
  void copy_newest_pair() {
    const int C = system.components(), d = theory->components();
    if (stepper.is_processed()) return copy_observed_pair();
    const std::vector<double> newest = stepper.row(0), before = stepper.row(1);
    std::vector<double> before_newest(static_cast<std::size_t>(problem.lattice.sites())), value(before_newest),
        step(before_newest);
    for (int a = 0; a < d; ++a) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        const std::size_t at = i * static_cast<std::size_t>(C) + static_cast<std::size_t>(system.field_component(a));
        before_newest[i] = before[at], value[i] = newest[at];
        step[i] = newest[at] - before[at];
      }
      own_layout->scatter(before_newest, last_rows.row(a), 2 * std::numbers::pi * winding);
      own_layout->scatter(value, last_rows.row(d + a), 2 * std::numbers::pi * winding);
      own_layout->scatter(step, last_rows.row(2 * d + a));
    }
    for (int r = 0; r < 3 * d; ++r) monitored[static_cast<std::size_t>(r)] = last_rows.row(r);
  }
  /// Half a step before and after the observed row: y ∓ ½h φ_t.
  void copy_observed_pair() {
    const auto d = static_cast<std::size_t>(theory->components());
    const double h = problem.time_step, turn = 2 * std::numbers::pi * winding;
    std::vector<double> fields, rates, value(static_cast<std::size_t>(problem.lattice.sites()));
    stepper.observe(0, fields, &rates);
    const auto put = [&](double of_field, double of_rate, std::size_t row, double gained) {
      for (std::size_t a = 0; a < d; ++a) {
        for (std::size_t i = 0; i < value.size(); ++i)
          value[i] = of_field * fields[i * d + a] + of_rate * rates[i * d + a];
        own_layout->scatter(value, last_rows.row(static_cast<int>(row * d + a)), gained);
      }
    };
    put(1, -0.5 * h, 0, turn), put(1, 0.5 * h, 1, turn), put(0, h, 2, 0);
    for (int r = 0; r < static_cast<int>(3 * d); ++r) monitored[static_cast<std::size_t>(r)] = last_rows.row(r);
  }
  double charge() const {
    if (problem.lattice.is_circle()) return winding;
    // of the first field
    const int first = own_layout ? theory->components() : system.components() + system.field_component(0);
    const double* const newest = monitored[static_cast<std::size_t>(first)];
    const auto at = [&](int i) { return newest[layout().slot(i)]; };
    return (at(problem.lattice.sites() - 1) - at(0)) / (2 * std::numbers::pi);
  }
  void find_conserved(Monitors& monitors) const {
    // A run that starts from row 0 alone has no stencils below it, nor their sums.
    if (stepper.newest() < system.height()) {
      monitors.conserved.assign(symmetries.size(), std::numeric_limits<double>::quiet_NaN());
      monitors.conserved_scale = monitors.conserved;
      return;
    }
    const Window window = stepper.window(2);
    for (const LinearSymmetry& symmetry : symmetries) {
      double scale = 0;
      monitors.conserved.push_back(noether_charge(system, window, stepper.newest(), symmetry, &scale));
      monitors.conserved_scale.push_back(scale);
    }
  }

  [[gnu::noinline]] void prepare_monitors() {
    if (!stepper.layout()) own_layout = std::make_unique<RowLayout>(problem.lattice, 1);
    const RowLayout& layout = this->layout();
    cell_weights = RowBuffer(layout, 1);
    const int N = problem.lattice.sites(), cells = problem.lattice.cells(), d = theory->components();
    if (!stepper.layout()) last_rows = RowBuffer(layout, 3 * d);
    for (int i = 0; i < cells; ++i) cell_weights.row(0)[layout.slot(i)] = 1;
    monitored.resize(static_cast<std::size_t>(3 * std::max(d, system.components())));
    if (!theory->is_placed()) return;
    positions = RowBuffer(layout, 1);
    std::vector<double> x(static_cast<std::size_t>(N));
    for (int i = 0; i < N; ++i) x[static_cast<std::size_t>(i)] = problem.lattice.position(i);
    layout.scatter(x, positions.row(0));
  }
};

Simulation::Simulation(const Problem& given) {
  const Problem problem = completed(given);
  auto theory = make_theory(find_theory(problem.theory), problem.parameters);
  SchemeParts parts = make_parts(*theory, problem);
  impl_ = std::make_unique<Impl>(problem, std::move(theory), std::move(parts));
}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

int Simulation::starting_rows() const { return impl_->stepper.starting_rows(); }

void Simulation::start(const std::vector<std::vector<double>>& given, std::optional<double> density) {
  if (impl_->chosen_steps) {
    if (!density || given.size() != 2)
      throw BadInput("initial.start",
                     "initial.start: steps that the rows choose begin from row 0 and its rates; use legendre");
    impl_->system.times()->begin(impl_->chosen_steps->go_on_from(*density));
  }
  for (const auto& row : given) impl_->stepper.require_row(row.size());
  std::vector<std::vector<double>> rows = given;
  for (auto& row : rows) impl_->hold_walls(row, false);
  impl_->check_mirrors(rows[0]);
  impl_->stepper.start(impl_->problem.circle_valued ? impl_->lifted(rows) : rows);
}

void Simulation::start_centred(std::span<const double> row0, std::span<const double> velocity) {
  if (impl_->chosen_steps) throw BadInput("initial.start", "initial.start = centred: takes steps of one length; use legendre");
  std::vector<std::vector<double>> rows{{row0.begin(), row0.end()}};
  if (impl_->problem.circle_valued) rows = impl_->lifted(rows);
  impl_->check_mirrors(rows[0]);
  impl_->stepper.start_centred(rows[0], {velocity.begin(), velocity.end()});
}

void Simulation::step(bool looked_at) {
  impl_->step(looked_at);
}
void Simulation::step_by(double time_step) { impl_->step_by(time_step, true); }
void Simulation::steps(int count) {
  if (!impl_->chosen_steps) return impl_->with_reasons([&] { impl_->stepper.steps(count); });
  for (; count > 0; --count) impl_->step(false);
}
void Simulation::visit(SavedState& state) {
  impl_->stepper.visit(state);
  if (impl_->chosen_steps) impl_->system.times()->visit(state), impl_->chosen_steps->visit(state);
}
std::int64_t Simulation::newest() const { return impl_->stepper.newest(); }
double Simulation::time(std::int64_t row) const { return impl_->system.times()->time(row); }
std::optional<double> Simulation::step_density() const {
  return impl_->chosen_steps ? std::optional(impl_->chosen_steps->value()) : std::nullopt;
}
RowDensity Simulation::row_density() const { return impl_->row_density(); }

void Simulation::start_legendre(std::span<const double> fields, std::span<const double> rates) {
  const LatticeSystem& system = impl_->system;
  const Lattice& lattice = system.lattice();
  const int C = system.components(), N = lattice.sites();
  for (const std::size_t values : {fields.size(), rates.size()}) impl_->stepper.require_row(values);
  std::vector<double> row0(fields.begin(), fields.end()), velocity(rates.begin(), rates.end());
  impl_->hold_walls(row0, false), impl_->hold_walls(velocity, true);
  impl_->check_mirrors(row0);
  const double turn = 2 * std::numbers::pi * impl_->winding;
  std::vector<double> momenta(row0.size(), 0.0), phi, phi_t, p;
  bool any = false;
  for (const auto& family : system.families()) {
    for (int cell = 0; cell < N; ++cell) {
      if (!system.has_stencil(*family, 0, cell)) continue;
      std::vector<std::size_t> places;
      phi.clear(), phi_t.clear();
      for (int i = 0; i < family->size(); ++i) {
        const int c = family->values()[static_cast<std::size_t>(i)].component;
        if (family->site(i).time != 0 || system.component(c).at.time != 0) continue;
        if (system.component(c).role == Role::slaved && !system.component(c).position) continue;  // a rate
        const int x = cell + family->site(i).space, home = lattice.home(x);
        places.push_back(static_cast<std::size_t>(home * C + c));
        phi.push_back(row0[places.back()] + (x - home) / N * turn);
        phi_t.push_back(velocity[places.back()]);
      }
      p.resize(places.size());
      // constraints and trace stencils have none
      if (!family->momentum({impl_->problem.time_step, lattice.space_step(), 0, lattice.position(cell)}, phi, phi_t, p))
        break;
      any = true;
      for (std::size_t n = 0; n < places.size(); ++n)
        if (system.component(static_cast<int>(places[n]) % C).role != Role::slaved) momenta[places[n]] += p[n];
    }
  }
  if (!any)
    throw BadInput("initial.start", "initial.start = legendre: for schemes of elements, and scheme.method = " +
                                        impl_->method.name + " has none; use exact or centred");
  impl_->start_legendre(row0, momenta, {});
}

void Simulation::start_momenta(std::span<const double> row0, std::span<const double> momenta,
                               std::optional<double> density) {
  for (const std::size_t values : {row0.size(), momenta.size()}) impl_->stepper.require_row(values);
  impl_->start_legendre({row0.begin(), row0.end()}, {momenta.begin(), momenta.end()}, density);
}

void Simulation::copy_row(int back, std::span<double> out, Role role) const {
  std::ranges::copy(impl_->of_role(role, back), out.begin());
}

void Simulation::observe(int back, std::span<double> out) const {
  if (!is_processed()) return copy_row(back, out);
  std::vector<double> fields;
  impl_->stepper.observe(back, fields, nullptr);
  std::ranges::copy(fields, out.begin());
}
bool Simulation::is_processed() const { return impl_->stepper.is_processed(); }

std::vector<double> Simulation::momenta(int back) const {
  const Stepper& stepper = impl_->stepper;
  require_lagrangian(impl_->system);
  // the newest row has no stencils above it yet; the row before it may have none below it that are still held
  const int height = impl_->system.height();
  const Side side = back == 0 || height > 1 ? Side::below : Side::above;
  const int rows = back + 1 + (side == Side::below ? height : 0);
  if (rows > stepper.newest() + 1) throw std::logic_error("momenta need rows before the first");
  return delf::momenta(impl_->system, stepper.window(rows), stepper.newest() - back, side);
}

std::vector<Simulation::DatasetInfo> Simulation::datasets() const {
  std::vector<DatasetInfo> infos;
  for (const Dataset& dataset : impl_->method.datasets)
    infos.push_back({dataset.name, dataset.meaning, dataset.components(*impl_->theory)});
  return infos;
}

std::vector<double> Simulation::dataset(std::size_t which, int back) const {
  const Impl& s = *impl_;
  const std::int64_t newest = s.stepper.newest();
  const int rows = static_cast<int>(std::min<std::int64_t>(newest + 1, back + 2));
  return s.method.datasets.at(which).values({*s.theory, s.system, s.stepper.window(rows), newest, s.problem.time_step},
                                            newest - back);
}

const Evolution& Simulation::evolution() const { return impl_->evolution; }
const FieldTheory& Simulation::theory() const { return *impl_->theory; }
const std::vector<LinearSymmetry>& Simulation::symmetries() const { return impl_->symmetries; }
const std::vector<Component>& Simulation::components() const { return impl_->system.all_components(); }
int Simulation::count(Role role) const {
  return static_cast<int>(std::ranges::count(components(), role, &Component::role));
}
const std::vector<std::string>& Simulation::conserved_names() const { return impl_->conserved_names; }

std::vector<std::string> Simulation::monitor_names() const {
  std::vector<std::string> names;
  for (const Monitor& monitor : impl_->method.monitors) names.push_back(monitor.name);
  return names;
}

Simulation::Monitors Simulation::monitors() const {
  Impl& s = *impl_;
  if (!s.cell_weights.rows()) s.prepare_monitors();
  if (s.own_layout) s.copy_newest_pair();
  else s.stepper.newest_pair(s.monitored.data());
  const EnergyMomentum sums = s.energy_momentum();
  Monitors monitors{sums.energy, sums.momentum, s.charge(), s.constraint(), {}, {}, {}};
  for (const Monitor& monitor : s.method.monitors) monitors.of_method.push_back(monitor.value(s.newest_rows()));
  if (!s.conserved_names.empty()) s.find_conserved(monitors);
  return monitors;
}

int Simulation::iterations() const { return impl_->stepper.iterations(); }
double Simulation::residual() const { return impl_->stepper.residual(); }
const char* Simulation::solve_kind() const { return to_string(impl_->evolution.plan().kind); }
std::string Simulation::solve_summary() const { return solve_in_words(impl_->evolution.plan(), impl_->stepper); }
std::string Simulation::plan_report() const {
  std::string report = delf::plan_report(impl_->evolution.system(), impl_->evolution.plan(), impl_->stepper,
                                         impl_->monitor_bytes_of_run());
  for (const std::string& remark : impl_->remarks) report += remark + '\n';
  return report;
}
std::size_t Simulation::bytes() const { return impl_->stepper.bytes() + impl_->monitor_bytes(); }
std::size_t Simulation::bytes_of_run(Looks looks) const {
  const Stepper& stepper = impl_->stepper;
  const StepReport report = stepper.report(looks.residual);
  return report.bytes + report.bytes_to_come +
         (looks.monitors ? impl_->monitor_bytes_of_run() : impl_->monitor_bytes());
}

const std::vector<TheoryInfo>& theories() {
  static const std::vector<TheoryInfo> list = [] {
    std::vector<TheoryInfo> result;
    for (const TheoryEntry* entry : theory_entries()) {
      result.push_back({entry->name, entry->formula, {}, entry->further ? 0 : make_theory(*entry)->components()});
      for (const Parameter& p : entry->parameters) result.back().parameters.push_back(p.key);
    }
    return result;
  }();
  return list;
}

const std::vector<NamedFormula>& stencils() {
  static const std::vector<NamedFormula> list = [] {
    std::vector<NamedFormula> result;
    for (const NamedTable& table : named_tables()) result.push_back({table.name, table.description});
    return result;
  }();
  return list;
}

const std::vector<NamedFormula>& methods() {
  static const std::vector<NamedFormula> list = [] {
    std::vector<NamedFormula> result;
    for (const MethodEntry* entry : method_entries()) result.push_back({entry->name, entry->formula});
    return result;
  }();
  return list;
}

Problem completed(Problem p) {
  complete(p.parameters, parameters_of(find_theory(p.theory), p.parameters));
  complete(p.parameters, find_method(p.method).parameters);
  p.stencil = stencil_name(p.stencil, p.lattice.space() == Space::point);
  return p;
}

std::string scheme_label(const Problem& p) {
  const MethodEntry& method = find_method(p.method);
  return method.label ? method.label(completed(p)) : method.name;
}

std::vector<NamedScheme> named_schemes(const Problem& base) {
  std::vector<NamedScheme> result;
  for (const MethodEntry* entry : method_entries()) {
    Problem problem = base;
    problem.method = entry->name;
    if (!entry->variants) result.push_back({entry->name, std::move(problem)});
    else
      for (NamedScheme& scheme : entry->variants(problem)) result.push_back(std::move(scheme));
  }
  return result;
}

}  // namespace delf
