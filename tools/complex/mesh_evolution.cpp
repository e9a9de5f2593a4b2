// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_evolution.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "schemes/complex/asynchronous.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/mesh_energy.hpp"
#include "schemes/system/momenta.hpp"
#include "tools/complex/complex_commands.hpp"
#include "tools/complex/row_steps.hpp"

namespace delf {
namespace {

class AllSites final : public MeshEvolution {
 public:
  explicit AllSites(const ComplexScene& c)
      : c_(c),
        evolution_(*c.space, c.time_step(0), {c.scene.problem.tolerance, c.scene.problem.max_iterations}),
        steps_(c) {}

  void start() override { steps_.start(evolution_); }
  std::int64_t newest() const override { return evolution_.newest(); }
  double time() const override { return evolution_.time(); }
  double last_step() const override { return evolution_.last_step(); }
  std::optional<double> own_length() const override {
    return c_.time_steps.empty() && !c_.step_control() ? std::nullopt : std::optional(evolution_.last_step());
  }
  std::optional<double> first_lengths() const override { return steps_.first_lengths(evolution_); }
  double energy_of_start() const override {
    // rates are projected onto the surface of a constraint, where there is one
    return c_.space->constraint ? Outcome::unknown : evolution_.energy(c_.values(), c_.rates());
  }
  void step() override { steps_.step(evolution_); }
  int iterations() const override { return evolution_.is_direct() ? 0 : evolution_.report().iterations; }
  MeshRow row(std::int64_t row) override {
    const bool newest = row >= evolution_.newest();
    MeshRow now{row,
                newest ? evolution_.time() : 0,
                evolution_.row(newest ? 0 : 1),
                evolution_.energy(),
                newest ? evolution_.report().iterations : 0,
                newest && row > 0 ? evolution_.residual() : 0};
    for (const LinearSymmetry& symmetry : c_.theory->symmetries()) now.momenta.push_back(evolution_.momentum(symmetry));
    if (c_.space->constraint) now.constraint = c_.space->largest_constraint(now.values);
    if (newest) now.multipliers = evolution_.multipliers();
    return now;
  }
  void visit(SavedState& state) override {
    evolution_.visit(state);
    steps_.visit(state);
  }
  void describe(Outcome& o) const override {
    o.solve = evolution_.plan().describe() + (evolution_.is_direct() ? " (explicit)" : "");
    o.solve_kind = evolution_.is_direct() ? "explicit" : "sparse";
    o.bytes = evolution_.bytes();
    if (const auto most = evolution_.largest_step(); most && *most < c_.scene.problem.time_step)
      o.warnings.push_back(fmt::format("waves on this mesh grow at h = {:.4g} by linear theory; take h below {:.4g}",
                                       c_.scene.problem.time_step, *most));
  }

 private:
  const ComplexScene& c_;
  SpaceEvolution evolution_;
  RowSteps steps_;
};

/// The lattice's own steps, by a method's families on the sites and cells.
class ByMethod final : public MeshEvolution {
 public:
  explicit ByMethod(const ComplexScene& c)
      : c_(c),
        simulation_(c.problem_on_mesh()),
        energy_(c.theory->shared_density(), *c.space),
        values_(c.space->fields_of_row()) {}

  void start() override { delf::start(c_, simulation_); }
  std::int64_t newest() const override { return simulation_.newest(); }
  double time() const override { return simulation_.time(newest()); }
  double last_step() const override { return c_.scene.problem.time_step; }
  void step() override { simulation_.step(); }
  int iterations() const override { return simulation_.iterations(); }
  MeshRow row(std::int64_t row) override {
    const bool is_newest = row >= newest();
    const int back = is_newest ? 0 : 1;
    const double t = is_newest ? time() : 0;
    simulation_.copy_row(back, values_);
    const std::vector<double> p = momenta(back);
    MeshRow now{row, t, values_, energy_(values_, energy_.rates(values_, p, t), t), is_newest ? iterations() : 0,
                is_newest && row > 0 ? simulation_.residual() : 0};
    for (const LinearSymmetry& symmetry : c_.theory->symmetries()) now.momenta.push_back(sum(symmetry, p));
    if (c_.space->constraint) now.constraint = c_.space->largest_constraint(now.values);
    if (simulation_.count(Role::multiplier) == 1 && is_newest) {
      multipliers_.resize(static_cast<std::size_t>(c_.sites()));
      simulation_.copy_row(0, multipliers_, Role::multiplier);
      now.multipliers = multipliers_;
    }
    return now;
  }
  void visit(SavedState& state) override { simulation_.visit(state); }
  void describe(Outcome& o) const override {
    o.solve = simulation_.solve_summary();
    o.solve_kind = simulation_.solve_kind();
    o.bytes = simulation_.bytes();
  }

 private:
  /// Of the fields at the newest row, or the one before it, [i·d + a]: the half of their equations.
  std::vector<double> momenta(int back) const {
    const Evolution& evolution = simulation_.evolution();
    const Stepper& stepper = evolution.stepper();
    const std::vector<double> all = half_equations(evolution.system(), stepper.window(2), stepper.newest() - back,
                                                   back == 0 ? Side::below : Side::above);
    const std::size_t C = simulation_.components().size(), d = c_.fields.size();
    std::vector<double> p;
    for (std::size_t n = 0; n < all.size(); n += C) p.insert(p.end(), all.begin() + static_cast<std::ptrdiff_t>(n),
                                                             all.begin() + static_cast<std::ptrdiff_t>(n + d));
    return p;
  }
  /// Σ_i p_i · ξ(φ_i)
  Balance sum(const LinearSymmetry& symmetry, const std::vector<double>& p) const {
    const std::size_t d = c_.fields.size();
    Balance balance;
    for (std::size_t n = 0; n < p.size(); ++n) {
      const std::size_t a = n % d;
      double xi = symmetry.shift[a];
      for (std::size_t b = 0; b < d; ++b) xi += symmetry.matrix[a * d + b] * values_[n - a + b];
      balance.add(p[n] * xi);
    }
    return balance;
  }

  const ComplexScene& c_;
  Simulation simulation_;
  MeshEnergy energy_;
  std::vector<double> values_, multipliers_;
};

/// Row n is at n h, with h = scene.problem.time_step.
class OwnSteps final : public MeshEvolution {
 public:
  explicit OwnSteps(const ComplexScene& c) : c_(c), evolution_(*c.space, cell_steps(c)) {}

  void start() override { evolution_.start(c_.values(), c_.rates()); }
  std::int64_t newest() const override { return newest_; }
  double time() const override { return static_cast<double>(newest_) * c_.scene.problem.time_step; }
  double last_step() const override { return c_.scene.problem.time_step; }
  void step() override { evolution_.advance(static_cast<double>(newest_ + 1) * last_step()), ++newest_; }
  MeshRow row(std::int64_t row) override {
    values_ = evolution_.values(time());
    MeshRow now{row, time(), values_, evolution_.energy(time()), 0, Outcome::unknown, evolution_.node_times()};
    for (const LinearSymmetry& symmetry : c_.theory->symmetries()) now.momenta.push_back(evolution_.momentum(symmetry));
    return now;
  }
  void visit(SavedState& state) override {
    state("newest row", newest_);
    evolution_.visit(state);
  }
  void describe(Outcome& o) const override {
    o.solve = "each cell by its own step, in the order of a priority queue (explicit)";
    o.solve_kind = "explicit";
    o.bytes = evolution_.bytes();
    o.updates = evolution_.updates();
  }

 private:
  const ComplexScene& c_;
  AsynchronousEvolution evolution_;
  std::int64_t newest_ = 0;
  std::vector<double> values_;
};

}  // namespace

void start(const ComplexScene& c, Simulation& simulation) {
  const std::vector<double> values = c.values(), rates = c.rates();
  std::vector<double> row, velocity;
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.sites()); ++i)
    for (const Component& component : simulation.components()) {
      const std::size_t at = i * c.fields.size() + static_cast<std::size_t>(component.field);
      row.push_back(component.role == Role::multiplier ? 0 : values[at]);
      velocity.push_back(component.role == Role::field ? rates[at] : 0);
    }
  simulation.start_legendre(row, velocity);
}

std::unique_ptr<MeshEvolution> make_mesh_evolution(const ComplexScene& c) {
  if (c.time == MeshTime::cells) return std::make_unique<OwnSteps>(c);
  if (c.has_method()) return std::make_unique<ByMethod>(c);
  return std::make_unique<AllSites>(c);
}

std::vector<double> cell_steps(const ComplexScene& c) {
  std::vector<double> steps;
  for (int cell = 0; cell < c.space->mesh.cells(); ++cell)
    steps.push_back(c.courant * shortest_edge(c.space->mesh, cell));
  return steps;
}

}  // namespace delf
