// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_stepping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lattice/index.hpp"
#include "schemes/complex/asynchronous.hpp"
#include "schemes/complex/circle_fibre.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stability/mesh_frequency.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/system/mesh_energy.hpp"
#include "schemes/system/mesh_work.hpp"
#include "schemes/system/momenta.hpp"
#include "tools/complex/mesh_summary.hpp"
#include "tools/complex/mesh_warnings.hpp"
#include "tools/report/interrupt.hpp"
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

class AllSites final : public MeshStepping {
 public:
  AllSites(const ComplexScene& c, Outcome& outcome)
      : MeshStepping(c, outcome),
        simulation_(c.problem_on_mesh()),
        energy_(c.theory->shared_density(), *c.space),
        values_(c.space->fields_of_row()),
        before_(values_) {
    if (!c.boundary_works()) return;
    work_.emplace(simulation_.evolution().system(), c.theory->shared_density());
    outcome.conserved.push_back({energy_less_work, Outcome::unknown, Outcome::unknown, Outcome::unknown});
  }

  void describe(Outcome& o) const override {
    o.solve = simulation_.solve_summary();
    o.solve_kind = simulation_.solve_kind();
    o.bytes = simulation_.bytes();
    if (c_.has_method()) return;
    if (const auto most = longest_step(simulation_.evolution().system()); most && *most < c_.scene.problem.time_step)
      o.warnings.push_back(fmt::format("waves on this mesh grow at h = {:.4g} by linear theory; take h below {:.4g}",
                                       c_.scene.problem.time_step, *most));
  }

 private:
  void begin() override {
    delf::start(c_, simulation_);
    add_work();
    check_angles();
  }
  std::int64_t newest_row() const override { return simulation_.newest(); }
  double time(std::int64_t row) const override { return row == 0 ? 0 : simulation_.time(row); }
  double last_step() const { return steps().step(newest_row() - 1); }
  std::optional<double> own_length() const override {
    return steps().uniform() ? std::nullopt : std::optional(last_step());
  }
  std::optional<double> first_lengths() const override {
    if (!c_.step_control()) return {};
    return std::min(last_step(), c_.scene.problem.time_step / simulation_.row_density().density);
  }
  double energy_of_start() const override {
    // rates are projected onto the surface of a constraint, where there is one
    if (c_.has_method() || c_.space->constraint) return Outcome::unknown;
    std::vector<double> rates = c_.rates();
    for (std::size_t n = 0; n < rates.size(); ++n)
      if (c_.space->fixed[n / c_.fields.size()]) rates[n] = 0;
    if (work_) work_->give_rates(rates, 0);
    return energy_(c_.values(), rates, 0);
  }
  void step(bool looked_at) override {
    simulation_.step(looked_at || c_.scene.problem.circle_valued);
    add_work();
    check_angles();
  }
  int iterations() const override { return simulation_.iterations(); }
  MeshRow row(std::int64_t row) override {
    const bool is_newest = row >= newest_row(), is_whole = simulation_.evolution().stepper().held() > 1;
    const int back = is_newest ? 0 : 1;
    const double t = is_newest ? time(newest_row()) : 0;
    simulation_.copy_row(back, values_);
    MeshRow now{row, t, values_, Outcome::unknown, is_newest ? iterations() : 0, 0};
    if (is_newest && row > 0) now.residual = is_whole ? simulation_.residual() : Outcome::unknown;
    if (is_whole) {
      const bool needs_momenta = c_.has_method() || !c_.theory->symmetries().empty();
      const std::vector<double> p = needs_momenta ? momenta(back) : std::vector<double>();
      now.energy = c_.has_method() ? energy_of_row(p, t) : energy_between();
      // the energy between two rows is that of the half step
      if (work_)
        now.work = c_.has_method() ? (is_newest ? work_->sum() : work_->sum_before())
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
  void visit_fields(SavedState& state) override {
    simulation_.visit(state);
    if (work_) work_->visit(state), state("work of the first step", work_of_first_step_);
  }

  const RowTimes& steps() const { return *simulation_.evolution().system().times(); }
  void check_angles() {
    if (!c_.scene.problem.circle_valued) return;
    simulation_.copy_row(0, values_), simulation_.copy_row(1, before_);
    check_wrapped_differences(c_.space->mesh, values_, before_);
  }
  void add_work() {
    if (!work_) return;
    work_->add(simulation_.evolution().stepper().window(2));
    if (newest_row() == 1) work_of_first_step_ = 0.5 * work_->sum();
  }
  double energy_of_row(const std::vector<double>& p, double t) {
    std::vector<double> rates = energy_.rates(values_, p, t);
    if (work_) work_->give_rates(rates, t);
    return energy_(values_, rates, t);
  }
  /// Of the last two rows, whichever of them is asked for.
  double energy_between() {
    std::vector<double> newest(values_.size());
    simulation_.copy_row(0, newest), simulation_.copy_row(1, before_);
    return energy_.between(before_, newest, last_step(), time(newest_row()));
  }
  /// Of the fields at the newest row, or the one before it, [i·d + a]: the half of their equations.
  std::vector<double> momenta(int back) const {
    const Evolution& evolution = simulation_.evolution();
    const Stepper& stepper = evolution.stepper();
    const std::vector<double> all = half_equations(evolution.system(), stepper.window(2), stepper.newest() - back,
                                                   back == 0 ? Side::below : Side::above);
    const std::size_t C = simulation_.components().size(), d = c_.fields.size();
    std::vector<double> p;
    for (std::size_t n = 0; n < all.size(); n += C)
      p.insert(p.end(), all.begin() + static_cast<std::ptrdiff_t>(n), all.begin() + static_cast<std::ptrdiff_t>(n + d));
    return p;
  }
  /// λ of the row before, where the action has A_i ½(h_below + h_above) λ_i G(y_i): its stencils have λ_i G(y_i) alone.
  std::span<const double> multipliers() {
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
  Balance sum(const LinearSymmetry& symmetry, const std::vector<double>& p) const {
    const std::size_t d = c_.fields.size();
    Balance balance;
    for (std::size_t n = 0; n < p.size(); ++n) {
      const std::size_t a = n % d;
      balance.add(p[n] * generator_at(symmetry, a, values_.data() + n - a));
    }
    return balance;
  }

  Simulation simulation_;
  MeshEnergy energy_;
  std::optional<MeshWork> work_;   ///< of a boundary that does any
  double work_of_first_step_ = 0;  ///< at its middle
  std::vector<double> values_, before_, multipliers_;
};

/// True if ξ is not zero at a point that is fixed: what the symmetry conserves is taken up there.
bool moves_boundary(const LinearSymmetry& symmetry, const CellSpace& space, const std::vector<double>& values) {
  const std::size_t d = symmetry.shift.size();
  const auto not_zero = [](double x) { return x != 0; };
  if (!space.driven.empty() || !space.fluxes.empty())
    return std::ranges::any_of(symmetry.shift, not_zero) || std::ranges::any_of(symmetry.matrix, not_zero);
  for (std::size_t n = 0; n < values.size(); ++n)
    if (space.fixed[n / d] && generator_at(symmetry, n % d, values.data() + n - n % d) != 0) return true;
  return false;
}

/// Row n is at n h, with h = scene.problem.time_step.
class OwnSteps final : public MeshStepping {
 public:
  OwnSteps(const ComplexScene& c, Outcome& outcome) : MeshStepping(c, outcome), evolution_(*c.space, cell_steps(c)) {}

  void describe(Outcome& o) const override {
    o.solve = "each cell by its own step, in the order of a priority queue (explicit)";
    o.solve_kind = "explicit";
    o.bytes = evolution_.bytes();
    o.updates = evolution_.updates();
  }

 private:
  void begin() override { evolution_.start(c_.values(), c_.rates()); }
  std::int64_t newest_row() const override { return newest_; }
  double time(std::int64_t row) const override { return static_cast<double>(row) * c_.scene.problem.time_step; }
  std::optional<double> own_length() const override { return {}; }
  void step(bool) override { evolution_.advance(time(newest_ + 1)), ++newest_; }
  int iterations() const override { return 0; }
  MeshRow row(std::int64_t row) override {
    values_ = evolution_.values(time(newest_));
    MeshRow now{
        row, time(newest_), values_, evolution_.energy(time(newest_)), 0, Outcome::unknown, evolution_.node_times()};
    for (const LinearSymmetry& symmetry : c_.theory->symmetries()) now.momenta.push_back(evolution_.momentum(symmetry));
    return now;
  }
  void visit_fields(SavedState& state) override {
    state("newest row", newest_);
    evolution_.visit(state);
  }

  AsynchronousEvolution evolution_;
  std::int64_t newest_ = 0;
  std::vector<double> values_;
};

}  // namespace

MeshStepping::MeshStepping(const ComplexScene& c, Outcome& outcome)
    : RowLoop(c.scene, outcome, watched_rows(c)), c_(c), outcome_(outcome) {
  for (const LinearSymmetry& s : c.theory->symmetries())
    outcome.conserved.push_back({s.name, Outcome::unknown, Outcome::unknown, Outcome::unknown});
}

/// What the run is measured by is of row 0, recorded or not.
void MeshStepping::make_first_rows() {
  begin();
  if (const auto shortest = first_lengths()) refuse_tiny_steps(c_.scene, *shortest, "<phi_t^2>");
  const MeshRow first = row(0);
  outcome_.energy_initial = first.energy;
  for (std::size_t n = 0; n < first.momenta.size(); ++n) {
    outcome_.conserved[n].take(first.momenta[n].sum, first.momenta[n].absolute);
    outcome_.conserved[n].at_walls = moves_boundary(c_.theory->symmetries()[n], *c_.space, c_.values());
  }
  if (c_.boundary_works()) outcome_.conserved.back().take(first.energy - first.work, std::abs(first.energy));
}

MeshRow MeshStepping::last_row() {
  begin();
  while (!c_.scene.is_over(newest_row(), time(newest_row())) && !Interrupt::asked()) step(true);
  return row(newest_row());
}

void MeshStepping::visit_rows(SavedState& state) {
  const Checksum mesh = checksum_of(c_);
  Checksum saved = mesh;
  state("mesh", saved);
  if (saved != mesh)
    throw c_.scene.settings.error("lattice.mesh",
                                  "is another mesh than the run began with; put that back, or begin anew");
  visit_fields(state);
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
  // of asynchronous steps there is no residual, nor of the rows that a step has left that failed
  if (c_.time == MeshTime::cells || (std::isnan(row.residual) && !outcome_.failure.empty())) return;
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

std::unique_ptr<MeshStepping> make_mesh_stepping(const ComplexScene& c, Outcome& outcome) {
  if (c.time == MeshTime::cells) return std::make_unique<OwnSteps>(c, outcome);
  return std::make_unique<AllSites>(c, outcome);
}

std::vector<double> cell_steps(const ComplexScene& c) {
  std::vector<double> steps;
  for (int cell = 0; cell < c.space->mesh.cells(); ++cell)
    steps.push_back(c.courant * shortest_edge(c.space->mesh, cell));
  return steps;
}

}  // namespace delf
