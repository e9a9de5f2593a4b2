// SPDX-License-Identifier: MIT
#include "schemes/stepping/slab_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "jets/fibre.hpp"
#include "jets/simd/exact_sum.hpp"
#include "jets/simd/pack_gather.hpp"
#include "lattice/index.hpp"
#include "schemes/stability/constraint_ghost.hpp"
#include "schemes/stepping/first_slab.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/gauge.hpp"
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
    : system_(system),
      driven_(system),
      plan_(with_gauge(system, plan)),
      options_(options),
      components_(system.components()),
      root_(system) {
  SlabExtent extent = slab_extent(system, plan_);
  future_ = extent.above;
  delay_ = extent.field_lag;
  back_ = std::move(extent.behind);
  points_ = std::clamp(options.predictor_order, 1, most_points);
  past_ = std::max(plan.history, std::max(points_, RootWatch::most_rows) + extent.below);
  // Traces are the state of a row: of first order in time, a scheme goes on from one.
  by_values_ = plan.history <= 1 && delay_ == 0 &&
               std::ranges::count(system.all_components(), Role::trace, &Component::role) > 0;
  starting_rows_ = by_values_ ? 1 : std::max(plan.history, 1) + future_;
  const std::size_t row = delf::at(system.lattice().sites()) * delf::at(components_);
  ring_ = std::make_unique<SectionRing>(past_ + future_ + 1, row, true);
  for (int p = 0; p < plan.table.parities; ++p) {
    parities_.push_back(parity_of(Assembly(system, Assembly::slab(plan_, p, past_, future_, options.monodromy))));
    const bool follows = parities_.back().equations.keep_low(system);
    parities_.back().momentum_follows = follows && plan.table.parities == 1;
    parities_.back().has_constant = factor_constant(parities_.back());
    if (parities_.back().has_constant) parities_.back().levels = list_levels(parities_.back(), p);
  }
  if (system.moves()) mesh_.emplace(system);
  predicted_.resize(row);
  for (int points : {points_, least_points, 1})
    if (predictors_.empty() || points < predictors_.back()) predictors_.push_back(points);
  // Made now, so that memory that is short is reported at the start.
  for (std::vector<double>* numbers : {&E_, &known_E_, &change_}) numbers->reserve(unknowns() + 1);
  if (parities_[0].momentum_follows)
    for (std::vector<double>* numbers : {&carried_, &carried_low_, &gain_}) numbers->reserve(unknowns() + 1);
  for (const Parity& p : parities_) jacobian_.reserve(p.equations.places().size());
}

std::size_t SlabStepper::unknowns() const {
  std::size_t most = 0;
  for (const Parity& p : parities_) most = std::max(most, delf::at(p.equations.size()));
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
  // Inner nodes that have no past take the value of their cell's vertex: fields come first.
  std::ranges::stable_partition(lists, &Unknowns::field);
  return lists;
}

SlabStepper::Parity SlabStepper::parity_of(Assembly equations) const {
  BlockSolver solver = solver_of(equations);
  std::vector<Unknowns> unknowns = list_unknowns(equations);
  std::vector<RootWatch::Values> watched;
  for (const Unknowns& list : unknowns)
    if (list.role != Role::multiplier && list.role != Role::slaved)
      watched.push_back({list.time, past_ + list.time, list.field(), list.places});
  return {std::move(equations), std::move(solver), std::move(unknowns), std::move(watched)};
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
  const std::size_t n = all.size();
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
      const int least = level[unknown] + 1;
      if (int& own = level[equation]; own < least) own = least, changed = true;
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
                          .monodromy = options_.monodromy};
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
Stop SlabStepper::solve_levels(Parity& p, std::int64_t J) {
  at_ = {};
  ++at_.iteration, ++iterations_;
  if (p.factored != Matrix::constant && !factor_constant(p)) return Stop::singular;
  for (const Level& level : p.levels) {
    level.equations.residual(*ring_, J, E_);
    level.solver.solve(E_, change_);
    take_change(level.unknowns, J, at_);
    if (!at_.finite) return Stop::diverges;
  }
  at_.left = NewtonProgress::unknown;
  return finish(p, J, Stop::converged);
}

/// The largest |y| of the fields in a row: starting rows need not hold anything else.
double SlabStepper::largest_of(const double* row) const {
  double largest = 0;
  for (int c = 0; c < components_; ++c)
    for (std::size_t at = delf::at(c); system_.component(c).role == Role::field && at < predicted_.size();
         at += delf::at(components_))
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
    driven_.put_into(static_cast<std::int64_t>(r), {ring_->row(static_cast<std::int64_t>(r)), rows[r].size()});
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
  for (const Component& c : system_.all_components()) {
    if (c.role == Role::multiplier && system_.lattice().space() == Space::point)
      throw BadInput("initial.start",
                     "initial.start = centred: not with a constraint; use scheme.method = cgvi with scheme.tableau = "
                     "stormer-verlet, which starts from rates, or give a solution as exact.FIELD");
    if (c.role == Role::multiplier)
      throw BadInput("initial.start",
                     "initial.start = centred: not with a constraint on a lattice; give a solution as exact.FIELD");
    if (c.role != Role::field || starting_rows_ != 2) return StepMethod::start_centred(row0, velocity);
  }
  std::vector<double> driven = row0;
  driven_.put_into(0, driven);
  const Window first = system_.window(0, {driven}, options_.monodromy);
  const NewtonResult result =
      solve_centred_start(system_, plan_, first, velocity, false, options_.tolerance, options_.max_iterations);
  start({driven, result.row});
}

void SlabStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  if (plan_.history > 2 || delay_ != 0)
    throw BadInput("initial.start", "initial.start = legendre: this scheme is not one slab's map; use exact");
  start({row0});
  solve_slab_of_start(&momenta);
  solve(1, &momenta);
  J_ = 1;
  by_momenta_ = true;
}

/// Whether slab 0 finds anything besides row 0 itself.
bool SlabStepper::solve_slab_of_start(const std::vector<double>* momenta) {
  Assembly::Parts parts = first_slab(system_, Assembly::slab(plan_, 0, past_, future_, options_.monodromy), momenta);
  if (parts.equations.empty()) return false;
  Parity first = parity_of(Assembly(system_, std::move(parts)));
  // newton() begins with the row before, which here is row 0 itself
  std::ranges::copy(std::vector<double>(ring_->row(0), ring_->row(0) + predicted_.size()), ring_->row(-1));
  std::fill_n(ring_->low(-1), predicted_.size(), 0.0);
  iterations_ = 0;
  Stop stop = newton(first, 0, least_points, momenta);
  std::string crossed;
  if (has_root(stop)) stop = watch(first, 0, least_points, momenta, crossed);
  if (stop == Stop::doubtful_root) follow(first, 0, momenta, stop, values_of(first, 0));
  else if (stop == Stop::other_root) follow(first, 0, momenta, stop, {});
  else if (!has_root(stop)) fail(0, in_words(stop));
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
  for (std::int64_t row = std::max<std::int64_t>(J - 1, 0); row <= J + future_; ++row)
    driven_.put_into(row, {ring_->row(row), size});
  std::pair<int, int> made{0, 0};  // what predicted_ has: points, and the time of its row
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
    const bool uniform = system_.times()->uniform();
    double weight = -1;
    for (int m = 1; m <= points && made != std::pair{points, unknowns.time}; ++m) {
      weight =
          uniform ? weight * -static_cast<double>(points - m + 1) / m : weight_of_past(J + unknowns.time, m, points);
      const double* const past = rows.beside(newest_row, -m);
      if (m == 1) std::ranges::fill(predicted_, 0.0);
      for (std::size_t at = 0; at < size; ++at) predicted_[at] += weight * past[at];
    }
    made = {points, unknowns.time};
    double* const row = ring_->row(J + unknowns.time);
    for (const int place : unknowns.places) row[place] = predicted_[place];
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
                         mesh_->narrowest_cell(ring_->row(J - 1 - delay_)));
  throw NoConvergence(fmt::format("step {}, t = {:.6g}: the equations of the slab were not solved: {}; {}", J,
                                  system_.times()->time(J), why, remedy));
}

/// y −= change
void SlabStepper::take_change(const std::vector<Unknowns>& lists, std::int64_t J, NewtonProgress& at) {
  Pack changes(0.0), values(0.0), asked_values(0.0);
  double most_change = 0, most_y = 0, most_asked = 0;
  for (const Unknowns& unknowns : lists) {
    double *const row = ring_->row(J + unknowns.time), *const low = ring_->low(J + unknowns.time);
    // Multipliers are not asked: they have no scale of their own, and converge with what they act on.
    const bool asked = unknowns.role != Role::multiplier;
    const std::size_t size = unknowns.places.size(), whole = size / lanes * lanes;
    for (std::size_t i = 0; i < whole; i += lanes) {
      const Pack by = gather(change_.data(), unknowns.numbers.data() + i);
      Pack y = gather(row, unknowns.places.data() + i), rest = gather(low, unknowns.places.data() + i);
      add_exactly(y, rest, -by);
      scatter(y, row, unknowns.places.data() + i), scatter(rest, low, unknowns.places.data() + i);
      values = largest_magnitude(values, y);
      if (asked) changes = largest_magnitude(changes, by), asked_values = largest_magnitude(asked_values, y);
    }
    for (std::size_t i = whole; i < size; ++i) {  // all of mechanics
      const int place = unknowns.places[i];
      const double by = change_[unknowns.numbers[i]];
      add_exactly(row[place], low[place], -by);
      most_y = larger_or_nan(std::abs(row[place]), most_y);
      if (!asked) continue;
      most_change = larger_or_nan(std::abs(by), most_change);
      most_asked = larger_or_nan(std::abs(row[place]), most_asked);
    }
  }
  most_y = larger_or_nan(max_or_nan(values), most_y);
  most_change = larger_or_nan(max_or_nan(changes), most_change);
  most_asked = larger_or_nan(max_or_nan(asked_values), most_asked);
  at.finite = !overflowed(most_y);
  // A field that passes through zero has the scale that it had before.
  at.take(most_change, std::max({largest_[0], largest_[1], most_asked}));
}

/// The equations of a slab as Newton's method takes them, at the values in the section, with the matrix that the solver has.
struct SlabStepper::Iteration {
  SlabStepper& own;
  Parity& p;
  std::int64_t J;
  bool estimates = true;  ///< what is left after a correction

  bool linearise(const NewtonProgress&) { return true; }
  const std::vector<double>& residual() {
    p.equations.residual_from(own.known_E_, *own.ring_, J, own.E_);
    return own.E_;
  }
  const std::vector<double>& solve(const std::vector<double>& E) {
    p.solver.solve(E, own.change_);
    return own.change_;
  }
  /// With one matrix for all iterations corrections shrink by a ratio ρ: what is left after this one is ρ/(1 − ρ) of it.
  void apply(const std::vector<double>&, NewtonProgress& at) {
    own.take_change(p.unknowns, J, at);
    const double ratio = at.ratio();
    at.left = estimates && at.iteration > 1 && ratio < 0.5 ? 2 * ratio / (1 - ratio) * at.correction
                                                           : NewtonProgress::unknown;
  }
};
/// The constant part of the Jacobian. What finish() corrects once more need not have arrived: a tenth of what is wanted is
/// enough for it, by the ratio of the last slab.
struct SlabStepper::WithConstant : Iteration {
  bool linearise(const NewtonProgress&) { return p.factored == Matrix::constant || own.factor_constant(p); }
  void apply(const std::vector<double>& change, NewtonProgress& at) {
    Iteration::apply(change, at);
    if (at.iteration == 1 && p.momentum_follows && p.contraction > 0) at.left = 10 * p.contraction * at.correction;
    if (!own.plan_.nonlinear_in_slab) at.left = 1e3 * epsilon * at.correction;
  }
};
/// The Jacobian, made anew for each correction or where the last one has become slow.
struct SlabStepper::WithJacobian : Iteration {
  const std::vector<double>* momenta;
  /// Small blocks cost less to factor than an iteration more, and a fresh Jacobian leaves no bias behind.
  bool always = p.solver.largest_block() <= 24;
  /// One that was kept and has become slow is not kept any longer.
  bool refactor = always || momenta || p.factored != Matrix::jacobian || p.last_iterations > p.fresh_iterations + 1;
  bool fresh = false;

  bool linearise(const NewtonProgress&) {
    if (!refactor) return true;
    p.equations.jacobian(*own.ring_, J, own.jacobian_, momenta);
    p.has_values = fresh = true;
    p.factored = p.solver.factor(own.jacobian_) ? Matrix::jacobian : Matrix::none;
    return p.factored == Matrix::jacobian;
  }
  const std::vector<double>& residual() {
    if (!momenta) return Iteration::residual();
    p.equations.residual(*own.ring_, J, own.E_, nullptr, momenta);
    return own.E_;
  }
  void apply(const std::vector<double>& change, NewtonProgress& at) {
    Iteration::apply(change, at);
    p.last_iterations = at.iteration;
    if (fresh) p.fresh_iterations = at.iteration;
    refactor =
        always || at.correction > 0.1 * at.before || (at.iteration == 1 && !fresh && at.correction > 1e-3 * at.size);
    if (!always) return;
    // With a fresh matrix what is left is C correction², C as seen within the last eight slabs.
    p.unseen = at.iteration > 1 ? 0 : p.unseen + 1;
    if (at.iteration > 1) p.curvature = std::max(at.correction / (at.before * at.before), 0.5 * p.curvature);
    at.left = estimates && p.curvature > 0 && p.unseen < 8 ? 4 * p.curvature * at.correction * at.correction
                                                           : NewtonProgress::unknown;
  }
};
/// A last correction with the matrix that is there, and what the slab adds to the known part of the next, from one evaluation:
/// it takes the place of that of known() in the next step.
struct SlabStepper::Finish : Iteration {
  const std::vector<double>& residual() {
    p.equations.residual_and_gain(own.known_E_, *own.ring_, J, own.E_, own.gain_);
    return own.E_;
  }
  void apply(const std::vector<double>&, NewtonProgress& at) {
    own.take_change(p.unknowns, J, at);
    if (p.factored == Matrix::constant && at.before > 0) p.contraction = std::max(at.ratio(), 0.5 * p.contraction);
  }
};

/// Tolerances below smallest_estimated are met by corrections alone, but where finish() adds one.
bool SlabStepper::estimates(const Parity& p) const {
  return options_.tolerance >= smallest_estimated || p.momentum_follows;
}

/// Simplified Newton with the constant part, where it contracts fast enough.
Stop SlabStepper::iterate(Parity& p, std::int64_t J) {
  predict(p, J, points_);
  find_known(p, J, nullptr);
  if (!p.levels.empty()) return solve_levels(p, J);
  WithConstant equations{{*this, p, J, estimates(p)}};
  at_ = {};
  // Of linear equations one solve is enough for finish().
  const auto linear = [&](const NewtonProgress&) {
    return !plan_.nonlinear_in_slab && p.momentum_follows ? Stop::converged : Stop::no;
  };
  const Stop stop =
      delf::newton(equations, at_, Overflows{}, linear, Converged{options_.tolerance}, LittleLeft{options_.tolerance},
                   Rounding{}, Stalls{0.25}, OutOfIterations{options_.max_iterations});
  iterations_ += at_.iteration;
  return finish(p, J, stop);
}

/// Where the constant part has failed it is tried again after one step, then three, seven and so on up to 63.
bool SlabStepper::may_iterate(const Parity& p) {
  if (!p.has_constant || !system_.times()->uniform()) return false;
  if (waiting_ == 0) return true;
  --waiting_;
  return false;
}

/// Newton's method from a polynomial through so many slabs, or from the values that are there if none.
Stop SlabStepper::newton(Parity& p, std::int64_t J, int points, const std::vector<double>* momenta) {
  if (points > 0) predict(p, J, points);
  find_known(p, J, momenta);
  WithJacobian equations{{*this, p, J, estimates(p)}, momenta};
  at_ = {};
  // Far from the polynomial another root may be nearer.
  const auto kept = std::pair{p.last_iterations, p.fresh_iterations};
  const FarFromPredictor far{points > least_points ? 1e-2 : NewtonProgress::unknown};
  const Stop stop =
      delf::newton(equations, at_, Overflows{}, far, Converged{options_.tolerance}, LittleLeft{options_.tolerance},
                   Rounding{}, Diverges{}, OutOfIterations{options_.max_iterations});
  if (stop == Stop::diverges) p.factored = Matrix::none;
  // A predictor that is not followed says nothing of the matrix.
  if (stop == Stop::far_from_predictor) std::tie(p.last_iterations, p.fresh_iterations) = kept;
  iterations_ += at_.iteration;
  return finish(p, J, stop);
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

/// Corrects a root once more, and again if that shows that the iteration had not arrived.
Stop SlabStepper::finish(Parity& p, std::int64_t J, Stop stop) {
  if (!has_root(stop) || !p.momentum_follows) return stop;
  Finish equations{{*this, p, J}};
  // What is below rounding of the increment is not worth a solve.
  if (at_.left <= 1e-4 * epsilon * largest_[0]) {
    equations.residual();
    return stop;
  }
  const int before = at_.iteration + 1;
  stop = delf::newton(equations, at_, Overflows{}, Converged{options_.tolerance}, Rounding{}, Stalls{0.25},
                      OutOfIterations{options_.max_iterations + 1});
  iterations_ += at_.iteration - before;
  return stop;
}

/// y_J += mean(y_{J−1}) − mean(y_J) of every field, where means are a gauge.
void SlabStepper::keep_means(std::int64_t J) {
  if (system_.lattice().space() == Space::mesh || plan_.table.held.empty()) return;
  const std::size_t size = predicted_.size(), C = delf::at(components_);
  const double* const before = ring_->row(J - 1);
  double *const row = ring_->row(J), *const low = ring_->low(J);
  for (std::size_t c = 0; c < C; ++c) {
    if (plan_.table.held[c] == 0) continue;  // of site 0
    double gap = 0;
    for (std::size_t at = c; at < size; at += C) gap += before[at] - row[at];
    gap /= static_cast<double>(size / C);
    for (std::size_t at = c; at < size; at += C) add_exactly(row[at], low[at], gap);
  }
}

void SlabStepper::carry(const Parity& p, std::int64_t J) {
  if (!p.momentum_follows) return;
  for (std::size_t n = 0; n + 1 < gain_.size(); ++n) add_exactly(carried_[n], carried_low_[n], gain_[n]);
  carried_slab_ = J + 1;
}

/// Judges the root that Newton's method has gone to from a polynomial through so many slabs; 0: by the constant part.
Stop SlabStepper::watch(const Parity& p, std::int64_t J, int points, const std::vector<double>* momenta,
                        std::string& crossed) {
  if (const std::string tangled = mesh_ && J > 0 ? mesh_->crossing_at(*ring_, J - delay_) : ""; !tangled.empty()) {
    if (crossed.empty()) crossed = tangled;
    return Stop::tangled;
  }
  if (mesh_ && points > 0 && points < points_ && J >= 2 && root_.leaps(*ring_, J - delay_)) return Stop::leaps;
  if (!plan_.nonlinear_in_slab || !p.levels.empty()) return Stop::converged;
  const Stop stop = root_.judge(at_, *ring_, J, known_, p.watched);
  // No row tells where a first step goes.
  if (points == 0 || J > 1 || !has_root(stop) || at_.travelled == 0) return stop;
  find_known(p, J, momenta);
  return turns_back(system_, past_of(J, momenta), values_of(p, J), options_.tolerance) ? Stop::other_root : stop;
}

std::vector<double> SlabStepper::values_of(const Parity& p, std::int64_t J) const {
  std::vector<double> values;
  for (int n = 0; n < p.equations.size(); ++n) values.push_back(p.equations.value(*ring_, J, n));
  return values;
}
SlabPast SlabStepper::past_of(std::int64_t J, const std::vector<double>* momenta) const {
  const Assembly::Parts whole =
      Assembly::slab(plan_, static_cast<int>(J % plan_.table.parities), past_, future_, options_.monodromy);
  if (J > 0) return {*ring_, J, known_, whole, known_E_};
  return {*ring_, J, known_, first_slab(system_, whole, momenta), known_E_, momenta};
}

/// The root that a small step leads to, where Newton's method has found another. One that was only doubtful is
/// taken where that is not known, because not even a small step begins.
void SlabStepper::follow(Parity& p, std::int64_t J, const std::vector<double>* momenta, Stop why,
                         const std::vector<double>& doubtful) {
  predict(p, J, 1);
  find_known(p, J, momenta);
  const NewtonResult followed = follow_slab(system_, past_of(J, momenta), options_.tolerance, options_.max_iterations);
  iterations_ += followed.iterations;
  const bool is_doubtful = !followed.converged && followed.reached == 0 && !doubtful.empty();
  if (!followed.converged && !is_doubtful) {
    const bool begins = followed.reached > 0 && options_.max_iterations >= enough_iterations;
    fail(J,
         begins ? fmt::format("{}; the one that a small step leads to ends at {:.2g} of this step", in_words(why),
                              followed.reached)
                : fmt::format("{}, and none that a small step leads to", in_words(why)),
         begins ? fmt::format("reduce lattice.time_step below {:.2g}", followed.reached * system_.times()->step(J - 1))
                : "");
  }
  for (int n = 0; n < p.equations.size(); ++n)
    p.equations.value(*ring_, J, n) = (is_doubtful ? doubtful : followed.row)[n];
  if (const Stop stop = newton(p, J, 0, momenta); !has_root(stop)) fail(J, in_words(stop));
  if (!is_doubtful) continued_ = Continued::far;
}

void SlabStepper::solve(std::int64_t J, const std::vector<double>* momenta) {
  const FlushDenormals guard;
  Parity& p = parity(J);
  iterations_ = 0;
  continued_ = Continued::no;
  std::string crossed;
  Stop stop = Stop::no;
  if (!momenta && may_iterate(p)) {
    stop = iterate(p, J);
    waiting_ = has_root(stop) ? 0 : wait_;
    wait_ = has_root(stop) ? 1 : std::min(2 * wait_ + 1, 63);
    if (has_root(stop)) stop = watch(p, J, 0, momenta, crossed);
  }
  if (!has_root(stop)) {
    std::vector<double> doubtful;
    bool other = false;
    // Rough sections are predicted better by a few slabs, and a tangled mesh, or a root that has left the motion, is one
    // that another predictor may avoid. What is extrapolated may lie where the density is not defined.
    Stop why = stop;
    for (const int points : predictors_) {
      stop = newton(p, J, points, momenta);
      if (has_root(stop)) stop = watch(p, J, points, momenta, crossed);
      if (has_root(stop)) break;
      if (stop != Stop::tangled) why = stop;
      if (stop != Stop::doubtful_root && stop != Stop::other_root) continue;
      doubtful = stop == Stop::doubtful_root ? values_of(p, J) : std::vector<double>();
      other = true;
    }
    if (has_root(stop)) crossed.clear();
    // Where no predictor leads to any root the scheme is unstable, or has none: to follow one there would hide it.
    else if (crossed.empty() && !other) fail(J, in_words(why));
    else if (crossed.empty()) follow(p, J, momenta, why, doubtful);
  }
  if (!crossed.empty())
    throw MeshCrossing(
        fmt::format("step {}, t = {:.6g}: {}; in the row before, {}; reduce lattice.time_step or mesh.alpha", J,
                    system_.times()->time(J), crossed, mesh_->narrowest_cell(ring_->row(J - 1 - delay_))));
  keep_means(J);
  carry(p, J);
  if (momenta) p.factored = Matrix::none;
  if (options_.fibre == Fibre::circle) check_increments(J);
  ++known_;
  largest_[1] = std::exchange(largest_[0], largest_of(ring_->row(J - delay_)));
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
                      "where it cannot be distinguished from its complement; reduce lattice.time_step, or use "
                      "theory.fibre = R",
                      J, system_.times()->time(J)));
  }
}

void SlabStepper::step(bool /*looked_at*/) {
  solve(J_ + 1, nullptr);
  ++J_;
}

std::vector<double> SlabStepper::row(int back) const {
  std::vector<double> result(system_.lattice().sites() * components_);
  for (int c = 0; c < components_; ++c) {
    const double* values = ring_->row(newest() - back - back_[c]);
    for (std::size_t at = delf::at(c); at < result.size(); at += delf::at(components_)) result[at] = values[at];
  }
  return result;
}

Window SlabStepper::window(int rows) const {
  const std::size_t size = delf::at(system_.lattice().sites() * components_);
  std::vector<std::vector<double>> newest_rows;
  for (std::int64_t r = newest() - rows + 1; r <= newest(); ++r)
    newest_rows.emplace_back(ring_->row(r), ring_->row(r) + size);
  Window window = system_.window(newest() - rows + 1, std::move(newest_rows), options_.monodromy);
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
    worst = larger_or_nan(std::abs(residual_[n]), worst);
    size = larger_or_nan(absolute_[n], size);
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
      p.equations.value(*ring_, J_, n) = values[n];
      if (system_.component(p.equations.equation(n).component).role != Role::multiplier)
        size = std::max(size, absolute_[n]);
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
  const std::vector<double>* const all[] = {&E_,        &known_E_,  &gain_,    &change_,     &predicted_,
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
