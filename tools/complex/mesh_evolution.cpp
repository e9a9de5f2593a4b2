// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_evolution.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "schemes/complex/asynchronous.hpp"
#include "schemes/stepping/saved_state.hpp"
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

std::unique_ptr<MeshEvolution> make_mesh_evolution(const ComplexScene& c) {
  if (c.time == MeshTime::cells) return std::make_unique<OwnSteps>(c);
  return std::make_unique<AllSites>(c);
}

std::vector<double> cell_steps(const ComplexScene& c) {
  std::vector<double> steps;
  for (int cell = 0; cell < c.space->mesh.cells(); ++cell)
    steps.push_back(c.courant * shortest_edge(c.space->mesh, cell));
  return steps;
}

}  // namespace delf
