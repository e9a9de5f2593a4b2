// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/error.hpp"
#include "schemes/stepping/rows/explicit_steps.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/rows/implicit_steps.hpp"
#include "schemes/system/wrapped_differences.hpp"

namespace delf {

struct RowStepper::Impl {
  const LatticeSystem& system;
  const SolvePlan& plan;
  const StepOptions options;
  const int d, history;
  const bool iterative, fits_cache;
  const int seed_rows;
  const std::optional<Mixture> mixture;  ///< that is extrapolated in the place of y
  SectionRows rows;
  RowEquations equations;
  SteppedRows at;
  ExplicitSteps explicit_steps;
  ImplicitSteps implicit_steps;

  Impl(const LatticeSystem& s, const SolvePlan& p, const StepOptions& o)
      : system(s),
        plan(p),
        options(o),
        d(s.components()),
        history(std::max(p.forward + p.backward, 2)),
        iterative(!solved_at_once(s, p)),
        fits_cache(RowSeed::fits_cache(s.lattice().sites())),
        seed_rows(iterative ? RowSeed::rows_for(o.seed_order, s.lattice().sites()) : 2),
        mixture(iterative && fits_cache ? Mixture::of(s) : std::nullopt),
        rows(s, std::max(1, s.width()), history + 1, increments(), o.turn),
        equations(s, p, rows, history, mixture, seed_rows),
        at{rows, s.time_step()},
        explicit_steps(at, equations, o.threads),
        implicit_steps(at, equations, s, p, options, history, iterative, seed_rows) {
    if (o.fibre != Fibre::circle) equations.tile(explicit_steps.parts());
  }

  /// The new one too; and where steps in place may be followed by one that is not, that of the kept row besides.
  int increments() const {
    const int read = std::max(history - 1, mixture ? 1 : seed_rows);
    return (iterative && !fits_cache ? std::max(read, 2) : read) + 1;
  }

  void step(bool looked_at) {
    const FlushDenormals guard;
    at.iterations = 0;
    looked_at = looked_at || options.fibre == Fibre::circle;  // whose rows are compared
    double value = 0;
    if (!equations.is_one_loop()) value = implicit_steps.step(looked_at);
    else if (!explicit_steps.step(looked_at)) at.report_not_finite();
    if (options.fibre == Fibre::circle) check_wrapped_differences(system, rows, at.n + 1);
    at.row_is_found(value);
    ++at.n;
  }

  /// Steps that no one looks at.
  void steps(int count) {
    while (count > 0) {
      const int levels = explicit_steps.levels(count);
      if (levels > 1) {
        const FlushDenormals guard;
        at.iterations = 0;
        explicit_steps.step_at_once(levels);
      } else {
        step(false);
      }
      count -= std::max(levels, 1);
    }
  }

  double residual() {
    const std::int64_t base = at.n - 1;
    if (base < history - 1) return 0;
    if (at.known < 2) return std::numeric_limits<double>::quiet_NaN();
    return equations.residual(base, at.largest_ever);
  }
};

RowStepper::RowStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : impl_(std::make_unique<Impl>(system, plan, options)) {}
RowStepper::~RowStepper() = default;

int RowStepper::starting_rows() const { return impl_->history; }

void RowStepper::start(const std::vector<std::vector<double>>& rows) {
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (double x : rows[r])
      if (overflowed(std::abs(x))) throw NotFinite(fmt::format("row {} of the start is not finite", r));
  Impl& s = *impl_;
  s.at.start(rows);
  s.equations.forget_rows();
  s.equations.begin(s.at.n);
  s.equations.evaluate_outputs();
  s.implicit_steps.restart();
}

void RowStepper::start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) {
  Impl& s = *impl_;
  if (s.history != 2)
    throw BadInput("initial.start", "initial.start = centred makes one more row, and this stencil needs " +
                                        std::to_string(s.history) + " starting rows; choose initial.start = exact");
  const Window first{&s.system.lattice(), s.d, s.options.turn, 0, {row0}};
  const NewtonResult result =
      solve_centred_start(s.system, s.plan, first, velocity, s.implicit_steps.is_stiff(), s.options.tolerance,
                          s.options.max_iterations);
  if (!result.converged)
    throw NoConvergence(
        "the starting row of initial.start = centred was not found: Newton's method did not converge; "
        "reduce lattice.courant or lattice.time_step");
  start({row0, result.row});
}

void RowStepper::step(bool looked_at) { impl_->step(looked_at); }
void RowStepper::steps(int count) { impl_->steps(count); }
int RowStepper::steps_at_once() const { return impl_->equations.is_tiled() ? TimeTiles::most_levels : 1; }
std::int64_t RowStepper::newest() const { return impl_->at.n; }
std::vector<double> RowStepper::row(int back) const {
  impl_->at.require(back + 1);
  return impl_->rows.row(impl_->at.n - back);
}
double RowStepper::residual() const { return impl_->residual(); }
int RowStepper::iterations() const { return impl_->at.iterations; }
const RowLayout* RowStepper::layout() const { return &impl_->rows.layout(); }
Window RowStepper::window(int rows) const {
  impl_->at.require(rows);
  return impl_->rows.window(impl_->at.n - rows + 1, impl_->at.n);
}
const double* RowStepper::row_data(int back, int a) const {
  impl_->at.require(back + 1);
  return impl_->rows.y(impl_->at.n - back, a);
}
double RowStepper::newest_pair(const double** rows) const {
  Impl& s = *impl_;
  s.at.require(2);
  for (int a = 0; a < s.d; ++a) {
    double* const v = s.rows.v(s.at.n, a);
    s.rows.layout().fill_first_after(v);  // a loop leaves it
    rows[a] = s.rows.y_before(s.at.n, a), rows[s.d + a] = s.rows.y(s.at.n, a), rows[2 * s.d + a] = v;
  }
  const double largest = s.equations.is_one_loop() ? std::sqrt(s.at.squares_ever) : s.at.largest_ever;
  return largest + std::abs(s.options.turn);  // across the seam
}
std::string RowStepper::solver_name() const { return impl_->equations.solver().name(); }
bool RowStepper::iterates() const { return impl_->iterative; }
bool RowStepper::matrix_free() const { return impl_->equations.matrix_free(); }

std::size_t RowStepper::bytes() const {
  const Impl& s = *impl_;
  return s.rows.row_bytes() + s.rows.increment_bytes() + s.equations.output_bytes() + s.equations.matrix_bytes() +
         s.equations.work_bytes();
}

std::size_t RowStepper::bytes_to_come(bool residual) const {
  return impl_->equations.bytes_to_come(impl_->explicit_steps.parts(), residual);
}

std::string RowStepper::memory_report(bool residual) const {
  const Impl& s = *impl_;
  return fmt::format("rows of the field {} B, increments {} B, nonlinear terms {} B, matrix {} B, work space {} B",
                     s.rows.row_bytes(), s.rows.increment_bytes(), s.equations.output_bytes(),
                     s.equations.matrix_bytes(), s.equations.work_bytes() + bytes_to_come(residual));
}

}  // namespace delf
