// SPDX-License-Identifier: MIT
#include "schemes/stepping/slab_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "jets/fibre.hpp"
#include "jets/simd/exact_sum.hpp"
#include "jets/simd/pack_gather.hpp"
#include "schemes/stability/constraint_ghost.hpp"
#include "schemes/stepping/first_slab.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/newton.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/slab_extent.hpp"

namespace delf {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon(), infinity = std::numeric_limits<double>::infinity();
/// Slabs that a polynomial goes through: more are worse than eight.
constexpr int most_points = 8, least_points = 4;

}  // namespace

SlabStepper::SlabStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : system_(system), plan_(plan), options_(options), components_(system.components()), root_(system) {
  SlabExtent extent = slab_extent(system, plan);
  future_ = extent.above;
  lag_ = extent.field_lag;
  back_ = std::move(extent.behind);
  points_ = std::clamp(options.seed_order, 1, most_points);
  past_ = std::max(plan.history, std::max(points_, RootWatch::most_rows) + extent.below);
  // Traces are the state of a row: of first order in time, a scheme goes on from one.
  by_values_ =
      plan.history <= 1 && lag_ == 0 && std::ranges::count(system.all_components(), Role::trace, &Component::role) > 0;
  starting_rows_ = by_values_ ? 1 : std::max(plan.history, 1) + future_;
  const std::size_t row = static_cast<std::size_t>(system.lattice().sites()) * static_cast<std::size_t>(components_);
  ring_ = std::make_unique<SectionRing>(past_ + future_ + 1, row, true);
  for (int p = 0; p < plan.table.parities; ++p) {
    Assembly equations(system, Assembly::slab(plan, p, past_, future_, options.turn));
    BlockSolver solver = solver_of(equations);
    std::vector<Unknowns> unknowns = list_unknowns(equations);
    parities_.push_back({std::move(equations), std::move(solver), std::move(unknowns)});
    const bool follows = parities_.back().equations.keep_low(system);
    parities_.back().momentum_follows = follows && plan.table.parities == 1;
    parities_.back().has_constant = factor_constant(parities_.back());
    if (parities_.back().has_constant) parities_.back().levels = list_levels(parities_.back(), p);
  }
  if (system.moves()) mesh_.emplace(system);
  predicted_.resize(row);
  // Made now, so that memory that is short is told at the start.
  for (std::vector<double>* numbers : {&E_, &known_E_, &change_}) numbers->reserve(unknowns() + 1);
  if (parities_[0].momentum_follows)
    for (std::vector<double>* numbers : {&carried_, &carried_low_, &gain_}) numbers->reserve(unknowns() + 1);
  for (const Parity& p : parities_) jacobian_.reserve(p.equations.places().size());
}

std::size_t SlabStepper::unknowns() const {
  std::size_t most = 0;
  for (const Parity& p : parities_) most = std::max(most, static_cast<std::size_t>(p.equations.size()));
  return most;
}

std::vector<SlabStepper::Unknowns> SlabStepper::list_unknowns(const Assembly& equations) const {
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

std::vector<SlabStepper::Level> SlabStepper::list_levels(const Parity& p, int parity) const {
  constexpr int most_levels = 64;
  const Assembly& all = p.equations;
  const auto n = static_cast<std::size_t>(all.size());
  if (!plan_.nonlinear_in_slab || plan_.blocks != plan_.unknowns || !all.matched() || all.unknowns() != all.size())
    return {};
  // Each unknown is one level above those that its equation contains.
  const std::vector<char> present = all.present();
  std::vector<int> level(n, 0);
  bool changed = true;
  for (int round = 0; changed; ++round) {
    if (round > most_levels) return {};
    changed = false;
    for (std::size_t place = 0; place < present.size(); ++place) {
      const auto [equation, unknown] = all.places()[place];
      if (present[place] == 0 || equation == unknown) continue;
      const int least = level[static_cast<std::size_t>(unknown)] + 1;
      if (int& own = level[static_cast<std::size_t>(equation)]; own < least) own = least, changed = true;
    }
  }
  std::vector<Level> levels;
  for (int l = 0; l <= std::ranges::max(level); ++l) {
    Assembly::Parts parts{.equations = {},
                          .unknowns = {},
                          .matched = true,
                          .parity = parity,
                          .past = past_,
                          .future = future_,
                          .turn = options_.turn};
    for (std::size_t u = 0; u < n; ++u)
      if (level[u] == l)
        parts.equations.push_back(all.equation(static_cast<int>(u))),
            parts.unknowns.push_back(all.unknown(static_cast<int>(u)));
    Assembly equations(system_, std::move(parts));
    BlockSolver solver = solver_of(equations);
    std::vector<double> matrix;
    if (!equations.is_linear() || !equations.constant_jacobian(matrix) || !solver.factor(matrix)) return {};
    std::vector<Unknowns> unknowns = list_unknowns(equations);
    levels.push_back({std::move(equations), std::move(solver), std::move(unknowns)});
  }
  return levels;
}

/// One solve a level, from the predictor. finish() corrects the slab as a whole, by its constant part.
bool SlabStepper::solve_levels(Parity& p, std::int64_t J) {
  ++iterations_;
  left_ = infinity, last_change_ = 0;
  for (const Level& level : p.levels) {
    level.equations.residual(*ring_, J, E_);
    level.solver.solve(E_, change_);
    const Change c = take_change(level.unknowns, J);
    if (!c.finite) return false;
    last_change_ = std::max(last_change_, c.change);
  }
  return true;
}

/// The largest |y| of the fields in a row: starting rows need not hold anything else.
double SlabStepper::largest_of(const double* row) const {
  double largest = 0;
  for (std::size_t at = 0; at < predicted_.size(); ++at)
    if (system_.component(static_cast<int>(at) % components_).role == Role::field)
      largest = std::max(largest, std::abs(row[at]));
  return largest;
}

void SlabStepper::start(const std::vector<std::vector<double>>& rows) {
  std::ranges::fill(largest_, 0.0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (std::ranges::any_of(rows[r], [](double x) { return overflowed(std::abs(x)); }))
      throw NotFinite(fmt::format("row {} of the start is not finite", r));
    if (const auto i = mesh_ ? mesh_->crossing(rows[r].data()) : std::nullopt)
      throw BadInput("initial.file", fmt::format("sites {} and {} of the mesh are not in order in row {}; give rows in "
                                                 "which the positions grow",
                                                 *i, *i + 1, r));
    std::ranges::copy(rows[r], ring_->row(static_cast<std::int64_t>(r)));
    std::fill_n(ring_->low(static_cast<std::int64_t>(r)), rows[r].size(), 0.0);
    largest_[1] = std::exchange(largest_[0], largest_of(rows[r].data()));
  }
  J_ = static_cast<std::int64_t>(rows.size()) - 1 - future_;
  known_ = 0;
  carried_slab_ = -1;
  // Nothing of an earlier run is left: starting again gives the same bits.
  for (Parity& p : parities_) {
    if (p.factored == Matrix::jacobian) p.factored = Matrix::none;
    p.curvature = p.contraction = 0, p.unseen = 0, p.last_iterations = p.fresh_iterations = 0;
  }
  wait_ = 1, waiting_ = 0;
  by_momenta_ = false;
  if (by_values_ && rows.size() == 1) {
    J_ = 0;
    if (solve_slab_of_start(nullptr)) known_ = 1;
  }
}

void SlabStepper::start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) {
  for (const Component& c : system_.all_components())
    if (c.role != Role::field || starting_rows_ != 2) return StepMethod::start_centred(row0, velocity);
  const Window first = system_.window(0, {row0}, options_.turn);
  const NewtonResult result =
      solve_centred_start(system_, plan_, first, velocity, false, options_.tolerance, options_.max_iterations);
  start({row0, result.row});
}

void SlabStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  if (plan_.history > 2 || lag_ != 0)
    throw BadInput("initial.start", "initial.start = legendre: this scheme is not one slab's map; use exact");
  start({row0});
  solve_slab_of_start(&momenta);
  solve(1, &momenta);
  J_ = 1;
  by_momenta_ = true;
}

/// Whether slab 0 finds anything besides row 0 itself.
bool SlabStepper::solve_slab_of_start(const std::vector<double>* momenta) {
  Assembly::Parts parts = first_slab(system_, Assembly::slab(plan_, 0, past_, future_, options_.turn), momenta);
  if (parts.equations.empty()) return false;
  Assembly equations(system_, std::move(parts));
  BlockSolver solver = solver_of(equations);
  std::vector<Unknowns> unknowns = list_unknowns(equations);
  Parity first{std::move(equations), std::move(solver), std::move(unknowns)};
  // newton() begins with the row before, which here is row 0 itself
  std::ranges::copy(std::vector<double>(ring_->row(0), ring_->row(0) + predicted_.size()), ring_->row(-1));
  std::fill_n(ring_->low(-1), predicted_.size(), 0.0);
  iterations_ = 0;
  if (const char* why = newton(first, 0, least_points, momenta)) fail(0, why);
  return true;
}

double SlabStepper::weight_of_past(std::int64_t row, int m, int points) const {
  const RowTimes& times = *system_.times();
  double weight = 1;
  for (int l = 1; l <= points; ++l)
    if (l != m) weight *= (times.time(row) - times.time(row - l)) / (times.time(row - m) - times.time(row - l));
  return weight;
}

/// The polynomial through the values that the last slabs gave, `most_points` of them or as many as there are:
///
///     y_J = Σ_{m=1}^{p} w_m y_{J−m},    w_m = Π_{l≠m} (t_J − t_{J−l})/(t_{J−m} − t_{J−l}),
///
/// and (−1)^{m+1} C(p, m) where rows are as far apart.
void SlabStepper::predict(const Parity& p, std::int64_t J, int most) {
  // What has no equation keeps its value: fixed walls.
  const std::size_t size = predicted_.size();
  std::copy_n(ring_->row(J + future_ - 1), size, ring_->row(J + future_));
  std::copy_n(ring_->low(J + future_ - 1), size, ring_->low(J + future_));
  for (const Unknowns& unknowns : p.unknowns) {
    for (const int place : unknowns.places) ring_->low(J + unknowns.time)[place] = 0;
    // Starting rows hold the fields; multipliers and inner nodes are known from the slabs that were solved.
    const std::int64_t available = unknowns.field() ? J + unknowns.time : known_;
    const int points = static_cast<int>(std::min<std::int64_t>(most, available));
    if (points < 1) {
      predict_without_past(unknowns, J);
      continue;
    }
    // Whole rows at once: what else lies in them costs less than to leave it out.
    const SectionView rows = ring_->view();
    const int newest_row = rows.index(J + unknowns.time);
    double weight = points;
    const bool uniform = system_.times()->uniform();
    if (!uniform) weight = weight_of_past(J + unknowns.time, 1, points);
    const double* past = rows.beside(newest_row, -1);
    for (std::size_t at = 0; at < size; ++at) predicted_[at] = weight * past[at];
    for (int m = 2; m <= points; ++m) {
      weight = uniform ? weight * -static_cast<double>(points - m + 1) / m
                       : weight_of_past(J + unknowns.time, m, points);
      past = rows.beside(newest_row, -m);
      for (std::size_t at = 0; at < size; ++at) predicted_[at] += weight * past[at];
    }
    double* const row = ring_->row(J + unknowns.time);
    for (const int place : unknowns.places) row[place] = predicted_[static_cast<std::size_t>(place)];
  }
}

/// An inner node or a trace: the value of its cell's vertex. What is slaved: its last value, or in the row of the start what
/// that gave. A multiplier: zero.
void SlabStepper::predict_without_past(const Unknowns& unknowns, std::int64_t J) {
  double* const row = ring_->row(J + unknowns.time);
  for (const int place : unknowns.places) {
    const int component = place % components_;
    const Component& c = system_.component(component);
    if (c.role == Role::inner || c.role == Role::trace)
      row[place] = row[place - component + system_.field_component(c.field)];
    else if (c.role == Role::slaved) {
      if (J + unknowns.time > 0) row[place] = ring_->row(J + unknowns.time - 1)[place];
    } else row[place] = 0.0;
  }
}

void SlabStepper::fail(std::int64_t J, const std::string& why, std::string remedy) const {
  if (remedy.empty()) remedy = remedy_for(options_.max_iterations);
  if (const auto ghost = ghost_under_constraint(system_))
    remedy = fmt::format("{}; {}", in_words_under_constraint(*ghost), without_ghost_under_constraint);
  if (mesh_ && J > 0)
    remedy = fmt::format("in the row before, {}; reduce lattice.time_step or mesh.alpha, or raise lattice.sites",
                         mesh_->narrowest_cell(ring_->row(J - 1 - lag_)));
  throw NoConvergence(fmt::format("step {}, t = {:.6g}: the equations of the slab were not solved: {}; {}", J,
                                  system_.times()->time(J), why, remedy));
}

/// y −= change
SlabStepper::Change SlabStepper::take_change(const std::vector<Unknowns>& lists, std::int64_t J) {
  // A field that passes through zero has the scale that it had before.
  Change result{.value = std::max(largest_[0], largest_[1])};
  Pack most_change(0.0), most_y(0.0), most_asked(0.0);
  for (const Unknowns& unknowns : lists) {
    double *const row = ring_->row(J + unknowns.time), *const low = ring_->low(J + unknowns.time);
    // Multipliers are not asked: they have no scale of their own, and converge with what they act on.
    const bool asked = unknowns.role != Role::multiplier;
    for (std::size_t i = 0; i < unknowns.places.size(); i += lanes) {
      const Pack by = gather(change_.data(), unknowns.numbers.data() + i);
      Pack y = gather(row, unknowns.places.data() + i), rest = gather(low, unknowns.places.data() + i);
      add_exactly(y, rest, -by);
      scatter(y, row, unknowns.places.data() + i), scatter(rest, low, unknowns.places.data() + i);
      most_y = largest_magnitude(most_y, y);
      if (asked) most_change = largest_magnitude(most_change, by), most_asked = largest_magnitude(most_asked, y);
    }
  }
  result.finite = !overflowed(max_or_nan(most_y));
  result.change = max_or_nan(most_change);
  result.value = std::max(result.value, max_or_nan(most_asked));
  travelled_ += result.change, value_ = result.value;
  return result;
}

double SlabStepper::wanted(const Change& c) const { return options_.tolerance * c.value; }

/// With one matrix for all iterations corrections shrink by a ratio ρ: what is left after this one is ρ/(1 − ρ) of it.
/// Where finish() follows it looks once more: of linear equations one solve is enough for it, and of others a tenth of what is
/// wanted, by the ratio of the last slab.
bool SlabStepper::arrived(const Parity& p, const Change& c, double before) {
  const double ratio = c.change / before;
  left_ = before == infinity || ratio >= 0.5 ? infinity : ratio / (1 - ratio) * c.change;
  if (!plan_.nonlinear_in_slab && p.factored == Matrix::constant) left_ = 1e3 * epsilon * c.change;
  if (c.change <= wanted(c)) return true;
  if (before == infinity && p.momentum_follows && p.factored == Matrix::constant)
    return !plan_.nonlinear_in_slab || (p.contraction > 0 && 10 * p.contraction * c.change <= wanted(c));
  if (before == infinity || (options_.tolerance < smallest_estimated && !p.momentum_follows)) return false;
  return ratio < 0.5 && 2 * ratio / (1 - ratio) * c.change <= wanted(c);
}
/// Corrections that no longer shrink are rounding, if they are small.
bool SlabStepper::is_rounding(const Change& c, double before) {
  return c.change > 0.25 * before && c.change <= 512 * epsilon * c.value;
}

/// Simplified Newton with the constant part. False where it does not contract, or not fast enough.
bool SlabStepper::iterate(Parity& p, std::int64_t J) {
  if (p.factored != Matrix::constant && !factor_constant(p)) return false;
  predict(p, J, points_);
  find_known(p, J, nullptr);
  travelled_ = 0;
  if (!p.levels.empty()) return solve_levels(p, J);
  double before = infinity;
  while (iterations_ < options_.max_iterations) {
    ++iterations_;
    p.equations.residual_from(known_E_, *ring_, J, E_);
    p.solver.solve(E_, change_);
    const Change c = take_change(p.unknowns, J);
    last_change_ = c.change;
    if (!c.finite) return false;
    if (arrived(p, c, before)) return true;
    if (c.change > 0.25 * before) return is_rounding(c, before);
    before = c.change;
  }
  return false;
}

/// Where the constant part has failed it is tried again after one step, then three, seven and so on up to 63.
bool SlabStepper::may_iterate(const Parity& p) {
  if (!p.has_constant || !system_.times()->uniform()) return false;
  if (waiting_ == 0) return true;
  --waiting_;
  return false;
}

/// Newton's method from a polynomial through so many slabs, or from the values that are there if none. Why it failed, or nothing.
const char* SlabStepper::newton(Parity& p, std::int64_t J, int points, const std::vector<double>* momenta) {
  if (points > 0) predict(p, J, points);
  find_known(p, J, momenta);
  // Small blocks cost less to factor than an iteration more, and a fresh Jacobian leaves no bias behind.
  const bool always = p.solver.largest_block() <= 24;
  // One that was kept and has become slow is not kept any longer.
  bool refactor = always || momenta || p.factored != Matrix::jacobian || p.last_iterations > p.fresh_iterations + 1;
  bool fresh = false;
  double before = infinity;
  steepest_ = travelled_ = 0;
  for (int iteration = 1;; ++iteration) {
    ++iterations_;
    if (iteration > options_.max_iterations) return "Newton's method does not converge";
    if (refactor) {
      p.equations.jacobian(*ring_, J, jacobian_, momenta);
      p.has_values = true;
      p.factored = p.solver.factor(jacobian_) ? Matrix::jacobian : Matrix::none;
      if (p.factored == Matrix::none) return "their Jacobian is singular";
      fresh = true;
    }
    if (momenta) p.equations.residual(*ring_, J, E_, nullptr, momenta);
    else p.equations.residual_from(known_E_, *ring_, J, E_);
    p.solver.solve(E_, change_);
    const Change c = take_change(p.unknowns, J);
    if (!c.finite) {
      p.factored = Matrix::none;
      return "Newton's method diverges";
    }
    last_change_ = c.change;
    // Far from the polynomial another root may be nearer.
    if (iteration == 1 && points > least_points && c.change > 1e-2 * c.value) return "the predictor is far away";
    if (iteration > 1 && c.change > 64 * epsilon * c.value) steepest_ = std::max(steepest_, c.change / before);
    p.last_iterations = iteration;
    if (fresh) p.fresh_iterations = iteration;
    if (always && iteration > 1) {
      // With a fresh matrix what is left is C correction².
      p.curvature = std::max(c.change / (before * before), 0.5 * p.curvature), p.unseen = 0;
    } else {
      ++p.unseen;
    }
    const bool seen =
        always && (iteration > 1 || p.unseen < 8) && p.curvature > 0 &&
        (options_.tolerance >= smallest_estimated || p.momentum_follows);
    left_ = p.curvature > 0 ? p.curvature * c.change * c.change : infinity;
    if (seen && 4 * p.curvature * c.change * c.change <= wanted(c)) break;
    if (always ? c.change <= wanted(c) : arrived(p, c, before)) break;
    if (is_rounding(c, before)) break;
    const bool slow = c.change > 0.1 * before;
    if (slow && fresh && iteration > 8 && c.change > before) return "Newton's method diverges";
    refactor = always || slow || (iteration == 1 && !fresh && c.change > 1e-3 * c.value);
    before = c.change;
  }
  return nullptr;
}

/// The part of the equations that the slab does not change, computed once and then carried from slab to slab.
void SlabStepper::find_known(const Parity& p, std::int64_t J, const std::vector<double>* momenta) {
  if (!p.momentum_follows || carried_slab_ != J) {
    p.equations.known(*ring_, J, known_E_, momenta);
    if (!p.momentum_follows) return;
    carried_ = known_E_;
    carried_low_.assign(carried_.size(), 0.0);
    carried_slab_ = J;
  } else {
    known_E_ = carried_;
  }
}

/// A last correction with the matrix that is there, and what the slab adds to the known part of the next, from one evaluation:
/// it takes the place of that of known() in the next step. False if the iteration had not arrived, and does not now.
bool SlabStepper::finish(Parity& p, std::int64_t J) {
  if (!p.momentum_follows) return true;
  for (;; ++iterations_) {
    p.equations.residual_and_gain(known_E_, *ring_, J, E_, gain_);
    // What is below rounding of the increment is not worth a solve.
    if (p.factored == Matrix::none || left_ <= 1e-4 * epsilon * largest_[0]) return true;
    p.solver.solve(E_, change_);
    const Change c = take_change(p.unknowns, J);
    if (!c.finite) return false;
    if (p.factored == Matrix::constant && last_change_ > 0)
      p.contraction = std::max(c.change / last_change_, 0.5 * p.contraction);
    if (c.change <= wanted(c) || is_rounding(c, last_change_)) return true;
    if (c.change > 0.25 * last_change_ || iterations_ >= options_.max_iterations) return false;
    last_change_ = c.change;
  }
}

const char* SlabStepper::newton_and_finish(Parity& p, std::int64_t J, int points, const std::vector<double>* momenta) {
  if (const char* failed = newton(p, J, points, momenta)) return failed;
  return finish(p, J) ? nullptr : "Newton's method does not converge";
}

void SlabStepper::carry(const Parity& p, std::int64_t J) {
  if (!p.momentum_follows) return;
  for (std::size_t n = 0; n + 1 < gain_.size(); ++n) add_exactly(carried_[n], carried_low_[n], gain_[n]);
  carried_slab_ = J + 1;
}

/// Newton's method has no doubt where it has gone straight to the unknowns.
RootWatch::Verdict SlabStepper::judge(const Parity& p, std::int64_t J) const {
  // Corrections that shrink by four and more at once leave no other root near (Kantorovich).
  constexpr double little = 1e-3, straight = 0.25;
  if (!plan_.nonlinear_in_slab || !p.levels.empty() || travelled_ <= little * value_) return RootWatch::Verdict::near;
  std::vector<RootWatch::Values> lists;
  for (const Unknowns& list : p.unknowns) {
    if (list.role == Role::multiplier || list.role == Role::slaved) continue;
    const std::int64_t rows = std::min<std::int64_t>(list.field() ? J + list.time : known_, past_ + list.time);
    lists.push_back({J + list.time, static_cast<int>(std::min<std::int64_t>(rows, RootWatch::most_rows)), list.places});
  }
  const RootWatch::Verdict verdict = root_.judge(*ring_, lists);
  return verdict == RootWatch::Verdict::doubtful && steepest_ <= straight ? RootWatch::Verdict::near : verdict;
}

std::vector<double> SlabStepper::values_of(const Parity& p, std::int64_t J) const {
  std::vector<double> values;
  for (int n = 0; n < p.equations.size(); ++n) values.push_back(p.equations.value(*ring_, J, n));
  return values;
}
SlabPast SlabStepper::past_of(std::int64_t J) const {
  return {*ring_, J, known_, past_, future_, options_.turn, known_E_};
}

/// The root that a small step leads to, where Newton's method has found none or another: `why`. One that was only doubtful is
/// taken where that cannot be told, because not even a small step begins.
void SlabStepper::follow(Parity& p, std::int64_t J, const std::vector<double>* momenta, const char* why,
                         const std::vector<double>& doubtful) {
  predict(p, J, 1);
  find_known(p, J, momenta);
  const NewtonResult followed =
      follow_slab(system_, plan_, past_of(J), options_.tolerance, options_.max_iterations);
  iterations_ += followed.iterations;
  const bool is_doubtful = !followed.converged && followed.reached == 0 && !doubtful.empty();
  if (!followed.converged && !is_doubtful) {
    const bool begins = followed.reached > 0 && options_.max_iterations >= enough_iterations;
    fail(J, begins ? fmt::format("{}; the one that a small step leads to ends at {:.2g} of this step", why, followed.reached)
                   : fmt::format("{}, and none that a small step leads to", why),
         begins ? fmt::format("reduce lattice.time_step below {:.2g}", followed.reached * system_.times()->step(J - 1)) : "");
  }
  for (int n = 0; n < p.equations.size(); ++n)
    p.equations.value(*ring_, J, n) = (is_doubtful ? doubtful : followed.row)[static_cast<std::size_t>(n)];
  if (const char* failed = newton_and_finish(p, J, 0, momenta)) fail(J, failed);
  if (!is_doubtful) continued_ = Continued::far;
}

void SlabStepper::solve(std::int64_t J, const std::vector<double>* momenta) {
  const FlushDenormals guard;
  Parity& p = parity(J);
  iterations_ = 0;
  continued_ = Continued::no;
  steepest_ = 0;
  bool solved = false;
  if (!momenta && may_iterate(p)) {
    solved = iterate(p, J) && finish(p, J);
    waiting_ = solved ? 0 : wait_;
    wait_ = solved ? 1 : std::min(2 * wait_ + 1, 63);
  }
  std::string crossed = solved && mesh_ ? mesh_->crossing_at(*ring_, J - lag_) : "";
  if (!solved || !crossed.empty() || judge(p, J) != RootWatch::Verdict::near) {
    const char* why = nullptr;
    std::vector<double> doubtful;
    bool found = false, other = false;
    // Rough sections are predicted better by a few slabs, and a tangled mesh, or a root that has left the motion, is one
    // that another predictor may avoid. What is extrapolated may lie where the density is not defined.
    std::vector<int> tried{points_};
    if (points_ > least_points) tried.push_back(least_points);
    if (points_ > 1) tried.push_back(1);
    for (const int points : tried) {
      if (const char* failed = newton_and_finish(p, J, points, momenta)) {
        why = failed;
        continue;
      }
      const std::string tangled = mesh_ ? mesh_->crossing_at(*ring_, J - lag_) : "";
      if (crossed.empty()) crossed = tangled;
      if (!tangled.empty()) continue;
      RootWatch::Verdict verdict = judge(p, J);
      // No row tells where a first step goes.
      if (J == 1 && verdict == RootWatch::Verdict::near && plan_.nonlinear_in_slab && travelled_ > 0) {
        find_known(p, J, momenta);
        if (turns_back(system_, plan_, past_of(J), values_of(p, J), options_.tolerance)) verdict = RootWatch::Verdict::far;
      }
      const bool leaps = mesh_ && points != points_ && J >= 2 && mesh_->leaps(*ring_, J - lag_);
      found = verdict == RootWatch::Verdict::near && !leaps;
      if (found) break;
      doubtful = verdict == RootWatch::Verdict::doubtful ? values_of(p, J) : std::vector<double>();
      other = other || !leaps;
      why = "Newton's method finds no root but one that leaves the motion of the rows before";
    }
    if (found) crossed.clear();
    // Where no predictor leads to any root the scheme is unstable, or has none: to follow one there would hide it.
    else if (crossed.empty() && !other) fail(J, why);
    else if (crossed.empty()) follow(p, J, momenta, why, doubtful);
  }
  if (!crossed.empty())
    throw MeshCrossing(
        fmt::format("step {}, t = {:.6g}: {}; in the row before, {}; reduce lattice.time_step or mesh.alpha", J,
                    system_.times()->time(J), crossed, mesh_->narrowest_cell(ring_->row(J - 1 - lag_))));
  carry(p, J);
  if (momenta) p.factored = Matrix::none;
  if (options_.fibre == Fibre::circle) check_increments(J);
  ++known_;
  largest_[1] = std::exchange(largest_[0], largest_of(ring_->row(J - lag_)));
}

/// On S¹ the values of an element follow each other, from its lower vertex by the nodes inside to its upper one: none may
/// be so far from the last that it could be its complement.
void SlabStepper::check_increments(std::int64_t J) const {
  const double *const lower = ring_->row(J - 1), *const upper = ring_->row(J);
  for (int c = 0; c < components_; ++c) {
    const double next = c + 1 < components_ ? lower[c + 1] : upper[0];
    if (!(std::abs(next - lower[c]) <= largest_wrapped_difference))
      throw NotFinite(
          fmt::format("step {}, t = {:.6g}: on the fibre S1 an increment within an element is above 0.9 pi, "
                      "where it cannot be told from its complement; reduce lattice.time_step, or use "
                      "theory.fibre = R",
                      J, system_.times()->time(J)));
  }
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
  Window window = system_.window(newest() - rows + 1, std::move(newest_rows), options_.turn);
  for (std::int64_t r = newest() - rows + 1; r <= newest(); ++r)
    window.low.emplace_back(ring_->low(r), ring_->low(r) + size);
  return window;
}

double SlabStepper::residual() const {
  if (known_ == 0 || J_ == 0) return 0;  // of row 0 there are no equations
  const Parity& p = parity(J_);
  // After a Legendre start slab 1 has no stencils below row 0.
  if (J_ == 1 && by_momenta_) return 0;
  for (std::vector<double>* numbers : {&residual_, &absolute_}) numbers->reserve(unknowns() + 1);
  p.equations.residual(*ring_, J_, residual_, &absolute_);
  // The equation of a multiplier is a constraint, whose terms cancel within one stencil: it is measured on its own.
  double worst = 0, size = 0;
  for (int n = 0; n < p.equations.size(); ++n) {
    if (system_.component(p.equations.equation(n).component).role == Role::multiplier) continue;
    worst = larger_or_nan(std::abs(residual_[static_cast<std::size_t>(n)]), worst);
    size = larger_or_nan(absolute_[static_cast<std::size_t>(n)], size);
  }
  // Terms may cancel within a stencil, as those of a body that turns back do: then what the row before would leave says how
  // large they are.
  if (worst > 1e-6 * size) {
    std::vector<double> values;
    for (int n = 0; n < p.equations.size(); ++n) {
      double& y = p.equations.value(*ring_, J_, n);
      values.push_back(y);
      y = p.equations.value(*ring_, J_ - 1, n);
    }
    p.equations.residual(*ring_, J_, residual_, &absolute_);
    for (int n = 0; n < p.equations.size(); ++n) {
      p.equations.value(*ring_, J_, n) = values[static_cast<std::size_t>(n)];
      if (system_.component(p.equations.equation(n).component).role != Role::multiplier)
        size = std::max(size, absolute_[static_cast<std::size_t>(n)]);
    }
  }
  return size == 0 ? 0 : worst / size;
}

/// A Jacobian whose factors are kept is saved as its values, and factored again.
void SlabStepper::visit(SavedState& state) {
  state.numbers("section", ring_->row(0), ring_->bytes() / sizeof(double));  // from the beginning of the ring
  state("known part", carried_), state("low part of it", carried_low_), state("slab of it", carried_slab_);
  state("newest slab", J_), state("slabs known", known_), state("by momenta", by_momenta_);
  state("iterations", iterations_), state("continued", continued_), state("largest", largest_);
  state("steps to wait", wait_), state("steps left to wait", waiting_);
  for (Parity& p : parities_) {
    Matrix factored = p.factored;
    state("factored", factored);
    std::vector<double> values;
    if (factored == Matrix::jacobian) values = p.solver.values();
    state("Jacobian", values);
    state("iterations of the last slab", p.last_iterations);
    state("iterations with a new Jacobian", p.fresh_iterations);
    state("curvature", p.curvature), state("iterations unseen", p.unseen), state("contraction", p.contraction);
    if (!state.restores()) continue;
    if (factored == Matrix::jacobian) p.has_values = true, p.solver.factor(values), p.factored = factored;
    else if (factored == Matrix::none) p.factored = factored;
    else if (p.factored != Matrix::constant) factor_constant(p);
  }
}

std::size_t SlabStepper::equation_bytes() const {
  std::size_t total = 0;
  for (const Parity& p : parities_) {
    total += p.equations.bytes();
    for (const Level& level : p.levels) total += level.equations.bytes() + level.solver.bytes();
  }
  return total;
}
std::size_t SlabStepper::matrix_bytes() const {
  std::size_t total = jacobian_.capacity() * sizeof(double);
  for (const Parity& p : parities_) total += p.solver.bytes();
  return total;
}
std::size_t SlabStepper::work_bytes() const {
  std::size_t total = 0;
  const std::vector<double>* const all[] = {&E_,        &known_E_, &gain_,     &change_,      &predicted_,
                                            &residual_, &absolute_, &carried_, &carried_low_};
  for (const std::vector<double>* numbers : all) total += numbers->capacity() * sizeof(double);
  for (const Parity& p : parities_)
    for (const Unknowns& list : p.unknowns) total += (list.numbers.capacity() + list.places.capacity()) * sizeof(int);
  return total;
}

/// A solver's own copy of the values. Where a block is too large to be dense and is no band, its sparse LU is
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
StepReport SlabStepper::report(bool residual) const {
  const std::size_t residual_bytes = residual ? residual_bytes_to_come() : 0;
  return {.starting_rows = starting_rows_,
          .behind = back_,
          .iterates = plan_.nonlinear_in_slab && !by_levels(),
          .solver = parities_[0].solver.name(),
          .bytes = ring_->bytes() + equation_bytes() + matrix_bytes() + work_bytes(),
          .bytes_to_come = matrix_bytes_to_come() + residual_bytes,
          .memory = fmt::format("rows of the section {} B, stencils {} B, Jacobian and factors {} B, work space {} B",
                                ring_->bytes(), equation_bytes(), matrix_bytes() + matrix_bytes_to_come(),
                                work_bytes() + residual_bytes)};
}

}  // namespace delf
