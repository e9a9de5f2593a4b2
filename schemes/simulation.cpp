// SPDX-License-Identifier: MIT
#include "schemes/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/row_monitors.hpp"
#include "schemes/start_values.hpp"
#include "schemes/starting_rows.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/gauge.hpp"
#include "schemes/stepping/plan_report.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/system/slab_extent.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_on_space.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "schemes/without_value.hpp"

namespace delf {
namespace {

SchemeParts make_parts(const FieldTheory& theory, const Problem& p) {
  if (p.time_step == 0 || !std::isfinite(p.time_step))
    throw BadInput("lattice.time_step", "lattice.time_step must be a finite number, and not 0");
  if (p.lattice.mesh() && !find_method(p.method).on_meshes)
    throw BadInput("scheme.method", fmt::format("scheme.method = {}: needs a regular lattice; use composition, cgvi or "
                                                "radau-iia on a mesh",
                                                p.method));
  for (const auto& [wall, key] : {std::pair{p.lattice.left(), "boundary.left"}, {p.lattice.right(), "boundary.right"}})
    if (wall == Wall::clamped && p.lattice.space() == Space::interval && !find_method(p.method).reads_stencil)
      throw BadInput(key,
                     fmt::format("{} = clamped: keeps phi_x too, which is for densities with second derivatives and "
                                 "scheme.method = multisymplectic; use fixed or natural",
                                 key));
  require_theory_on(theory, p.lattice.space());
  SchemeParts parts = find_method(p.method).build(theory, p);
  add_driven_ends(parts, theory, p);
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
  return {
      p.lattice,
      std::move(parts.families),
      p.time_step,
      {p.tolerance, p.predictor_order, p.max_iterations, p.circle_valued ? Fibre::circle : Fibre::real, monodromy_of(p),
       p.threads, std::move(parts.processor), p.step_control || !p.time_steps.empty(), std::move(parts.stepper)},
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
  RowMonitors monitors;
  StartingRows starts;
  std::optional<StepDensity> chosen_steps;  ///< where rows choose them

  Impl(const Problem& p, std::unique_ptr<FieldTheory> t, SchemeParts parts)
      : problem(p),
        method(find_method(p.method)),
        theory(std::move(t)),
        symmetries(std::move(parts.symmetries)),
        remarks(std::move(parts.remarks)),
        evolution(make_evolution(std::move(parts), p)),
        stepper(evolution.stepper()),
        system(evolution.system()),
        monitors(problem, *theory, symmetries, evolution),
        starts(problem, *theory, system) {
    if (p.step_control) take_step_control();
    else if (!p.time_steps.empty()) require_steps_of_any_length();
  }

  void require_steps_of_any_length() {
    const SlabExtent extent = slab_extent(system, evolution.plan());
    if (system.height() != 1 || extent.field_lag != 0 || extent.above != 0)
      throw BadInput(
          "lattice.time_steps",
          fmt::format("lattice.time_steps: scheme.method = {} has steps of one length; leave it out", method.name));
    begin_times();
  }
  /// Steps in turn begin with the first of their list.
  void begin_times() {
    if (!problem.time_steps.empty()) system.times()->begin(problem.time_steps.front());
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
  /// The density of steps that row 0 and its momenta, or the newest row, ask for.
  RowDensity row_density(const std::vector<double>& row0, std::span<const double> momenta) const {
    return method.row_density({*theory, system, system.window(0, {row0}, monodromy_of(problem)), 0, problem.time_step},
                              momenta, *problem.step_control);
  }
  RowDensity row_density() const {
    const RowsInTime rows = newest_rows(*theory, evolution);
    return method.row_density(rows, half_equations(system, rows.rows, rows.newest, Side::below), *problem.step_control);
  }
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta,
                      std::optional<double> density) {
    if (chosen_steps)
      system.times()->begin(density ? chosen_steps->go_on_from(*density)
                                    : chosen_steps->first(row_density(row0, momenta)));
    else begin_times();
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
    if (!problem.time_steps.empty()) {
      const auto n = at(stepper.newest()) % problem.time_steps.size();
      return step_by(problem.time_steps[n], looked_at);
    }
    if (!chosen_steps) return with_reasons([&] { stepper.step(looked_at); });
    const StepDensity before = *chosen_steps;
    try {
      step_by(chosen_steps->next(row_density()), looked_at);
    } catch (...) {
      chosen_steps = before;
      throw;
    }
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
    const bool pair = stepper.newest() >= 1 && stepper.held() >= 2;
    const std::string reason = pair ? without_value(system, stepper.window(2)) : std::string();
    return reason.empty() ? failure.what() : fmt::format("{}; {}", failure.what(), reason);
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
  impl_->begin_times();
  for (const auto& row : given) impl_->stepper.require_row(row.size());
  std::vector<std::vector<double>> rows = given;
  for (auto& row : rows) impl_->starts.hold_walls(row, false);
  impl_->starts.check_mirrors(rows[0]);
  impl_->stepper.start(impl_->problem.circle_valued ? impl_->starts.lifted(rows) : rows);
}

void Simulation::start_centred(std::span<const double> row0, std::span<const double> velocity) {
  if (impl_->chosen_steps)
    throw BadInput("initial.start", "initial.start = centred: takes steps of one length; use legendre");
  std::vector<std::vector<double>> rows{{row0.begin(), row0.end()}};
  if (impl_->problem.circle_valued) rows = impl_->starts.lifted(rows);
  impl_->starts.check_mirrors(rows[0]);
  const bool of_fields = std::ranges::all_of(components(), [](const Component& c) { return c.role == Role::field; });
  if (of_fields && impl_->system.height() == 1 && has_field_of_first_order(impl_->theory->density()))
    return start_from_rates(*this, rows[0], velocity, monodromy_of(impl_->problem));
  impl_->stepper.start_centred(rows[0], {velocity.begin(), velocity.end()});
}

void Simulation::step(bool looked_at) { impl_->step(looked_at); }
void Simulation::step_by(double time_step) { impl_->step_by(time_step, true); }
void Simulation::steps(int count) {
  if (impl_->system.times()->uniform()) return impl_->with_reasons([&] { impl_->stepper.steps(count); });
  for (; count > 0; --count) impl_->step(false);
}
void Simulation::visit(SavedState& state) {
  impl_->stepper.visit(state);
  if (!impl_->system.times()->uniform()) impl_->system.times()->visit(state);
  if (impl_->chosen_steps) impl_->chosen_steps->visit(state);
}
std::int64_t Simulation::newest() const { return impl_->stepper.newest(); }
double Simulation::time(std::int64_t row) const { return impl_->system.times()->time(row); }
std::optional<double> Simulation::step_density() const {
  return impl_->chosen_steps ? std::optional(impl_->chosen_steps->value()) : std::nullopt;
}
RowDensity Simulation::row_density() const { return impl_->row_density(); }

void Simulation::start_legendre(std::span<const double> fields, std::span<const double> rates) {
  for (const std::size_t values : {fields.size(), rates.size()}) impl_->stepper.require_row(values);
  std::vector<double> row0(fields.begin(), fields.end()), velocity(rates.begin(), rates.end());
  impl_->starts.hold_walls(row0, false), impl_->starts.hold_walls(velocity, true);
  impl_->starts.check_mirrors(row0);
  const auto momenta = impl_->starts.momenta(row0, velocity);
  if (!momenta)
    throw BadInput("initial.start", "initial.start = legendre: for schemes of elements, and scheme.method = " +
                                        impl_->method.name + " has none; use exact or centred");
  impl_->start_legendre(row0, *momenta, {});
}

void Simulation::start_momenta(std::span<const double> row0, std::span<const double> momenta,
                               std::optional<double> density) {
  for (const std::size_t values : {row0.size(), momenta.size()}) impl_->stepper.require_row(values);
  impl_->start_legendre({row0.begin(), row0.end()}, {momenta.begin(), momenta.end()}, density);
}

void Simulation::copy_row(int back, std::span<double> out, Role role) const {
  std::ranges::copy(row_of(impl_->evolution, role, back), out.begin());
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
const std::vector<std::string>& Simulation::conserved_names() const { return impl_->monitors.conserved_names(); }

std::vector<std::string> Simulation::monitor_names() const {
  std::vector<std::string> names;
  for (const Monitor& monitor : impl_->method.monitors) names.push_back(monitor.name);
  return names;
}

Simulation::Monitors Simulation::monitors() const { return impl_->monitors.now(); }

int Simulation::iterations() const { return impl_->stepper.iterations(); }
double Simulation::residual() const { return impl_->stepper.residual(); }
const char* Simulation::solve_kind() const { return to_string(impl_->evolution.plan().kind); }
std::string Simulation::solve_summary() const {
  std::string words = solve_in_words(impl_->evolution.plan(), impl_->stepper);
  if (const auto means = undetermined_means(impl_->system, impl_->evolution.plan()); !means.empty())
    words += fmt::format("; {}", gauge_in_words(impl_->system, means));
  return words;
}
std::string Simulation::plan_report() const {
  std::string report = delf::plan_report(impl_->evolution.system(), impl_->evolution.plan(), impl_->stepper,
                                         impl_->monitors.bytes_of_run());
  for (const std::string& remark : impl_->remarks) report += remark + '\n';
  return report;
}
std::size_t Simulation::bytes() const { return impl_->stepper.bytes() + impl_->monitors.bytes(); }
std::size_t Simulation::bytes_of_run(Looks looks) const {
  const Stepper& stepper = impl_->stepper;
  const StepReport report = stepper.report(looks.residual);
  return report.bytes + report.bytes_to_come +
         (looks.monitors ? impl_->monitors.bytes_of_run() : impl_->monitors.bytes());
}

}  // namespace delf
