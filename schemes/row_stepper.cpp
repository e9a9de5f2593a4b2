// SPDX-License-Identifier: MIT
#include "schemes/row_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lattice/error.hpp"
#include "schemes/contraction.hpp"
#include "schemes/flush_denormals.hpp"
#include "schemes/newton.hpp"
#include "schemes/row_equations_step.hpp"
#include "schemes/row_seed.hpp"
#include "schemes/row_team.hpp"
#include "schemes/seen_contraction.hpp"
#include "schemes/time_tiles.hpp"
#include "schemes/wrapped_differences.hpp"

namespace delf {

struct RowStepper::Impl {
  const LatticeSystem& system;
  const SolvePlan& plan;
  const StepOptions options;
  const int d, history, rows_held;
  const bool iterative;
  const double tolerance;
  /// The smallest tolerances ask for all that rounding allows: there nothing is left to an estimate.
  const bool estimates;
  static constexpr double smallest_estimated = 0.99e-13;
  std::optional<Contraction> contraction;  ///< of an iteration
  const bool stiff;
  const std::optional<Mixture> mixture;  ///< that is extrapolated in the place of y
  SectionRows rows;
  RowEquations equations;
  RowSeed seed;
  std::optional<RowTeam> team;
  bool can_go_in_place = false;
  double gain = 0, weight = 1;  ///< of the equations, for contraction
  double contracted = -1;       ///< by which one more iteration's change would be less; negative: not known yet
  SeenContraction seen;         ///< of steps from extrapolated outputs, since the seed's last look
  bool straight_is_enough = true;  ///< for one iteration, since then
  std::int64_t arguments_until = -1;  ///< the newest row whose arguments are there, with those that a seed reads

  std::int64_t n = -1;         ///< newest row
  double largest[2] = {0, 0};  ///< |y| of the newest two rows
  double largest_ever = 0;     ///< |y| of all rows since the start, where steps find it; others in one loop find
  double squares_ever = 0;     ///< Σy² of each row: the largest since the start
  int iterations = 0;
  int rows_known = 0;  ///< newest rows that have not been written over
  std::vector<double> squares_of_parts;
  /// A row that lies beside the one that steps in place write over, with all that a step needs; −1: none. What was
  /// known when it was the newest.
  std::int64_t kept_row = -1, kept_overwritten = 0;
  double kept_largest[2] = {0, 0};
  static constexpr std::int64_t steps_between = 1024;  ///< that are in place: as many may have to be taken again

  Impl(const LatticeSystem& s, const SolvePlan& p, const StepOptions& o)
      : system(s),
        plan(p),
        options(o),
        d(s.components()),
        history(std::max(p.forward + p.backward, 2)),
        rows_held(history + 1),
        iterative(!solved_at_once(s, p)),
        tolerance(std::max(o.tolerance, 4 * std::numeric_limits<double>::epsilon())),
        estimates(o.tolerance >= smallest_estimated),
        contraction(iterative ? std::optional(Contraction(s, p)) : std::nullopt),
        stiff(iterative && contraction->is_stiff()),
        mixture(iterative && RowSeed::fits_cache(s.lattice().sites()) ? Mixture::of(s) : std::nullopt),
        rows(s, std::max(1, s.width()), rows_held, increments(), o.turn),
        equations(s, p, rows, history, mixture, seed_rows()),
        seed(rows, s.time_step(), seed_rows(), equations.looks(), equations.arguments()) {
    // Made now, so that memory that is short is told at the start.
    const bool goes_in_one = equations.is_streamed() || equations.goes_straight();
    if (equations.reads_unknown_row() && !(iterative && goes_in_one)) equations.candidate().hold_whole();
    if (iterative) gain = equations.gain(), weight = equations.least_weight();
    can_go_in_place = iterative && !stiff && equations.can_go_in_place();
    if (o.threads > 1 && equations.is_one_loop())
      team.emplace(o.threads), squares_of_parts.resize(static_cast<std::size_t>(o.threads));
    if (o.fibre != Fibre::circle) equations.tile(loop_parts());
  }

  int seed_rows() const { return iterative ? RowSeed::rows_for(options.seed_order, system.lattice().sites()) : 2; }
  /// The new one too; and where steps in place may be followed by one that is not, that of the kept row besides.
  int increments() const {
    const int read = std::max(history - 1, mixture ? 1 : seed_rows());
    return (iterative && !RowSeed::fits_cache(system.lattice().sites()) ? std::max(read, 2) : read) + 1;
  }
  const RowLayout& layout() const { return rows.layout(); }

  void step(bool looked_at) {
    const FlushDenormals guard;
    iterations = 0;
    looked_at = looked_at || options.fibre == Fibre::circle;  // whose rows are compared
    double value = 0;
    if (equations.is_one_loop()) {
      equations.begin(n);
      if (!loop(looked_at)) report_not_finite();
    } else {
      if (looked_at || !may_step_in_place() || !step_in_place(value)) value = step_beside();
    }
    if (options.fibre == Fibre::circle) check_wrapped_differences(system, rows, n + 1);
    row_is_found(value);
    ++n;
  }
  /// Iterations ask for its largest |y|.
  void row_is_found(double value) {
    largest[1] = largest[0];
    largest[0] = value;
    largest_ever = std::max(largest_ever, value);
    rows_known = std::min(rows_known + 1, rows_held);
  }

  /// A step that leaves the row before it where it is.
  double step_beside() {
    equations.begin(n);
    equations.evaluate_known_outputs();
    double value = 0;
    if (!iterative || stiff || !iterate(value)) value = step_without_iterations();
    if (can_go_in_place && iterations == 1) keep();
    else kept_row = -1;
    return value;
  }
  [[gnu::noinline]] double step_without_iterations() {
    if (iterative && rows_known < history) {
      step_again();
      equations.begin(n);
    }
    const double value = iterative ? follow_root() : solve_once();
    if (overflowed(value)) report_not_finite();
    return value;
  }

  /// Neither the next step nor the seed's next look reads rows that a step in place would write over.
  bool may_step_in_place() const { return kept_row >= 0 && n != kept_row && seed.reads_one_increment(n); }
  /// An implicit step in one stream through the rows, written over the old ones: these would else come from memory, and
  /// the new ones too. False if it would take a second iteration: nothing is changed then. Out of line, as all
  /// that steps through short rows do without: they would save registers and align the stack for it.
  [[gnu::noinline]] bool step_in_place(double& value) {
    equations.begin_in_place(n);
    rows_known = 0;
    const RowChange moved = advance_straight();
    const double next_change = contraction_now();
    iterations = 1;
    value = moved.largest;
    if (!overflowed(value) && is_enough(moved.change, next_change, value)) {
      rows.overwrite_newest();
      return true;
    }
    iterations = 0;
    step_again();
    return false;
  }

  /// The steps from the kept row on once more, each beside the row before. They took one iteration.
  void step_again() {
    const std::int64_t last = n;
    go_back();
    for (; n < last; ++n) {
      equations.begin(n);
      row_is_found(advance_straight().largest);
    }
    kept_row = -1;
  }
  void go_back() {
    n = kept_row;
    rows.restore(kept_overwritten);
    std::ranges::copy(kept_largest, largest);
    rows_known = 1;
  }
  /// Before row_is_found().
  void keep() {
    kept_row = n;
    kept_overwritten = rows.overwritten();
    std::ranges::copy(largest, kept_largest);
  }

  /// An explicit step of one loop; in place if no one looks at the row. False if the row overflows.
  /// Rows that are written over are gone. But a step that is not in place leaves the row before it where it is, until
  /// two more of its kind have been taken: at every time two good rows are there, or follow from that one.
  bool loop(bool looked_at) {
    const bool in_place = !looked_at && kept_row >= 0 && n > kept_row && n < kept_row + steps_between;
    if (in_place) rows_known = 0;
    bool fine = loop_in_parts(in_place);
    if (!fine) {
      if (rows_known < 2) fine = loop_again();
      kept_row = -1;  // from here on nothing is written over
    } else if (!in_place) {
      keep();
    }
    return fine;
  }

  /// Steps that no one looks at: explicit ones several at once where rows outgrow the cache.
  void steps(int count) {
    while (count > 0) {
      const std::int64_t room = kept_row >= 0 && n > kept_row ? kept_row + steps_between - n : 0;
      const int levels = static_cast<int>(
          std::min<std::int64_t>({equations.is_tiled() ? TimeTiles::most_levels : 1, count, room}));
      if (levels > 1) take_levels(levels);
      else step(false);
      count -= std::max(levels, 1);
    }
  }
  /// If one of them fails, those before it are taken again, each beside the row before.
  void take_levels(int levels) {
    const FlushDenormals guard;
    iterations = 0;
    double squares[TimeTiles::most_levels];
    const std::span<double> of_levels(squares, static_cast<std::size_t>(levels));
    equations.begin(n);
    const bool fine = equations.loop_levels(of_levels, squares_ever, team ? &*team : nullptr) &&
                      !squares_overflowed(std::ranges::max(of_levels));
    n += levels - 1;
    rows_known = 0;
    if (fine) {
      squares_ever = std::max(squares_ever, std::ranges::max(of_levels));
    } else {
      const bool is_found = loop_again();
      kept_row = -1;
      if (!is_found) report_not_finite();
    }
    row_is_found(0);
    ++n;
  }

  /// As many threads as there are rows enough for.
  int loop_parts() const {
    constexpr int worth_a_thread = 1024;  // packs: below, waiting for each other costs more than it saves
    return team ? std::clamp(layout().packs() / worth_a_thread, 1, team->size()) : 1;
  }
  bool loop_in_parts(bool in_place) {
    const int parts = loop_parts();
    equations.begin_loop(parts, in_place, squares_ever);
    double squares = 0;
    if (parts == 1) {
      squares = equations.loop(0, 1);
    } else {
      team->run(parts,
                [&](int part) { squares_of_parts[static_cast<std::size_t>(part)] = equations.loop(part, parts); });
      for (int part = 0; part < parts; ++part) squares += squares_of_parts[static_cast<std::size_t>(part)];
    }
    equations.close_loop();
    squares_ever = std::max(squares_ever, squares);
    return !squares_overflowed(squares);
  }

  /// The steps from the kept row on once more, each beside the row before.
  bool loop_again() {
    const std::int64_t last = n;
    go_back();
    equations.forget_rows();
    for (;; ++n) {
      equations.begin(n);
      const bool fine = loop_in_parts(false);
      if (n == last || !fine) return fine;
      row_is_found(0);
    }
  }

  /// The unknown row enters linearly, with known coefficients: one solve, from any candidate. Outputs that were read from
  /// the candidate are part of what the next step knows: take them again.
  double solve_once() {
    const bool reads_candidate = equations.reads_unknown_row();
    if (reads_candidate) {
      take_seed(1);
      equations.evaluate_unknown_outputs(RowEquations::At::candidate);
    }
    const double value = equations.advance(false).largest;
    if (reads_candidate) equations.evaluate_unknown_outputs(RowEquations::At::row);
    return value;
  }

  void take_seed(int order) {
    if (!equations.candidate().is_whole()) equations.candidate().hold_whole();
    seed.find(n, order, equations.candidate().rows());
    if (equations.correction_form()) take_increment_of_candidate();
  }
  /// What w corrects.
  [[gnu::noinline]] void take_increment_of_candidate() {
    for (int a = 0; a < d; ++a) {
      double* const v = rows.v(n + 1, a);
      const double *y = equations.candidate().row(a), *before = rows.y(n, a);
      for (std::size_t s = 0; s < layout().doubles(); ++s) v[s] = y[s] - before[s];
    }
  }

  /// What the tolerance allows: relative to what the field spans, for where it has drifted to says nothing, but not below
  /// what rounding leaves at its size.
  double allowed(double size) const {
    const double span = seed.span() > 0 ? std::min(seed.span(), size) : size;
    return std::max(tolerance * span, 4 * std::numeric_limits<double>::epsilon() * size);
  }

  /// By which one more iteration's change would be less.
  double contraction_now() {
    if (contracted < 0 || contraction->is_outgrown(largest[0]))
      contracted = contraction->next_change(largest[0], weight, gain);
    return contracted;
  }
  /// One more iteration would change the row by no more than what it makes of the last change.
  bool is_enough(double change, double next_change, double value) const {
    const double enough = allowed(std::max({value, largest[0], largest[1]}));
    return change <= weight * enough || (estimates && next_change * change <= enough);
  }

  [[gnu::noinline]] RowChange advance_streamed(int order) {
    return equations.advance_streamed(
        [this, order](PackRange packs) { seed.find(n, order, equations.candidate().rows(), packs); });
  }
  /// From a seed of order 1, rows that outgrow the cache.
  RowChange advance_straight() {
    return equations.goes_straight() ? equations.advance_straight(largest_ever) : advance_streamed(1);
  }
  /// From the seed. Where one iteration is not enough, it is the outputs that are extrapolated: the row made from these is
  /// as good as from outputs evaluated where they are expected to look, and spares that.
  RowChange advance_first() {
    if (!mixture) return advance_seeded(seed.order());
    if (goes_straight()) {
      const RowChange moved = equations.advance_straight(largest_ever);
      if (overflowed(moved.largest) || is_enough(moved.change, contraction_now(), moved.largest)) return moved;
      straight_is_enough = false;
    }
    if (arguments_until != n) equations.find_arguments();
    arguments_until = n + 1;
    if (extrapolates_outputs()) return advance_from_outputs();
    return equations.advance_extrapolated(seed.order(), largest_ever);
  }
  /// Along straight lines no rows of arguments are read, and none are made: the seed's next look asks for those of some
  /// steps before it.
  bool goes_straight() const { return straight_is_enough && equations.goes_straight() && seed.reads_one_increment(n); }
  bool extrapolates_outputs() const {
    return mixture && seed.order_of_outputs() > 0 && equations.can_extrapolate_outputs(seed.order_of_outputs());
  }
  [[gnu::noinline]] RowChange advance_from_outputs() {
    return advance_again(equations.advance_from_outputs(seed.order_of_outputs()));
  }
  [[gnu::noinline]] RowChange advance_seeded(int order) {
    if (order == 1 && equations.goes_straight()) return equations.advance_straight(largest_ever);
    if (equations.is_streamed()) return advance_streamed(order);
    take_seed(order);
    return advance_from_candidate();
  }
  /// `value`: the largest |y| of the row that was found.
  RowChange advance_again(double value) {
    if (mixture) return equations.advance_again(std::max(largest_ever, value));
    if (equations.is_streamed()) return equations.advance_streamed({});
    return advance_from_candidate();
  }
  RowChange advance_from_candidate() {
    equations.evaluate_unknown_outputs(RowEquations::At::candidate);
    return equations.advance(true);
  }

  /// Simplified Newton with the constant part. False when it does not contract, or not fast enough. One iteration is
  /// what most steps take.
  bool iterate(double& value) {
    const double next_change = contraction_now();
    if (seed.choose(n, tolerance, next_change, estimates ? next_change : 1 / weight))
      seen.forget(), straight_is_enough = true;
    iterations = 1;
    const RowChange moved = advance_first();
    value = moved.largest;
    // A field that overflowed has no root to look for.
    if (overflowed(value)) report_not_finite();
    return is_enough(moved.change, next_change, value) ||
           (seen.is_like(moved.change) && is_enough(moved.change, seen.next_change(), value)) ||
           iterate_on(value, moved.change, next_change);
  }
  /// After the first, whose change was not small enough.
  [[gnu::noinline]] bool iterate_on(double& value, double change, double next_change) {
    if (rows_known < history && equations.looks_back()) {  // straight lines did not have to
      step_again();
      equations.begin(n);
      change = advance_first().change;
    }
    while (iterations < options.max_iterations) {
      const double before = change;
      // Arguments go on by themselves: the row is wanted only where one iteration more may not be the last, or shows what
      // the first one left.
      const bool shows = estimates && iterations == 1 && extrapolates_outputs() && !seen.is_like(change);
      const bool is_row_before_kept =
          !mixture || !estimates || shows || !is_enough(weight * next_change * change, next_change, value);
      if (is_row_before_kept) equations.make_row_the_candidate();
      ++iterations;
      const RowChange moved = advance_again(value);
      value = moved.largest, change = moved.change;
      if (overflowed(value)) report_not_finite();
      if (shows) seen.see(before, equations.whole_change());
      if (is_enough(change, next_change, value)) return true;
      if (estimates && is_row_before_kept) {
        next_change = std::min(next_change, 2 * equations.whole_change() / before);
        if (is_enough(change, next_change, value)) return true;
      }
      // Changes that no longer shrink are rounding, if they are small, or else the fixed point does not contract.
      if (iterations >= 3 && change > 0.25 * before)
        return change <=
               64 * std::numeric_limits<double>::epsilon() * std::max({value, largest[0], largest[1]});
    }
    return false;
  }

  /// Returns the largest |y| of the row found. Out of line, like all that only some steps come to.
  [[gnu::noinline]] double follow_root() {
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
    equations.evaluate_unknown_outputs(RowEquations::At::row);
    double value = 0;
    for (double x : result.row) value = std::max(value, std::abs(x));
    return value;
  }

  [[noreturn, gnu::noinline]] void report_not_finite() {
    // Implicit steps spread an overflow over the whole row: it is where the field was largest. Of long rows Σy² overflows
    // before any value does: it is where the field is largest.
    const std::vector<double> row = rows.row(n + 1), before = rows.row(n);
    const auto fine = [](double x) { return !overflowed(std::abs(x)); };
    const auto largest_of = [](const std::vector<double>& values) {
      return std::ranges::max_element(values, {}, [](double x) { return std::abs(x); }) - values.begin();
    };
    const bool everywhere = std::ranges::none_of(row, fine), nowhere = std::ranges::all_of(row, fine);
    const auto bad = everywhere ? largest_of(before)
                     : nowhere  ? largest_of(row)
                                : std::ranges::find_if_not(row, fine) - row.begin();
    throw NotFinite(
        fmt::format("step {}, t = {:.6g}, site {}: the field is no longer finite: the scheme is unstable here; "
                    "reduce lattice.courant or lattice.time_step, or choose an implicit stencil",
                    n + 1, static_cast<double>(n + 1) * system.time_step(), bad / d));
  }

  void require_rows(int count) const {
    if (count > rows_known)
      throw std::logic_error("delf: rows before the newest were written over by step(false), or not stepped yet");
  }

  double residual() {
    const std::int64_t base = n - 1;
    if (base < history - 1) return 0;
    if (rows_known < 2) return std::numeric_limits<double>::quiet_NaN();
    return equations.residual(base, largest_ever);
  }
};

RowStepper::RowStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : impl_(std::make_unique<Impl>(system, plan, options)) {}
RowStepper::~RowStepper() = default;

int RowStepper::starting_rows() const { return impl_->history; }

void RowStepper::start(const std::vector<std::vector<double>>& rows) {
  Impl& s = *impl_;
  s.rows.restore(0);
  s.equations.forget_rows();
  s.rows_known = std::min(static_cast<int>(rows.size()), s.rows.rows_held());
  s.kept_row = -1;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (double x : rows[r])
      if (overflowed(std::abs(x))) throw NotFinite(fmt::format("row {} of the start is not finite", r));
    s.rows.set_row(static_cast<std::int64_t>(r), rows[r]);
    if (r > 0) s.rows.find_increment(static_cast<std::int64_t>(r));
    s.largest[1] = s.largest[0];
    s.largest[0] = 0;
    for (double x : rows[r]) s.largest[0] = std::max(s.largest[0], std::abs(x));
  }
  s.largest_ever = s.squares_ever = 0;
  for (const auto& row : rows) {
    double squares = 0;
    for (double x : row) squares += x * x, s.largest_ever = std::max(s.largest_ever, std::abs(x));
    s.squares_ever = std::max(s.squares_ever, squares);
  }
  s.n = static_cast<std::int64_t>(rows.size()) - 1;
  s.equations.begin(s.n);
  s.equations.evaluate_outputs();
  s.arguments_until = s.n;
  s.seed.restart();
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

void RowStepper::step(bool looked_at) { impl_->step(looked_at); }
void RowStepper::steps(int count) { impl_->steps(count); }
int RowStepper::steps_at_once() const { return impl_->equations.is_tiled() ? TimeTiles::most_levels : 1; }
std::int64_t RowStepper::newest() const { return impl_->n; }
std::vector<double> RowStepper::row(int back) const {
  impl_->require_rows(back + 1);
  return impl_->rows.row(impl_->n - back);
}
double RowStepper::residual() const { return impl_->residual(); }
int RowStepper::iterations() const { return impl_->iterations; }
const RowLayout* RowStepper::layout() const { return &impl_->layout(); }
Window RowStepper::window(int rows) const {
  impl_->require_rows(rows);
  return impl_->rows.window(impl_->n - rows + 1, impl_->n);
}
const double* RowStepper::row_data(int back, int a) const {
  impl_->require_rows(back + 1);
  return impl_->rows.y(impl_->n - back, a);
}
void RowStepper::newest_pair(const double** rows) const {
  Impl& s = *impl_;
  s.require_rows(2);
  for (int a = 0; a < s.d; ++a) {
    double* const v = s.rows.v(s.n, a);
    s.layout().fill_first_after(v);  // a loop leaves it
    rows[a] = s.rows.y(s.n - 1, a), rows[s.d + a] = v;
  }
}
double RowStepper::largest_value() const {
  const double largest = impl_->equations.is_one_loop() ? std::sqrt(impl_->squares_ever) : impl_->largest_ever;
  return largest + std::abs(impl_->options.turn);  // across the seam
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
  return impl_->equations.bytes_to_come(impl_->loop_parts(), residual);
}

std::string RowStepper::memory_report(bool residual) const {
  const Impl& s = *impl_;
  return fmt::format("rows of the field {} B, increments {} B, nonlinear terms {} B, matrix {} B, work space {} B",
                     s.rows.row_bytes(), s.rows.increment_bytes(), s.equations.output_bytes(),
                     s.equations.matrix_bytes(), s.equations.work_bytes() + bytes_to_come(residual));
}

}  // namespace delf
