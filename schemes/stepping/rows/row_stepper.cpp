// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lattice/error.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/newton.hpp"
#include "schemes/stepping/rows/kept_rows.hpp"
#include "schemes/stepping/rows/predictor.hpp"
#include "schemes/stepping/rows/row_strips.hpp"
#include "schemes/stepping/rows/step_tolerance.hpp"
#include "schemes/stepping/rows/wrapped_differences.hpp"
#include "schemes/stepping/slab_stepper.hpp"

namespace delf {
namespace {

constexpr double round_off = std::numeric_limits<double>::epsilon();
constexpr int most_components = 32;
/// A correction contracts at most so many times worse than the one before it: the ratio of two is seen within a few per cent.
constexpr double more_than_seen = 4;

// The passes of a step over its rows, strip by strip. Each returns the largest |y_{n+1}|, and in `corrections` the largest
// |δ| of each source term.

/// The pass of a step in which no source term depends on row n + 1.
double explicit_pass(RowOperations& rows) {
  return rows.pass(Solving::step, nullptr, [](RowOperations& part) {
    for (const Strip& strip : part.strips()) {
      part.evaluate(strip);                    // g = ∂ℓ/∂φ at the quadrature values of the rows up to n
      part.right_side(strip);                  // r = −(linear part of the known rows) − r(0) − Σ hk weight · g
      while (const Strip next = part.solve())  // A₊ w = r
        part.update(next);                     // v_{n+1} = v_n + w,   y_{n+1} = y_n + v_{n+1}
    }
  });
}

/// The pass in which g at row n + 1 is predicted from so many rows; or, of order 0, is there.
double predicted_pass(RowOperations& rows, int order, std::vector<double>& corrections) {
  return rows.pass(Solving::step, &corrections, [order](RowOperations& part) {
    for (const Strip& strip : part.strips()) {
      part.evaluate(strip);                       // g of source terms that row n + 1 does not enter
      if (order > 0) part.predict(order, strip);  // g ≈ Σ_j (−1)^{j+1} C(p, j) g_{n+1−j}
      part.right_side(strip);  // r = −(linear part of the known rows) − r(0) − Σ hk weight · g
      while (const Strip next = part.solve()) {  // A₊ w = r
        part.update(next);                       // v_{n+1} = v_n + w,   y_{n+1} = y_n + v_{n+1}
        part.compare(next);                      // δ = g′ − g,   g ← g′ = ∂ℓ/∂φ at row n + 1
      }
    }
  });
}

/// The pass that corrects. The last correction evaluates no δ: null.
double correction_pass(RowOperations& rows, std::vector<double>* corrections) {
  return rows.pass(Solving::correction, corrections, [corrections](RowOperations& part) {
    for (const Strip& strip : part.strips()) {
      part.right_side(strip);                    // r = −Σ hk weight · δ
      while (const Strip next = part.solve()) {  // A₊ δw = r
        part.update(next);                       // v_{n+1} += δw,   y_{n+1} += δw
        if (corrections) part.compare(next);     // δ = g′ − g,   g ← g′
      }
    }
  });
}

}  // namespace

/// A step, in which the source terms g at row n + 1 are the one thing that is iterated: predicted, they give a row; what
/// this row makes of them, less what they were, is δ; and corrections follow until the change of y by δ is below the
/// tolerance.
struct RowStepper::Impl {
  const LatticeSystem& system;
  const SolvePlan& plan;
  const StepOptions options;
  const int d, history, most_rows;
  const RowLayout layout;
  RowTable table;
  RowEquations equations;
  KeptRows kept;
  Predictor predictor;
  RowStrips rows;
  std::optional<StepTolerance> tolerance;  ///< if equations iterate
  std::vector<double> corrections;         ///< of each source row: the largest |δ|

  int past_sources = 0;       ///< rows of source terms that are there before row n + 1
  int source_rows_there = 0;  ///< the same as predictions count them
  int iterations = 0;
  Continued continued = Continued::no;     ///< of the last step
  double largest = 0, largest_before = 0;  ///< |y| of row n, and of the row before

  Impl(const LatticeSystem& s, const SolvePlan& p, const StepOptions& o)
      : system(s),
        plan(p),
        options(o),
        d(s.components()),
        history(std::max(p.forward + p.backward, 2)),
        most_rows(Predictor::rows_for(o.predictor_order, s.lattice().sites())),
        layout(s.lattice(), std::max(1, s.width()), s.placement() == Placement::brick_wall ? 2 : 1),
        equations(s, p, layout, table, history, most_rows),
        kept(s, layout, equations, table, history, o.monodromy),
        predictor(equations, layout, most_rows),
        rows(s, equations, layout, table, kept, o, history) {
    if (d > most_components) throw NoConvergence("rows of so many components go slab by slab");
    if (!equations.iterates()) return;
    tolerance.emplace(system, equations, layout, table, options);
    corrections.assign(tolerance->gains().size(), 0.0);
  }

  std::int64_t n() const { return kept.newest(); }

  // ---- A step.

  void begin_step() {
    rows.evaluate_known();
    if (!equations.iterates()) return;
    if (source_rows_there == 0) {
      kept.extrapolate();  // y_{n+1} = y_n + v_n, where there are no past source terms
      rows.evaluate_unknown();
    } else if (predictor.is_due(n())) {
      choose_order();
    }
  }
  void choose_order() {
    tolerance->see_span(table);
    predictor.choose(table, n(), source_rows_there, tolerance->gains(), contraction_now(), tolerance->enough(largest),
                     system.time_step());
  }
  double contraction_now() { return tolerance->contraction().next_change(largest, n()); }
  bool is_stiff(double size) { return tolerance && tolerance->contraction().is_stiff(size, n()); }

  /// The new row, beside the old one or over it. False if it could not be solved for; `continued` then says why.
  bool solve_step() {
    begin_step();
    iterations = 0;
    continued = Continued::no;
    if (!equations.iterates()) return set_largest(explicit_pass(rows));
    double value = predicted_pass(rows, source_rows_there > 0 ? predictor.order() : 0, corrections);
    if (overflowed(value)) return set_largest(value);
    const double size = std::max({value, largest, largest_before});
    double by = contraction_now();
    const double enough = tolerance->enough(size);
    double effect = tolerance->effect_of(corrections);
    for (iterations = 1; !(effect <= enough);) {
      if (!(effect < 1e100)) return give_up(Continued::slow);
      if (iterations >= options.max_iterations) return give_up(Continued::out_of_iterations);
      // An estimate of what is left after this correction may spare its evaluation.
      const bool is_last = by * effect <= enough;
      value = correction_pass(rows, is_last ? nullptr : &corrections);
      if (overflowed(value)) return give_up(Continued::slow);
      ++iterations;
      if (is_last) break;
      const double before = effect;
      effect = tolerance->effect_of(corrections);
      // Corrections that no longer shrink are rounding, if they are small, or else the fixed point does not contract.
      if (iterations >= 3 && effect > 0.5 * before) {
        if (effect <= 64 * round_off * size) break;
        return give_up(Continued::slow);
      }
      by = std::min(by, more_than_seen * effect / before);
    }
    return may_have_other_roots(value) ? give_up(Continued::stiff) : set_largest(value);
  }
  /// There may be other roots near row n + 1 as it stands, whose largest |y| is `value`. A step in place has no row n any
  /// more to look from.
  bool may_have_other_roots(double value) {
    if (!is_stiff(std::max(value, largest))) return false;
    return kept.in_place() || tolerance->contraction().is_stiff_along(table, n());
  }
  bool give_up(Continued why) {
    continued = why;
    return false;
  }
  bool set_largest(double value) {
    largest_before = largest, largest = value;
    return true;
  }
  /// Solves where the fixed point does not contract: by Newton's method, and where there may be other roots than its
  /// own, by following the root from a small time step.
  void solve_by_newton() {
    const Window past = kept.window(history);
    if (continued != Continued::stiff) {
      const NewtonResult direct =
          solve_slab(system, plan, past, options.tolerance, std::min(options.max_iterations, enough_iterations), false);
      iterations += direct.iterations;
      if (direct.converged && has_no_other_root_near(direct.row)) return;
      if (is_stiff(largest)) continued = Continued::stiff;
    }
    const NewtonResult result = solve_slab(system, plan, past, options.tolerance, options.max_iterations);
    iterations += result.iterations;
    if (!result.converged)
      throw NoConvergence(fmt::format(
          "step {}, t = {:.6g}: the implicit equations were not solved: {}, and the root could not be followed from a "
          "small time step by full Newton steps; {}",
          n() + 1, static_cast<double>(n() + 1) * system.time_step(), in_words(continued),
          remedy_for(options.max_iterations)));
    set_row(result.row);
    set_largest(kept.largest(0));
  }
  void set_row(const std::vector<double>& row) {
    kept.set(0, row);
    kept.find_increment(0);
    rows.evaluate_unknown();
  }
  /// Takes a row that Newton's method has found, unless there may be other roots near it.
  bool has_no_other_root_near(const std::vector<double>& row) {
    set_row(row);
    const double value = kept.largest(0);
    return !may_have_other_roots(value) && set_largest(value);
  }

  /// True if row 1 of a centred start may have other roots, from row 0 and y₋₁ = y₁ − 2hφ_t.
  bool may_have_other_roots_from(const std::vector<double>& row0, const std::vector<double>& velocity,
                                 const std::vector<double>& row1) {
    if (!tolerance) return false;
    std::vector<double> before = row1;
    for (std::size_t i = 0; i < before.size(); ++i) before[i] -= 2 * system.time_step() * velocity[i];
    kept.leave_place();
    kept.set(0, row1), kept.set(1, row0), kept.set(2, before);
    tolerance->restart();
    largest = kept.largest(1);
    return may_have_other_roots(kept.largest(0));
  }

  void step_beside() {
    kept.leave_place();
    kept.forget_oldest();
    if (!solve_step()) solve_by_newton();
    if (overflowed(largest)) {
      largest = largest_before;
      report_not_finite();
    }
    if (options.fibre == Fibre::circle) check_wrapped_differences(system, layout, kept.all(), n() + 1);
    kept.advance();
    advance_sources();
  }
  void advance_sources() {
    for (const SourceRow& source : equations.sources())
      if (!source.is_local) table.advance(source.ring);
    ++past_sources;
    count_sources();
  }
  /// Counts source rows at the same sites: those of bricks are every second one.
  void count_sources() {
    source_rows_there = most_rows;
    for (const SourceRow& source : equations.sources())
      if (source.reads_unknown)
        source_rows_there = std::min(source_rows_there, std::min(past_sources, source.ring.held - 1) / source.stride);
  }

  /// A step that takes the place of the newest row.
  bool step_in_place() {
    if (!kept.in_place()) kept.go_in_place();
    if (!solve_step() || overflowed(largest)) return false;
    kept.advance_in_place();
    advance_sources();
    return true;
  }
  /// Back to the row before the first step in place, and from there on beside each other.
  void step_again(std::int64_t last) {
    kept.go_back_to_kept();
    find_past_sources();
    largest = largest_before = kept.largest(1);
    while (n() < last) step_beside();
  }

  /// A step whose row nobody asks for is in place, as long as there is a row to go back to.
  void step(bool looked_at) {
    const bool may_be_in_place = !looked_at && rows.can_go_in_place() &&
                                 (kept.in_place() || (kept.known() >= 2 && n() > kept.start_row())) &&
                                 !(equations.iterates() && source_rows_there == 0) && !is_stiff(largest);
    if (!may_be_in_place) step_beside();
    else if (!step_in_place()) step_again(n() + 1);
  }

  // ---- Rows.

  void start(const std::vector<std::vector<double>>& first_rows) {
    kept.start(first_rows);
    largest = kept.largest(1), largest_before = kept.largest(2);
    if (tolerance) tolerance->restart();
    find_past_sources();
  }
  /// Source terms before the unknown row's, as far as equations read them.
  void find_past_sources() {
    past_sources = std::numeric_limits<int>::max() / 2;
    for (std::size_t s = 0; s < equations.sources().size(); ++s) {
      const SourceRow& source = equations.sources()[s];
      if (source.is_local) continue;
      for (int back = 1; source.component == 0 && back <= source.newest - source.oldest; ++back)
        rows.evaluate_rows(s, back);
      if (source.reads_unknown) past_sources = std::min(past_sources, source.newest - source.oldest);
    }
    count_sources();
    predictor.restart();
  }

  void visit(SavedState& state) {
    kept.visit(state);
    for (const SourceRow& source : equations.sources()) {
      for (int back = 0; back < source.ring.held && !source.is_local; ++back)
        state.numbers("source terms", table[source.ring.row(back)], layout.doubles());
      if (source.correction >= 0) state.numbers("changes of source terms", table[source.correction], layout.doubles());
    }
    state("rows of source terms", past_sources), state("rows to predict from", source_rows_there);
    state("iterations", iterations), state("continued", continued);
    state("largest", largest), state("largest before", largest_before);
    predictor.visit(state);
    if (tolerance) tolerance->visit(state);
  }

  [[noreturn]] void report_not_finite() const {
    const std::vector<double> bad = kept.values(0), before = kept.values(1);
    const auto fine = [](double x) { return !overflowed(std::abs(x)); };
    // Implicit steps spread an overflow over the whole row: it is where the field was largest.
    const auto where = std::ranges::none_of(bad, fine)
                           ? std::ranges::max_element(before, {}, [](double x) { return std::abs(x); }) - before.begin()
                           : std::ranges::find_if_not(bad, fine) - bad.begin();
    throw NotFinite(
        fmt::format("step {}, t = {:.6g}, site {}: the field is no longer finite: the scheme is unstable here; "
                    "reduce lattice.courant or lattice.time_step, or choose an implicit stencil",
                    n() + 1, static_cast<double>(n() + 1) * system.time_step(), where / d));
  }
  std::size_t source_bytes() const {
    std::size_t bytes = 0;
    for (const SourceRow& source : equations.sources())
      bytes += RowBuffer::bytes_of(layout.doubles(), source.ring.held + (source.correction >= 0 ? 1 : 0));
    return bytes;
  }
};

RowStepper::RowStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : impl_(std::make_unique<Impl>(system, plan, options)) {}
RowStepper::~RowStepper() = default;

void RowStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  SlabStepper first(impl_->system, impl_->plan, impl_->options);
  first.start_legendre(row0, momenta);
  start({row0, first.row(0)});
}

void RowStepper::start(const std::vector<std::vector<double>>& rows) {
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (double x : rows[r])
      if (overflowed(std::abs(x))) throw NotFinite(fmt::format("row {} of the start is not finite", r));
  impl_->start(rows);
}

void RowStepper::start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) {
  Impl& s = *impl_;
  if (s.history != 2)
    throw BadInput("initial.start", "initial.start = centred makes one more row, and this stencil needs " +
                                        std::to_string(s.history) + " starting rows; choose initial.start = exact");
  const Window first{&s.system.lattice(), s.d, s.options.monodromy, 0, {row0}};
  const auto solved = [&](bool followed) {
    return solve_centred_start(s.system, s.plan, first, velocity, followed, s.options.tolerance,
                               s.options.max_iterations)
        .row;
  };
  const std::vector<double> row1 = solved(false);
  start({row0, s.may_have_other_roots_from(row0, velocity, row1) ? solved(true) : row1});
}

void RowStepper::step(bool looked_at) {
  const FlushDenormals guard;
  impl_->step(looked_at);
}
void RowStepper::visit(SavedState& state) { impl_->visit(state); }
StepState RowStepper::state() const { return {impl_->n(), impl_->iterations, impl_->continued, impl_->kept.known()}; }
std::vector<double> RowStepper::row(int back) const {
  impl_->kept.require(back + 1);
  return impl_->kept.values(impl_->kept.number(back + 1));
}
double RowStepper::residual() const {
  Impl& s = *impl_;
  if (s.n() < s.history) return 0;
  if (s.kept.known() < 2) return std::numeric_limits<double>::quiet_NaN();
  RowTable rows = s.table;
  rows.go_back(s.equations.y()), rows.go_back(s.equations.v());
  for (const SourceRow& source : s.equations.sources())
    if (!source.is_local) rows.go_back(source.ring);
  return s.equations.residual(std::move(rows), s.n() - 1);
}
Window RowStepper::window(int rows) const {
  impl_->kept.require(rows);
  return impl_->kept.window(rows);
}
void RowStepper::newest_pair(const double** rows) const {
  const Impl& s = *impl_;
  s.kept.require(2);
  for (int a = 0; a < s.d; ++a) {
    rows[a] = s.table[s.equations.y().row(2, a)];
    rows[s.d + a] = s.table[s.equations.y().row(1, a)];
    rows[2 * s.d + a] = s.table[s.equations.v().row(1, a)];
    s.layout.fill_halo(s.table[s.equations.v().row(1, a)]);  // which steps may do without
  }
}

StepReport RowStepper::report(bool residual) const {
  const Impl& s = *impl_;
  const std::size_t rows = s.kept.bytes(), sources = s.source_bytes(), matrix = s.equations.matrix_bytes();
  const std::size_t work = s.equations.work_bytes() + s.rows.bytes() + s.layout.bytes();
  const bool comes = residual && s.equations.work_bytes() < s.equations.residual_bytes();
  const std::size_t to_come = comes ? s.equations.residual_bytes() : 0;
  return {
      .starting_rows = s.history,
      .iterates = s.equations.iterates(),
      .matrix_free = matrix == 0,
      .sites_of_an_arc = s.rows.packs_of_an_arc() * lanes,
      .solver = s.equations.solver(0).name(),
      .layout = &s.layout,
      .bytes = rows + sources + matrix + work,
      .bytes_to_come = to_come,
      .memory = fmt::format("rows of the field and increments {} B, source terms {} B, matrix {} B, work space {} B",
                            rows, sources, matrix, work + to_come)};
}

}  // namespace delf
