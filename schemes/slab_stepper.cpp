// SPDX-License-Identifier: MIT
#include "schemes/slab_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/flush_denormals.hpp"
#include "schemes/slab_extent.hpp"

namespace delf {
SlabStepper::SlabStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : system_(system), plan_(plan), options_(options), components_(system.components()) {
  SlabExtent extent = slab_extent(system, plan);
  future_ = extent.above;
  lag_ = extent.field_lag;
  back_ = std::move(extent.behind);
  seed_order_ = std::clamp(options.seed_order, 1, 3);
  past_ = std::max(plan.history, seed_order_ + 1 + extent.below);
  starting_rows_ = std::max(plan.history, 1) + future_;
  const std::size_t row = static_cast<std::size_t>(system.lattice().sites()) * static_cast<std::size_t>(components_);
  ring_ = std::make_unique<SectionRing>(past_ + future_ + 1, row);
  for (int p = 0; p < plan.table.parities; ++p) {
    SlabEquations equations(system, plan, p, past_, future_, options.turn);
    BlockSolver solver = equations.solver();
    parities_.push_back({std::move(equations), std::move(solver)});
  }
}

void SlabStepper::start(const std::vector<std::vector<double>>& rows) {
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (std::ranges::any_of(rows[r], [](double x) { return overflowed(std::abs(x)); }))
      throw NotFinite(fmt::format("row {} of the start is not finite", r));
    if (const auto i = crossing(rows[r].data()))
      throw BadInput("initial.file", fmt::format("sites {} and {} of the mesh are not in order in row {}; give rows in "
                                                 "which the positions grow",
                                                 *i, *i + 1, r));
    std::ranges::copy(rows[r], ring_->row(static_cast<std::int64_t>(r)));
  }
  J_ = static_cast<std::int64_t>(rows.size()) - 1 - future_;
  known_ = 0;
}

void SlabStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  if (plan_.history != 2 || future_ != 0 || lag_ != 0)
    throw BadInput("initial.start", "initial.start = legendre: this scheme is not one slab's map; use exact");
  start({row0});
  solve(1, &momenta);
  J_ = 1;
}

/// The polynomial through the values that the last slabs gave.
void SlabStepper::seed(Parity& p, std::int64_t J) {
  // What has no equation keeps its value: fixed walls.
  const std::size_t size = static_cast<std::size_t>(system_.lattice().sites() * components_);
  std::copy_n(ring_->row(J + future_ - 1), size, ring_->row(J + future_));
  for (int n = 0; n < p.equations.size(); ++n) {
    const Node& u = p.equations.unknown(n);
    const bool field = system_.component(u.component).role == Role::field;
    // Starting rows hold the fields; multipliers and inner nodes are known from the slabs that were solved.
    const std::int64_t available = field ? J + u.site.time : known_;
    const int order = static_cast<int>(std::min<std::int64_t>(seed_order_, available - 1));
    double sum = 0, coefficient = -1;
    for (int m = 1; m <= order + 1; ++m) {
      coefficient *= -static_cast<double>(order + 2 - m) / m;
      sum += coefficient * ring_->row(J + u.site.time - m)[u.site.space * components_ + u.component];
    }
    if (order < 0) {
      // An inner node with no past: the value of its cell's vertex. A multiplier: zero.
      const bool inner = system_.component(u.component).role == Role::inner;
      sum = inner ? ring_->row(J + u.site.time)[u.site.space * components_ + u.component % system_.fields()] : 0;
    }
    p.equations.value(*ring_, J, n) = sum;
  }
}

void SlabStepper::fail(std::int64_t J, const char* why) const {
  throw NoConvergence(
      fmt::format("step {}, t = {:.6g}: the equations of the slab were not solved: {}; reduce lattice.courant or "
                  "lattice.time_step",
                  J, static_cast<double>(J) * system_.time_step(), why));
}

/// The first of two neighbouring sites that have passed each other in a row, where a component is the position of the
/// sites: Newton's method is content with a tangled mesh, since the equations do not know which site comes first.
std::optional<int> SlabStepper::crossing(const double* row) const {
  for (int c = 0; c < components_; ++c)
    for (int i = 0; system_.component(c).position && i + 1 < system_.lattice().sites(); ++i)
      if (!(row[i * components_ + c] < row[(i + 1) * components_ + c])) return i;
  return std::nullopt;
}

void SlabStepper::solve(std::int64_t J, const std::vector<double>* momenta) {
  const FlushDenormals guard;
  Parity& p = parity(J);
  const int size = p.equations.size();
  seed(p, J);
  iterations_ = 0;
  bool fresh = false, refactor = !p.factored || momenta;
  double before = std::numeric_limits<double>::infinity();
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  for (;;) {
    if (++iterations_ > options_.max_iterations) fail(J, "Newton's method does not converge");
    if (refactor) {
      p.equations.jacobian(*ring_, J, jacobian_, momenta);
      p.factored = p.solver.factor(jacobian_);
      if (!p.factored) fail(J, "their Jacobian is singular");
      fresh = true;
    }
    p.equations.residual(*ring_, J, E_, nullptr, momenta);
    p.solver.solve(E_, change_);
    // Multipliers are not asked: they have no scale of their own, and converge with what they act on.
    double change = 0, value = 0;
    bool finite = true;
    for (int n = 0; n < size; ++n) {
      double& y = p.equations.value(*ring_, J, n);
      const double by = change_[static_cast<std::size_t>(n)];
      y -= by;
      finite = finite && !overflowed(std::abs(y));
      if (system_.component(p.equations.unknown(n).component).role == Role::multiplier) continue;
      change = std::max(change, std::abs(by));
      value = std::max(value, std::abs(y));
    }
    if (!finite) {
      p.factored = false;
      fail(J, "Newton's method diverges");
    }
    if (change <= std::max(options_.tolerance, 4 * epsilon) * value) break;
    const bool slow = change > 0.1 * before;
    // Changes that no longer shrink are rounding, if they are small.
    if (slow && change > 0.25 * before && change <= 512 * epsilon * value) break;
    if (slow && fresh && iterations_ > 8 && change > before) fail(J, "Newton's method diverges");
    // Small blocks cost less to factor than an iteration more.
    refactor = slow || p.solver.largest_block() <= 24 || (iterations_ == 1 && !fresh && change > 1e-3 * value);
    fresh = fresh && !slow;
    before = change;
  }
  if (momenta) p.factored = false;
  if (const auto i = crossing(ring_->row(J - lag_)))
    throw MeshCrossing(fmt::format(
        "step {}, t = {:.6g}: sites {} and {} of the mesh pass each other; reduce lattice.time_step or scheme.alpha", J,
        static_cast<double>(J) * system_.time_step(), *i, *i + 1));
  ++known_;
}

void SlabStepper::step() {
  solve(J_ + 1, nullptr);
  ++J_;
}

std::vector<double> SlabStepper::row(int back) const {
  std::vector<double> result(static_cast<std::size_t>(system_.lattice().sites() * components_));
  for (int c = 0; c < components_; ++c) {
    const double* values = ring_->row(newest() - back - back_[static_cast<std::size_t>(c)]);
    for (std::size_t at = static_cast<std::size_t>(c); at < result.size(); at += static_cast<std::size_t>(components_))
      result[at] = values[at];
  }
  return result;
}

Window SlabStepper::window(int rows) const {
  const std::size_t size = static_cast<std::size_t>(system_.lattice().sites() * components_);
  std::vector<std::vector<double>> newest_rows;
  for (std::int64_t r = newest() - rows + 1; r <= newest(); ++r)
    newest_rows.emplace_back(ring_->row(r), ring_->row(r) + size);
  return system_.window(newest() - rows + 1, std::move(newest_rows), options_.turn);
}

double SlabStepper::residual() const {
  if (known_ == 0) return 0;
  const Parity& p = parity(J_);
  // After a Legendre start slab 1 has no stencils below row 0.
  if (J_ == 1 && plan_.history > 1) return 0;
  p.equations.residual(*ring_, J_, residual_, &absolute_);
  // The equation of a multiplier is a constraint, whose terms cancel within one stencil: it is measured on its own.
  double worst = 0, size = 0;
  for (int n = 0; n < p.equations.size(); ++n) {
    if (system_.component(p.equations.equation(n).component).role == Role::multiplier) continue;
    worst = std::max(worst, std::abs(residual_[static_cast<std::size_t>(n)]));
    size = std::max(size, absolute_[static_cast<std::size_t>(n)]);
  }
  return size > 0 ? worst / size : 0;
}

std::string SlabStepper::solver_name() const { return parities_[0].solver.name(); }

std::size_t SlabStepper::bytes() const {
  std::size_t total = ring_->bytes();
  for (const Parity& p : parities_) total += p.equations.bytes() + p.solver.bytes();
  return total;
}

std::string SlabStepper::memory_report() const {
  std::size_t equations = 0, matrix = 0;
  for (const Parity& p : parities_) equations += p.equations.bytes(), matrix += p.solver.bytes();
  return fmt::format("rows of the section {} B, stencils {} B, Jacobian and factors {} B", ring_->bytes(), equations,
                     matrix);
}

}  // namespace delf
