// SPDX-License-Identifier: MIT
#include "schemes/stepping/slab_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "jets/simd/pack_gather.hpp"
#include "schemes/stepping/rows/extrapolation.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/system/slab_extent.hpp"

namespace delf {
SlabStepper::SlabStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : system_(system), plan_(plan), options_(options), components_(system.components()) {
  SlabExtent extent = slab_extent(system, plan);
  future_ = extent.above;
  lag_ = extent.field_lag;
  back_ = std::move(extent.behind);
  seed_order_ = std::clamp(options.seed_order, 1, 12) - 1;
  newton_seed_order_ = std::clamp(options.seed_order, 1, 3);
  past_ = std::max(plan.history, std::max(seed_order_, newton_seed_order_) + 1 + extent.below);
  starting_rows_ = std::max(plan.history, 1) + future_;
  const std::size_t row = static_cast<std::size_t>(system.lattice().sites()) * static_cast<std::size_t>(components_);
  ring_ = std::make_unique<SectionRing>(past_ + future_ + 1, row);
  for (int p = 0; p < plan.table.parities; ++p) {
    SlabEquations equations(system, plan, p, past_, future_, options.turn);
    BlockSolver solver = equations.solver();
    std::vector<Unknowns> unknowns = list_unknowns(equations);
    parities_.push_back({std::move(equations), std::move(solver), std::move(unknowns)});
    parities_.back().has_constant = factor_constant(parities_.back());
  }
  seed_.resize(row);
  // Made now, so that memory that is short is told at the start.
  for (std::vector<double>* numbers : {&E_, &known_E_, &change_}) numbers->reserve(unknowns() + 1);
  for (const Parity& p : parities_) jacobian_.reserve(p.equations.places().size());
}

std::size_t SlabStepper::unknowns() const {
  std::size_t most = 0;
  for (const Parity& p : parities_) most = std::max(most, static_cast<std::size_t>(p.equations.size()));
  return most;
}

std::vector<SlabStepper::Unknowns> SlabStepper::list_unknowns(const SlabEquations& equations) const {
  std::vector<Unknowns> lists;
  for (int n = 0; n < equations.size(); ++n) {
    const Node& u = equations.unknown(n);
    const Role role = system_.component(u.component).role;
    auto list = std::ranges::find_if(lists, [&](const Unknowns& l) { return l.time == u.site.time && l.role == role; });
    if (list == lists.end()) list = lists.insert(list, {u.site.time, role, {}, {}});
    list->numbers.push_back(n);
    list->places.push_back(u.site.space * components_ + u.component);
  }
  for (Unknowns& list : lists)
    for (std::vector<int>* numbers : {&list.numbers, &list.places})
      numbers->resize((numbers->size() + lanes - 1) / lanes * lanes, numbers->back());
  // Inner nodes that have no past take the value of their cell's vertex: fields come first.
  std::ranges::stable_partition(lists, &Unknowns::field);
  return lists;
}

/// Where the equations are linear in the slab, or nearly, the matrix that stands for all Jacobians.
bool SlabStepper::factor_constant(Parity& p) {
  bool there = p.equations.constant_jacobian(jacobian_);
  if (there) p.has_values = true, there = p.solver.factor(jacobian_);
  p.factored = there ? Matrix::constant : Matrix::none;
  return there;
}

/// The largest |y| of the fields in a row: starting rows need not hold anything else.
double SlabStepper::largest_of(const double* row) const {
  double largest = 0;
  for (std::size_t at = 0; at < seed_.size(); ++at)
    if (system_.component(static_cast<int>(at) % components_).role == Role::field)
      largest = std::max(largest, std::abs(row[at]));
  return largest;
}

void SlabStepper::start(const std::vector<std::vector<double>>& rows) {
  std::ranges::fill(largest_, 0.0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (std::ranges::any_of(rows[r], [](double x) { return overflowed(std::abs(x)); }))
      throw NotFinite(fmt::format("row {} of the start is not finite", r));
    if (const auto i = crossing(rows[r].data()))
      throw BadInput("initial.file", fmt::format("sites {} and {} of the mesh are not in order in row {}; give rows in "
                                                 "which the positions grow",
                                                 *i, *i + 1, r));
    std::ranges::copy(rows[r], ring_->row(static_cast<std::int64_t>(r)));
    largest_[1] = std::exchange(largest_[0], largest_of(rows[r].data()));
  }
  J_ = static_cast<std::int64_t>(rows.size()) - 1 - future_;
  known_ = 0;
  // Nothing of an earlier run is left: starting again gives the same bits.
  for (Parity& p : parities_)
    if (p.factored == Matrix::jacobian) p.factored = Matrix::none;
  wait_ = 1, waiting_ = 0;
}

void SlabStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  if (plan_.history != 2 || future_ != 0 || lag_ != 0)
    throw BadInput("initial.start", "initial.start = legendre: this scheme is not one slab's map; use exact");
  start({row0});
  solve(1, &momenta);
  J_ = 1;
}

/// The polynomial of degree `most_order`, or as much as there are slabs for, through the values that the last slabs gave.
void SlabStepper::seed(Parity& p, std::int64_t J, int most_order) {
  // What has no equation keeps its value: fixed walls.
  const std::size_t size = seed_.size();
  std::copy_n(ring_->row(J + future_ - 1), size, ring_->row(J + future_));
  for (const Unknowns& unknowns : p.unknowns) {
    // Starting rows hold the fields; multipliers and inner nodes are known from the slabs that were solved.
    const std::int64_t available = unknowns.field() ? J + unknowns.time : known_;
    const int order = static_cast<int>(std::min<std::int64_t>(most_order, available - 1));
    if (order < 0) {
      seed_without_past(unknowns, J);
      continue;
    }
    // Whole rows at once: what else lies in them costs less than to leave it out.
    std::ranges::fill(seed_, 0.0);
    for (int m = 1; m <= order + 1; ++m) {
      const double coefficient = extrapolation_weight(order + 1, m);
      const double* const row = ring_->row(J + unknowns.time - m);
      for (std::size_t at = 0; at < size; ++at) seed_[at] += coefficient * row[at];
    }
    double* const row = ring_->row(J + unknowns.time);
    for (const int place : unknowns.places) row[place] = seed_[static_cast<std::size_t>(place)];
  }
}

/// An inner node: the value of its cell's vertex. A multiplier: zero.
void SlabStepper::seed_without_past(const Unknowns& unknowns, std::int64_t J) {
  double* const row = ring_->row(J + unknowns.time);
  for (const int place : unknowns.places) {
    const int component = place % components_;
    const bool inner = system_.component(component).role == Role::inner;
    row[place] = inner ? row[place - component + component % system_.fields()] : 0.0;
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

/// y −= change
SlabStepper::Change SlabStepper::take_change(const Parity& p, std::int64_t J) {
  // A field that passes through zero has the scale that it had before.
  Change result{.value = std::max(largest_[0], largest_[1])};
  Pack most_change(0.0), most_y(0.0), most_asked(0.0);
  for (const Unknowns& unknowns : p.unknowns) {
    double* const row = ring_->row(J + unknowns.time);
    // Multipliers are not asked: they have no scale of their own, and converge with what they act on.
    const bool asked = unknowns.role != Role::multiplier;
    for (std::size_t i = 0; i < unknowns.places.size(); i += lanes) {
      const Pack by = gather(change_.data(), unknowns.numbers.data() + i);
      const Pack y = gather(row, unknowns.places.data() + i) - by;
      scatter(y, row, unknowns.places.data() + i);
      most_y = largest_magnitude(most_y, y);
      if (asked) most_change = largest_magnitude(most_change, by), most_asked = largest_magnitude(most_asked, y);
    }
  }
  result.finite = !overflowed(max_or_nan(most_y));
  result.change = max_or_nan(most_change);
  result.value = std::max(result.value, max_or_nan(most_asked));
  return result;
}

bool SlabStepper::small(const Change& c) const {
  return c.change <= std::max(options_.tolerance, 4 * std::numeric_limits<double>::epsilon()) * c.value;
}

/// Simplified Newton with the constant part. False where it does not contract, or not fast enough.
bool SlabStepper::iterate(Parity& p, std::int64_t J) {
  if (p.factored != Matrix::constant && !factor_constant(p)) return false;
  seed(p, J, seed_order_);
  p.equations.known(*ring_, J, known_E_);
  double before = std::numeric_limits<double>::infinity();
  while (iterations_ < options_.max_iterations) {
    ++iterations_;
    p.equations.residual_from(known_E_, *ring_, J, E_);
    p.solver.solve(E_, change_);
    const Change c = take_change(p, J);
    if (!c.finite) return false;
    if (small(c)) return true;
    // Changes that no longer shrink are rounding, if they are small.
    if (c.change > 0.25 * before) return c.change <= 512 * std::numeric_limits<double>::epsilon() * c.value;
    before = c.change;
  }
  return false;
}

/// Where the constant part has failed it is tried again after one step, then three, seven and so on up to 63.
bool SlabStepper::may_iterate(const Parity& p) {
  if (!p.has_constant) return false;
  if (waiting_ == 0) return true;
  --waiting_;
  return false;
}

void SlabStepper::newton(Parity& p, std::int64_t J, const std::vector<double>* momenta) {
  seed(p, J, newton_seed_order_);
  if (!momenta) p.equations.known(*ring_, J, known_E_);
  bool fresh = false, refactor = p.factored != Matrix::jacobian || momenta;
  double before = std::numeric_limits<double>::infinity();
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  for (int iteration = 1;; ++iteration) {
    ++iterations_;
    if (iteration > options_.max_iterations) fail(J, "Newton's method does not converge");
    if (refactor) {
      p.equations.jacobian(*ring_, J, jacobian_, momenta);
      p.has_values = true;
      p.factored = p.solver.factor(jacobian_) ? Matrix::jacobian : Matrix::none;
      if (p.factored == Matrix::none) fail(J, "their Jacobian is singular");
      fresh = true;
    }
    if (momenta) p.equations.residual(*ring_, J, E_, nullptr, momenta);
    else p.equations.residual_from(known_E_, *ring_, J, E_);
    p.solver.solve(E_, change_);
    const Change c = take_change(p, J);
    if (!c.finite) {
      p.factored = Matrix::none;
      fail(J, "Newton's method diverges");
    }
    if (small(c)) break;
    const bool slow = c.change > 0.1 * before;
    // Changes that no longer shrink are rounding, if they are small.
    if (slow && c.change > 0.25 * before && c.change <= 512 * epsilon * c.value) break;
    if (slow && fresh && iteration > 8 && c.change > before) fail(J, "Newton's method diverges");
    // Small blocks cost less to factor than an iteration more.
    refactor = slow || p.solver.largest_block() <= 24 || (iteration == 1 && !fresh && c.change > 1e-3 * c.value);
    fresh = fresh && !slow;
    before = c.change;
  }
  if (momenta) p.factored = Matrix::none;
}

void SlabStepper::solve(std::int64_t J, const std::vector<double>* momenta) {
  const FlushDenormals guard;
  Parity& p = parity(J);
  iterations_ = 0;
  if (!momenta && may_iterate(p)) {
    const bool solved = iterate(p, J);
    waiting_ = solved ? 0 : wait_;
    wait_ = solved ? 1 : std::min(2 * wait_ + 1, 63);
    if (!solved) newton(p, J, nullptr);
  } else {
    newton(p, J, momenta);
  }
  if (const auto i = crossing(ring_->row(J - lag_)))
    throw MeshCrossing(fmt::format(
        "step {}, t = {:.6g}: sites {} and {} of the mesh pass each other; reduce lattice.time_step or scheme.alpha", J,
        static_cast<double>(J) * system_.time_step(), *i, *i + 1));
  ++known_;
  largest_[1] = std::exchange(largest_[0], largest_of(ring_->row(J - lag_)));
}

void SlabStepper::step(bool /*looked_at*/) {
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
  for (std::vector<double>* numbers : {&residual_, &absolute_}) numbers->reserve(unknowns() + 1);
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

std::size_t SlabStepper::equation_bytes() const {
  std::size_t total = 0;
  for (const Parity& p : parities_) total += p.equations.bytes();
  return total;
}
std::size_t SlabStepper::matrix_bytes() const {
  std::size_t total = jacobian_.capacity() * sizeof(double);
  for (const Parity& p : parities_) total += p.solver.bytes();
  return total;
}
std::size_t SlabStepper::work_bytes() const {
  std::size_t total = 0;
  const std::vector<double>* const all[] = {&E_, &known_E_, &change_, &seed_, &residual_, &absolute_};
  for (const std::vector<double>* numbers : all)
    total += numbers->capacity() * sizeof(double);
  for (const Parity& p : parities_)
    for (const Unknowns& list : p.unknowns) total += (list.numbers.capacity() + list.places.capacity()) * sizeof(int);
  return total;
}

std::size_t SlabStepper::bytes() const { return ring_->bytes() + equation_bytes() + matrix_bytes() + work_bytes(); }

/// A solver's own copy of the values. Where a block is too large to be dense and does not go by arcs, its sparse LU is
/// not foreseen: how much it fills in is known when it is there.
std::size_t SlabStepper::matrix_bytes_to_come() const {
  std::size_t total = 0;
  for (const Parity& p : parities_)
    if (!p.has_values) total += p.equations.places().size() * sizeof(double);
  return total;
}
std::size_t SlabStepper::residual_bytes_to_come() const {
  return residual_.capacity() > 0 ? 0 : 2 * (unknowns() + 1) * sizeof(double);
}
std::size_t SlabStepper::bytes_to_come(bool residual) const {
  return matrix_bytes_to_come() + (residual ? residual_bytes_to_come() : 0);
}

std::string SlabStepper::memory_report(bool residual) const {
  return fmt::format("rows of the section {} B, stencils {} B, Jacobian and factors {} B, work space {} B",
                     ring_->bytes(), equation_bytes(), matrix_bytes() + matrix_bytes_to_come(),
                     work_bytes() + (residual ? residual_bytes_to_come() : 0));
}

}  // namespace delf
