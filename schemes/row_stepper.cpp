// SPDX-License-Identifier: MIT
#include "schemes/row_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/error.hpp"
#include "schemes/flush_denormals.hpp"
#include "schemes/newton.hpp"
#include "schemes/row_equations.hpp"

namespace delf {

struct RowStepper::Impl {
  const LatticeSystem& system;
  const SolvePlan& plan;
  const StepOptions options;
  const int d, history, seed_rows;
  const bool iterative, stiff;
  SectionRows rows;
  RowEquations equations;
  RowSum sum;

  std::int64_t n = -1;         ///< newest row
  double largest[2] = {0, 0};  ///< |y| of the newest two rows
  int iterations = 0;

  Impl(const LatticeSystem& s, const SolvePlan& p, const StepOptions& o)
      : system(s),
        plan(p),
        options(o),
        d(s.components()),
        history(std::max(p.forward + p.backward, 2)),
        seed_rows(std::clamp(o.seed_order, 1, 12)),
        iterative(!solved_at_once(s, p)),
        stiff(iterative && is_stiff(s, p)),
        rows(s, std::max(1, s.width()), history + 1, std::max(history - 1, iterative ? seed_rows - 1 : 1) + 1, o.turn),
        equations(s, p, rows, history) {}

  const RowLayout& layout() const { return rows.layout(); }

  struct Change {
    double change = 0;  ///< largest |change of v_{n+1}| against the candidate before
    double value = 0;   ///< largest |y_{n+1}|
  };

  /// v_{n+1} and y_{n+1} from w.
  Change take_increment() {
    const bool correct = equations.correction_form();
    Pack change(0.0), value(0.0);
    for (int a = 0; a < d; ++a) {
      double *v_new = rows.v(n + 1, a), *y_new = rows.y(n + 1, a);
      const double *w = equations.w(a), *v_old = rows.v(n, a), *y_old = rows.y(n, a);
      const double* from = correct ? v_new : v_old;
      for (int p = 0; p < layout().packs(); ++p) {
        const auto at = layout().at(p);
        const Pack before = Pack::load(v_new + at);
        const Pack next = Pack::load(w + at) + Pack::load(from + at);
        const Pack y_next = Pack::load(y_old + at) + next;
        next.store(v_new + at);
        y_next.store(y_new + at);
        change = max_or_nan(abs(next - before), change);
        value = max_or_nan(abs(y_next), value);
      }
      layout().fill_halo(v_new);
      layout().fill_halo(y_new, options.turn);
    }
    return {max_or_nan(change), max_or_nan(value)};
  }

  /// The candidate y_{n+1} from past increments: v_{n+1} ≈ Σ_{m=1}^{order} (−1)^{m+1} C(order, m) v_{n+1−m}, the polynomial
  /// through the last order + 1 rows.
  void seed(int order) {
    order = std::min({order, static_cast<int>(n), rows.increments_held() - 1});
    for (int a = 0; a < d; ++a) {
      sum.clear();
      double coefficient = -1;
      for (int m = 1; m <= order; ++m) {
        coefficient *= -static_cast<double>(order - m + 1) / m;
        sum.add(rows.v(n + 1 - m, a), 0, coefficient, 0, false);
      }
      std::fill_n(rows.v(n + 1, a), layout().doubles(), 0.0);
      sum.evaluate(layout(), 0, 0, nullptr, rows.v(n + 1, a), nullptr);
    }
    rows.add_increment(n + 1);
  }

  /// One pass: E at the candidate, w, and from it the next candidate.
  Change improve() {
    equations.evaluate_outputs(n, true);
    equations.restore();
    equations.add(n, RowEquations::fresh);
    equations.solve(n);
    return take_increment();
  }

  void step() {
    const FlushDenormals guard;
    iterations = 0;
    equations.evaluate_known_outputs(n);
    equations.clear();
    equations.add(n, RowEquations::known);
    equations.keep();
    Change last;
    if (!iterative) {
      // The unknown row enters linearly, with known coefficients: one solve, from any candidate. Outputs that were read
      // from the candidate are part of what the next step knows: take them again.
      seed(1);
      last = improve();
      equations.evaluate_outputs(n, true);
    } else {
      if (stiff || !iterate(last)) last.value = follow_root();
    }
    if (overflowed(last.value)) report_not_finite();
    if (options.fibre == Fibre::circle) check_wrapped_differences();
    largest[1] = largest[0];
    largest[0] = last.value;
    ++n;
  }

  /// Simplified Newton with the constant part. False when it does not contract, or not fast enough.
  bool iterate(Change& last) {
    seed(seed_rows - 1);
    double before = std::numeric_limits<double>::infinity();
    while (iterations < options.max_iterations) {
      ++iterations;
      last = improve();
      // A field that overflowed has no root to look for.
      if (overflowed(last.value)) report_not_finite();
      const double scale = std::max({last.value, largest[0], largest[1]});
      if (last.change <= std::max(options.tolerance, 4 * std::numeric_limits<double>::epsilon()) * scale) return true;
      // Changes that no longer shrink are rounding, if they are small, or else the fixed point does not contract.
      if (iterations >= 3 && last.change > 0.25 * before)
        return last.change <= 64 * std::numeric_limits<double>::epsilon() * scale;
      before = last.change;
    }
    return false;
  }

  /// Returns the largest |y| of the row found.
  double follow_root() {
    const Window past = rows.window(n + 1 - history, n);
    const NewtonResult result = solve_slab(system, plan, past, options.tolerance, options.max_iterations);
    iterations += result.iterations;
    if (!result.converged)
      throw NoConvergence(fmt::format(
          "step {}, t = {:.6g}: the implicit equations were not solved: the simplified Newton method does not "
          "contract, and the root could not be followed from a small time step by full Newton steps; reduce "
          "lattice.courant or lattice.time_step",
          n + 1, static_cast<double>(n + 1) * system.time_step()));
    rows.set_row(n + 1, result.row);
    rows.find_increment(n + 1);
    equations.evaluate_outputs(n, true);
    double value = 0;
    for (double x : result.row) value = std::max(value, std::abs(x));
    return value;
  }

  [[noreturn]] void report_not_finite() {
    // Implicit steps spread an overflow over the whole row: it is where the field was largest.
    const std::vector<double> row = rows.row(n + 1), before = rows.row(n);
    const auto fine = [](double x) { return !overflowed(std::abs(x)); };
    const bool everywhere = std::ranges::none_of(row, fine);
    const auto bad = everywhere
                         ? std::ranges::max_element(before, {}, [](double x) { return std::abs(x); }) - before.begin()
                         : std::ranges::find_if_not(row, fine) - row.begin();
    throw NotFinite(
        fmt::format("step {}, t = {:.6g}, site {}: the field is no longer finite: the scheme is unstable here; "
                    "reduce lattice.courant or lattice.time_step, or choose an implicit stencil",
                    n + 1, static_cast<double>(n + 1) * system.time_step(), bad / d));
  }

  /// S¹: wrapping says which way round only while differences on a stencil stay well below π. Looks at the stencils
  /// whose top row is the new one, from their first vertex to each other.
  void check_wrapped_differences() {
    for (const auto& family : system.families()) {
      const auto& vertices = family->pattern().vertices;
      const int top = std::ranges::max(vertices, {}, &Site::time).time;
      for (const Site& vertex : vertices) {
        const std::int64_t from = n + 1 - top + vertices[0].time, to = n + 1 - top + vertex.time;
        if (std::min(from, to) < 0) continue;
        for (int a = 0; a < d; ++a)
          check_wrapped_difference(rows.y(from, a), rows.y(to, a),
                                   static_cast<std::ptrdiff_t>(vertex.space - vertices[0].space) * lanes);
      }
    }
  }
  void check_wrapped_difference(const double* from, const double* to, std::ptrdiff_t shift) {
    Pack most(0.0);
    for (int p = 0; p < layout().packs(); ++p) {
      const auto at = layout().at(p);
      most = max_or_nan(abs(Pack::load(to + at + shift) - Pack::load(from + at)), most);
    }
    if (max_or_nan(most) <= largest_wrapped_difference) return;
    int site = 0;
    while (std::abs(to[layout().slot(site) + shift] - from[layout().slot(site)]) <= largest_wrapped_difference) ++site;
    throw NotFinite(fmt::format(
        "step {}, t = {:.6g}, site {}: on the fibre S1 a wrapped difference within a stencil is above 0.9 pi, where it "
        "cannot be told from its complement; refine the lattice, reduce lattice.courant, or use theory.fibre = R",
        n + 1, static_cast<double>(n + 1) * system.time_step(), site));
  }

  double residual() {
    const std::int64_t base = n - 1;
    if (base < history - 1) return 0;
    return equations.residual(base);
  }
};

RowStepper::RowStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : impl_(std::make_unique<Impl>(system, plan, options)) {}
RowStepper::~RowStepper() = default;

int RowStepper::starting_rows() const { return impl_->history; }

void RowStepper::start(const std::vector<std::vector<double>>& rows) {
  Impl& s = *impl_;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (double x : rows[r])
      if (overflowed(std::abs(x))) throw NotFinite(fmt::format("row {} of the start is not finite", r));
    s.rows.set_row(static_cast<std::int64_t>(r), rows[r]);
    if (r > 0) s.rows.find_increment(static_cast<std::int64_t>(r));
    s.largest[1] = s.largest[0];
    s.largest[0] = 0;
    for (double x : rows[r]) s.largest[0] = std::max(s.largest[0], std::abs(x));
  }
  s.n = static_cast<std::int64_t>(rows.size()) - 1;
  s.equations.evaluate_outputs(s.n, false);
}

void RowStepper::start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) {
  Impl& s = *impl_;
  if (s.history != 2)
    throw BadInput("initial.start", "initial.start = centred makes one more row, and this stencil needs " +
                                        std::to_string(s.history) + " starting rows; choose initial.start = exact");
  const Window first{&s.system.lattice(), s.d, s.options.turn, 0, {row0}};
  const NewtonResult result =
      solve_centred_start(s.system, s.plan, first, velocity, s.stiff, s.options.tolerance, s.options.max_iterations);
  if (!result.converged)
    throw NoConvergence(
        "the starting row of initial.start = centred was not found: Newton's method did not converge; "
        "reduce lattice.courant or lattice.time_step");
  start({row0, result.row});
}

void RowStepper::step() { impl_->step(); }
std::int64_t RowStepper::newest() const { return impl_->n; }
std::vector<double> RowStepper::row(int back) const { return impl_->rows.row(impl_->n - back); }
double RowStepper::residual() const { return impl_->residual(); }
int RowStepper::iterations() const { return impl_->iterations; }
const RowLayout* RowStepper::layout() const { return &impl_->layout(); }
Window RowStepper::window(int rows) const { return impl_->rows.window(impl_->n - rows + 1, impl_->n); }
const double* RowStepper::row_data(int back, int a) const { return impl_->rows.y(impl_->n - back, a); }
const double* RowStepper::newest_increment(int a) const { return impl_->rows.v(impl_->n, a); }
std::string RowStepper::solver_name() const { return impl_->equations.solver().name(); }
bool RowStepper::iterates() const { return impl_->iterative; }
bool RowStepper::matrix_free() const { return impl_->equations.matrix_free(); }

std::size_t RowStepper::bytes() const {
  const Impl& s = *impl_;
  return s.rows.row_bytes() + s.rows.increment_bytes() + s.equations.output_bytes() + s.equations.matrix_bytes() +
         s.equations.work_bytes();
}

std::string RowStepper::memory_report() const {
  const Impl& s = *impl_;
  return fmt::format("rows of the field {} B, increments {} B, nonlinear terms {} B, matrix {} B, work space {} B",
                     s.rows.row_bytes(), s.rows.increment_bytes(), s.equations.output_bytes(),
                     s.equations.matrix_bytes(), s.equations.work_bytes());
}

}  // namespace delf
