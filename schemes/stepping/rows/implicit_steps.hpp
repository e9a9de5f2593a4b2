// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lattice/error.hpp"
#include "schemes/stepping/contraction.hpp"
#include "schemes/stepping/newton.hpp"
#include "schemes/stepping/rows/row_equations_step.hpp"
#include "schemes/stepping/rows/row_seed.hpp"
#include "schemes/stepping/rows/seen_contraction.hpp"
#include "schemes/stepping/rows/stepped_rows.hpp"

namespace delf {

/// Steps that solve for the new row: at once where it enters linearly, else by iterations with the constant part of the
/// matrix from a seed, else by full Newton steps.
class ImplicitSteps {
 public:
  /// `seed_rows`: that seeds are extrapolated from. `iterative`: the unknown row enters nonlinearly.
  ImplicitSteps(SteppedRows& at, RowEquations& equations, const LatticeSystem& system, const SolvePlan& plan,
                const StepOptions& options, int history, bool iterative, int seed_rows)
      : at_(at),
        equations_(equations),
        system_(system),
        plan_(plan),
        options_(options),
        history_(history),
        iterative_(iterative),
        tolerance_(std::max(options.tolerance, 4 * std::numeric_limits<double>::epsilon())),
        estimates_(options.tolerance >= smallest_estimated),
        has_arguments_(equations.arguments() != nullptr),
        contraction_(iterative ? std::optional(Contraction(system, plan)) : std::nullopt),
        stiff_(iterative && contraction_->is_stiff()),
        seed_(at.rows, system.time_step(), seed_rows, equations.looks(), equations.arguments()) {
    // Made now, so that memory that is short is told at the start.
    const bool goes_in_one = equations.is_streamed() || equations.goes_straight();
    if (equations.reads_unknown_row() && !(iterative_ && goes_in_one)) equations.candidate().hold_whole();
    if (iterative_) gain_ = equations.gain(), weight_ = equations.least_weight();
    can_go_in_place_ = iterative_ && !stiff_ && equations.can_go_in_place();
  }

  bool is_stiff() const { return stiff_; }
  /// Rows have been set anew, and outputs evaluated.
  void restart() {
    arguments_until_ = at_.n;
    seed_.restart();
  }
  /// Returns the largest |y| of the new row.
  double step(bool looked_at) {
    double value = 0;
    return !looked_at && may_step_in_place() && step_in_place(value) ? value : step_beside();
  }

 private:
  /// A step that leaves the row before it where it is.
  double step_beside() {
    equations_.begin(at_.n);
    equations_.evaluate_known_outputs();
    double value = 0;
    if (!iterative_ || stiff_ || !iterate(value)) value = step_without_iterations();
    if (can_go_in_place_ && at_.iterations == 1) at_.keep();
    else at_.kept_row = -1;
    return value;
  }
  [[gnu::noinline]] double step_without_iterations() {
    if (iterative_ && at_.known < history_) {
      step_again();
      equations_.begin(at_.n);
    }
    const double value = iterative_ ? follow_root() : solve_once();
    if (overflowed(value)) at_.report_not_finite();
    return value;
  }

  /// Neither the next step nor the seed's next look reads rows that a step in place would write over.
  bool may_step_in_place() const {
    return at_.kept_row >= 0 && at_.n != at_.kept_row && seed_.reads_one_increment(at_.n);
  }
  /// An implicit step in one stream through the rows, written over the old ones: these would else come from memory, and
  /// the new ones too. False if it would take a second iteration: nothing is changed then. Out of line, as all
  /// that steps through short rows do without: they would save registers and align the stack for it.
  [[gnu::noinline]] bool step_in_place(double& value) {
    equations_.begin_in_place(at_.n);
    at_.known = 0;
    const RowChange moved = advance_straight();
    const double next_change = contraction_now();
    at_.iterations = 1;
    value = moved.largest;
    if (!overflowed(value) && is_enough(moved.change, next_change, value)) {
      at_.rows.overwrite_newest();
      return true;
    }
    at_.iterations = 0;
    step_again();
    return false;
  }

  /// The steps from the kept row on once more, each beside the row before. They took one iteration.
  void step_again() {
    const std::int64_t last = at_.n;
    at_.go_back();
    for (; at_.n < last; ++at_.n) {
      equations_.begin(at_.n);
      at_.row_is_found(advance_straight().largest);
    }
    at_.kept_row = -1;
  }

  /// The unknown row enters linearly, with known coefficients: one solve, from any candidate. Outputs that were read
  /// from the candidate are part of what the next step knows: take them again.
  double solve_once() {
    const bool reads_candidate = equations_.reads_unknown_row();
    if (reads_candidate) {
      take_seed(1);
      equations_.evaluate_unknown_outputs(RowEquations::At::candidate);
    }
    const double value = equations_.advance(false).largest;
    if (reads_candidate) equations_.evaluate_unknown_outputs(RowEquations::At::row);
    return value;
  }

  void take_seed(int order) {
    if (!equations_.candidate().is_whole()) equations_.candidate().hold_whole();
    seed_.find(at_.n, order, equations_.candidate().rows());
    if (equations_.correction_form()) take_increment_of_candidate();
  }
  /// What w corrects.
  [[gnu::noinline]] void take_increment_of_candidate() {
    for (int a = 0; a < at_.rows.components(); ++a) {
      double* const v = at_.rows.v(at_.n + 1, a);
      const double *y = equations_.candidate().row(a), *before = at_.rows.y(at_.n, a);
      for (std::size_t s = 0; s < at_.rows.layout().doubles(); ++s) v[s] = y[s] - before[s];
    }
  }

  /// What the tolerance allows: relative to what the field spans, for where it has drifted to says nothing, but not
  /// below what rounding leaves at its size.
  double allowed(double size) const {
    const double span = seed_.span() > 0 ? std::min(seed_.span(), size) : size;
    return std::max(tolerance_ * span, 4 * std::numeric_limits<double>::epsilon() * size);
  }

  /// By which one more iteration's change would be less.
  double contraction_now() {
    if (contracted_ < 0 || contraction_->is_outgrown(at_.largest[0]))
      contracted_ = contraction_->next_change(at_.largest[0], weight_, gain_);
    return contracted_;
  }
  /// One more iteration would change the row by no more than what it makes of the last change.
  bool is_enough(double change, double next_change, double value) const {
    const double enough = allowed(std::max({value, at_.largest[0], at_.largest[1]}));
    return change <= weight_ * enough || (estimates_ && next_change * change <= enough);
  }

  [[gnu::noinline]] RowChange advance_streamed(int order) {
    return equations_.advance_streamed(
        [this, order](PackRange packs) { seed_.find(at_.n, order, equations_.candidate().rows(), packs); });
  }
  /// From a seed of order 1, rows that outgrow the cache.
  RowChange advance_straight() {
    return equations_.goes_straight() ? equations_.advance_straight(at_.largest_ever) : advance_streamed(1);
  }
  /// From the seed. Where one iteration is not enough, it is the outputs that are extrapolated: the row made from these
  /// is as good as from outputs evaluated where they are expected to look, and spares that.
  RowChange advance_first() {
    if (!has_arguments_) return advance_seeded(seed_.order());
    if (goes_straight()) {
      const RowChange moved = equations_.advance_straight(at_.largest_ever);
      if (overflowed(moved.largest) || is_enough(moved.change, contraction_now(), moved.largest)) return moved;
      straight_is_enough_ = false;
    }
    if (arguments_until_ != at_.n) equations_.find_arguments();
    arguments_until_ = at_.n + 1;
    if (extrapolates_outputs()) return advance_from_outputs();
    return equations_.advance_extrapolated(seed_.order(), at_.largest_ever);
  }
  /// Along straight lines no rows of arguments are read, and none are made: the seed's next look asks for those of some
  /// steps before it.
  bool goes_straight() const {
    return straight_is_enough_ && equations_.goes_straight() && seed_.reads_one_increment(at_.n);
  }
  bool extrapolates_outputs() const {
    const int order = seed_.order_of_outputs();
    return has_arguments_ && order > 0 && equations_.can_extrapolate_outputs(order);
  }
  [[gnu::noinline]] RowChange advance_from_outputs() {
    return advance_again(equations_.advance_from_outputs(seed_.order_of_outputs()));
  }
  [[gnu::noinline]] RowChange advance_seeded(int order) {
    if (order == 1 && equations_.goes_straight()) return equations_.advance_straight(at_.largest_ever);
    if (equations_.is_streamed()) return advance_streamed(order);
    take_seed(order);
    return advance_from_candidate();
  }
  /// `value`: the largest |y| of the row that was found.
  RowChange advance_again(double value) {
    if (has_arguments_) return equations_.advance_again(std::max(at_.largest_ever, value));
    if (equations_.is_streamed()) return equations_.advance_streamed({});
    return advance_from_candidate();
  }
  RowChange advance_from_candidate() {
    equations_.evaluate_unknown_outputs(RowEquations::At::candidate);
    return equations_.advance(true);
  }

  /// Simplified Newton with the constant part. False when it does not contract, or not fast enough. One iteration is
  /// what most steps take.
  bool iterate(double& value) {
    const double next_change = contraction_now();
    if (seed_.choose(at_.n, tolerance_, next_change, estimates_ ? next_change : 1 / weight_))
      seen_.forget(), straight_is_enough_ = true;
    at_.iterations = 1;
    const RowChange moved = advance_first();
    value = moved.largest;
    // A field that overflowed has no root to look for.
    if (overflowed(value)) at_.report_not_finite();
    return is_enough(moved.change, next_change, value) ||
           (seen_.is_like(moved.change) && is_enough(moved.change, seen_.next_change(), value)) ||
           iterate_on(value, moved.change, next_change);
  }
  /// After the first, whose change was not small enough.
  [[gnu::noinline]] bool iterate_on(double& value, double change, double next_change) {
    if (at_.known < history_ && equations_.looks_back()) {  // the first one, along straight lines, did not
      step_again();
      equations_.begin(at_.n);
      change = advance_first().change;
    }
    while (at_.iterations < options_.max_iterations) {
      const double before = change;
      // Arguments go on by themselves: the row is wanted only where one iteration more may not be the last, or shows
      // what the first one left.
      const bool shows = estimates_ && at_.iterations == 1 && extrapolates_outputs() && !seen_.is_like(change);
      const bool is_row_before_kept =
          !has_arguments_ || !estimates_ || shows || !is_enough(weight_ * next_change * change, next_change, value);
      if (is_row_before_kept) equations_.make_row_the_candidate();
      ++at_.iterations;
      const RowChange moved = advance_again(value);
      value = moved.largest, change = moved.change;
      if (overflowed(value)) at_.report_not_finite();
      if (shows) seen_.see(before, equations_.whole_change());
      if (is_enough(change, next_change, value)) return true;
      if (estimates_ && is_row_before_kept) {
        next_change = std::min(next_change, 2 * equations_.whole_change() / before);
        if (is_enough(change, next_change, value)) return true;
      }
      // Changes that no longer shrink are rounding, if they are small, or else the fixed point does not contract.
      if (at_.iterations >= 3 && change > 0.25 * before)
        return change <=
               64 * std::numeric_limits<double>::epsilon() * std::max({value, at_.largest[0], at_.largest[1]});
    }
    return false;
  }

  /// Returns the largest |y| of the row found. Out of line, like all that only some steps come to.
  [[gnu::noinline]] double follow_root() {
    const Window past = at_.rows.window(at_.n + 1 - history_, at_.n);
    const NewtonResult result = solve_slab(system_, plan_, past, options_.tolerance, options_.max_iterations);
    at_.iterations += result.iterations;
    if (!result.converged)
      throw NoConvergence(fmt::format(
          "step {}, t = {:.6g}: the implicit equations were not solved: the simplified Newton method does not "
          "contract, and the root could not be followed from a small time step by full Newton steps; reduce "
          "lattice.courant or lattice.time_step",
          at_.n + 1, static_cast<double>(at_.n + 1) * system_.time_step()));
    at_.rows.set_row(at_.n + 1, result.row);
    at_.rows.find_increment(at_.n + 1);
    equations_.evaluate_unknown_outputs(RowEquations::At::row);
    double value = 0;
    for (double x : result.row) value = std::max(value, std::abs(x));
    return value;
  }

  SteppedRows& at_;
  RowEquations& equations_;
  const LatticeSystem& system_;
  const SolvePlan& plan_;
  const StepOptions& options_;
  const int history_;
  const bool iterative_;
  const double tolerance_;
  /// The smallest tolerances ask for all that rounding allows: there nothing is left to an estimate.
  const bool estimates_;
  static constexpr double smallest_estimated = 0.99e-13;
  const bool has_arguments_;                ///< which are extrapolated in the place of y
  std::optional<Contraction> contraction_;  ///< of an iteration
  const bool stiff_;
  RowSeed seed_;
  bool can_go_in_place_ = false;
  double gain_ = 0, weight_ = 1;  ///< of the equations, for contraction
  double contracted_ = -1;        ///< by which one more iteration's change would be less; negative: not known yet
  SeenContraction seen_;          ///< of steps from extrapolated outputs, since the seed's last look
  bool straight_is_enough_ = true;     ///< for one iteration, since then
  std::int64_t arguments_until_ = -1;  ///< the newest row whose arguments are there, with those that a seed reads
};

}  // namespace delf
