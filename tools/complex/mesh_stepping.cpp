// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_stepping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lattice/index.hpp"
#include "schemes/complex/circle_fibre.hpp"
#include "schemes/stability/mesh_frequency.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/system/momenta.hpp"
#include "tools/complex/mesh_summary.hpp"
#include "tools/complex/mesh_warnings.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/run/moves_walls.hpp"
#include "tools/run/stepping.hpp"
#include "tools/run/tiny_steps.hpp"

namespace delf {
namespace {

/// Of points and cells.
Checksum checksum_of(const ComplexScene& c) {
  Checksum sum;
  sum.add(c.places());
  const auto& vertices = c.space->mesh.vertices;
  sum.add(std::vector<double>(vertices.begin(), vertices.end()));
  return sum;
}

// To measure a row costs some eight explicit steps.
WatchedRows watched_rows(const ComplexScene& c) {
  constexpr std::int64_t apart = 384, most_values = 1024;
  return {most_values / (c.sites() * static_cast<std::int64_t>(c.fields.size())), apart, c.scene.initial.seed};
}

}  // namespace

MeshStepping::MeshStepping(const ComplexScene& c, Outcome& outcome)
    : RowLoop(c.scene, outcome, simulation_, watched_rows(c)),
      c_(c),
      outcome_(outcome),
      simulation_(c.problem_on_mesh()),
      energy_(c.theory->shared_density(), *c.space),
      values_(c.space->fields_of_row()),
      before_(values_) {
  for (const LinearSymmetry& s : c.theory->symmetries())
    outcome.conserved.push_back({s.name, Outcome::unknown, Outcome::unknown, Outcome::unknown});
  if (!c.boundary_works()) return;
  work_.emplace(simulation_.evolution().system(), c.theory->shared_density());
  outcome.conserved.push_back({energy_less_work, Outcome::unknown, Outcome::unknown, Outcome::unknown});
}

const Stepper& MeshStepping::stepper() const { return simulation_.evolution().stepper(); }
const RowTimes& MeshStepping::steps() const { return *simulation_.evolution().system().times(); }

void MeshStepping::describe(Outcome& o) const {
  const Problem& p = c_.scene.problem;
  o.solve = simulation_.solve_summary();
  o.solve_kind = simulation_.solve_kind();
  o.bytes = simulation_.bytes();
  o.updates = stepper().updates();
  if (c_.has_method() || p.cell_courant > 0) return;
  if (const auto most = longest_step(simulation_.evolution().system()); most && *most < p.time_step)
    o.warnings.push_back(
        fmt::format("waves on this mesh grow at h = {:.4g} by linear theory; take h below {:.4g}", p.time_step, *most));
}

/// The run is measured by row 0, recorded or not.
void MeshStepping::make_first_rows() {
  start_rows();
  if (c_.step_control())
    refuse_tiny_steps(c_.scene, std::min(last_step(), c_.scene.problem.time_step / simulation_.row_density().density),
                      "<phi_t^2>");
  const MeshRow first = row(0);
  outcome_.energy_initial = first.energy;
  for (std::size_t n = 0; n < first.momenta.size(); ++n) {
    outcome_.conserved[n].take(first.momenta[n].sum, first.momenta[n].absolute);
    outcome_.conserved[n].at_walls = moves_walls(c_.theory->symmetries()[n], c_.values(), c_.scene.problem);
  }
  if (c_.boundary_works()) outcome_.conserved.back().take(first.energy - first.work, std::abs(first.energy));
}

void MeshStepping::step(bool looked_at) {
  simulation_.step(looked_at || c_.scene.problem.circle_valued);
  add_work();
  check_angles();
}

void MeshStepping::start_rows() {
  delf::start(c_, simulation_);
  add_work();
  check_angles();
}

void MeshStepping::add_work() {
  if (!work_) return;
  work_->add(stepper().window(2));
  if (newest_row() == 1) work_of_first_step_ = 0.5 * work_->sum();
}

void MeshStepping::check_angles() {
  if (!c_.scene.problem.circle_valued) return;
  simulation_.copy_row(0, values_), simulation_.copy_row(1, before_);
  check_wrapped_differences(c_.space->mesh, values_, before_);
}

double MeshStepping::energy_of_start() const {
  // rates are projected onto the surface of a constraint, where there is one
  if (c_.has_method() || c_.space->constraint) return Outcome::unknown;
  std::vector<double> rates = c_.rates();
  for (std::size_t n = 0; n < rates.size(); ++n)
    if (c_.space->fixed[n / c_.fields.size()]) rates[n] = 0;
  if (work_) work_->give_rates(rates, 0);
  return energy_(c_.values(), rates, 0);
}

MeshRow MeshStepping::row(std::int64_t row) {
  const bool is_newest = row >= newest_row(), is_pair = stepper().held() > 1;
  const int back = is_newest ? 0 : 1;
  const double t = is_newest ? simulation_.time(newest_row()) : 0;
  simulation_.copy_row(back, values_);
  MeshRow now{row, t, values_, Outcome::unknown, is_newest ? simulation_.iterations() : 0, 0, stepper().site_times()};
  std::vector<double> p = stepper().own_momenta();
  const bool has_own = !p.empty();
  if (has_own) now.residual = Outcome::unknown;
  else if (is_newest && row > 0) now.residual = is_pair ? simulation_.residual() : Outcome::unknown;
  if (is_pair || has_own) {
    const bool of_row = c_.has_method() || has_own;
    if (!has_own && (of_row || !c_.theory->symmetries().empty())) p = momenta(back);
    now.energy = of_row ? energy_of_row(p, t) : energy_between();
    // the energy between two rows is that of the half step
    if (work_)
      now.work = of_row ? (is_newest ? work_->sum() : work_->sum_before())
                        : 0.5 * (work_->sum_before() + work_->sum()) - work_of_first_step_;
    for (const LinearSymmetry& symmetry : c_.theory->symmetries()) now.momenta.push_back(sum(symmetry, p));
  } else {  // a start that failed left row 0 alone
    now.energy = energy_of_start();
    now.momenta.resize(c_.theory->symmetries().size(), {Outcome::unknown, 0, 0});
  }
  if (c_.space->constraint) now.constraint = c_.space->largest_constraint(now.values);
  if (c_.space->constraint && simulation_.count(Role::multiplier) == c_.space->constraints() && is_newest)
    now.multipliers = multipliers();
  return now;
}

double MeshStepping::energy_of_row(const std::vector<double>& p, double t) {
  std::vector<double> rates = energy_.rates(values_, p, t);
  if (work_) work_->give_rates(rates, t);
  return energy_(values_, rates, t);
}

/// The energy of the last two rows, whichever of them is asked for.
double MeshStepping::energy_between() {
  std::vector<double> newest(values_.size());
  simulation_.copy_row(0, newest), simulation_.copy_row(1, before_);
  return energy_.between(before_, newest, last_step(), simulation_.time(newest_row()));
}

/// The momenta of the fields at the newest row, or the one before it, [i·d + a]: the half of their equations.
std::vector<double> MeshStepping::momenta(int back) const {
  const std::vector<double> all = half_equations(simulation_.evolution().system(), stepper().window(2),
                                                 stepper().newest() - back, back == 0 ? Side::below : Side::above);
  const std::size_t C = simulation_.components().size(), d = c_.fields.size();
  std::vector<double> p;
  for (std::size_t n = 0; n < all.size(); n += C)
    p.insert(p.end(), all.begin() + static_cast<std::ptrdiff_t>(n), all.begin() + static_cast<std::ptrdiff_t>(n + d));
  return p;
}

/// λ of the row before, where the action has A_i ½(h_below + h_above) λ_i G(y_i): its stencils have λ_i G(y_i) alone.
std::span<const double> MeshStepping::multipliers() {
  multipliers_.resize(c_.space->multipliers_of_row());
  simulation_.copy_row(0, multipliers_, Role::multiplier);
  const std::int64_t row = newest_row() - 1;
  const double above = steps().step(row), below = row > 0 ? steps().step(row - 1) : above;
  const std::size_t m = at(c_.space->constraints());
  for (std::size_t n = 0; n < multipliers_.size(); ++n)
    multipliers_[n] /= 0.5 * (below + above) * c_.space->masses[n / m];
  return multipliers_;
}

/// Σ_i p_i · ξ(φ_i)
Balance MeshStepping::sum(const LinearSymmetry& symmetry, const std::vector<double>& p) const {
  const std::size_t d = c_.fields.size();
  Balance balance;
  for (std::size_t n = 0; n < p.size(); ++n) {
    const std::size_t a = n % d;
    balance.add(p[n] * generator_at(symmetry, a, values_.data() + n - a));
  }
  return balance;
}

MeshRow MeshStepping::last_row() {
  start_rows();
  while (!c_.scene.is_over(newest_row(), simulation_.time(newest_row())) && !Interrupt::asked()) step(true);
  return row(newest_row());
}

void MeshStepping::visit_rows(SavedState& state) {
  const Checksum mesh = checksum_of(c_);
  Checksum saved = mesh;
  state("mesh", saved);
  if (saved != mesh)
    throw c_.scene.settings.error("lattice.mesh",
                                  "is another mesh than the run began with; put that back, or begin anew");
  simulation_.visit(state);
  if (work_) work_->visit(state), state("work of the first step", work_of_first_step_);
}

void MeshStepping::run(MeshRecorder& recorder, Checkpoints& checkpoints) {
  recorder_ = &recorder;
  RowLoop::run(recorder, checkpoints);
}

void MeshStepping::record(std::int64_t row) {
  const MeshRow now = this->row(row);
  judge(now);
  recorder_->record(now);
}

void MeshStepping::watch() {
  const MeshRow now = row(newest());
  judge(now);
  recorder_->watch(now);
}

void MeshStepping::judge(const MeshRow& row) const {
  // rows of cells with steps of their own have no residual, nor have those that a failed step has left
  if (std::isnan(row.residual) && (!row.node_times.empty() || !outcome_.failure.empty())) return;
  if (!is_solution(row.residual, c_.scene.problem.tolerance))
    throw NoConvergence(
        fmt::format("step {}, t = {:.6g}: the residual of the field equations is {:.2g} of their terms; "
                    "reduce lattice.courant or lattice.time_step",
                    row.row, row.time, row.residual));
}

// A newest row that is not recorded is no result.
void MeshStepping::finish() {
  if (recorded() != c_.scene.last_row(newest())) return;
  const std::span<const double> last = row(recorded()).values;
  measure_error(c_, last, outcome_.time, outcome_);
  if (started())
    std::ranges::move(warnings_of_rows(c_, outcome_, energy_of_start(), recorder_->energy_errors(), last),
                      std::back_inserter(outcome_.warnings));
}

void start(const ComplexScene& c, Simulation& simulation) {
  const std::vector<double> values = c.values(), rates = c.rates();
  std::vector<double> row, velocity;
  for (std::size_t i = 0; i < delf::at(c.sites()); ++i)
    for (const Component& component : simulation.components()) {
      const std::size_t at = i * c.fields.size() + delf::at(component.field);
      row.push_back(component.role == Role::multiplier ? 0 : values[at]);
      velocity.push_back(component.role == Role::field ? rates[at] : 0);
    }
  simulation.start_legendre(row, velocity);
}

}  // namespace delf
