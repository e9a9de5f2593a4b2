// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/newton.hpp"
#include "schemes/stepping/rows/kept_rows.hpp"
#include "schemes/stepping/rows/predictor.hpp"
#include "schemes/stepping/rows/step_tolerance.hpp"
#include "schemes/stepping/rows/wrapped_differences.hpp"
#include "schemes/stepping/slab_stepper.hpp"
#include "schemes/stepping/thread_team.hpp"

namespace delf {
namespace {

constexpr double round_off = std::numeric_limits<double>::epsilon();
// Strips that stay in the first level of the cache; in the second one where a solve follows a recurrence strip by strip.
constexpr int short_strip = 64, long_strip = 1024;
constexpr int packs_of_a_thread = 1024;
constexpr std::size_t most_components = 32;

using Pointers = std::array<double*, most_components>;

}  // namespace

/// A step, in which the source terms g at row n + 1 are the one thing that is iterated:
///
///     predict    g ≈ Σ_j (−1)^{j+1} C(p, j) g_{n+1−j}
///     solve      A₊ w = −(linear part) − r(0) − Σ hk weight · g
///     update     v_{n+1} = v_n + w,   y_{n+1} = y_n + v_{n+1}
///     evaluate   g′ = ∂ℓ/∂φ at the quadrature values of y_{n+1}, and δ = g′ − g
///     test       what δ would change y by is below the tolerance: done; else
///     correct    A₊ δw = −Σ hk weight · δ,   v_{n+1} += δw,   y_{n+1} += δw,   g = g′, and evaluate again
///
/// Where no source term depends on row n + 1, evaluate, solve and update are all. Rows are passed strip by strip.
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
  std::vector<std::unique_ptr<Sweeps>> sweeps;  ///< of each component; none: the solver takes whole rows
  std::optional<StepTolerance> tolerance;  ///< if equations iterate
  std::optional<ThreadTeam> team;
  std::vector<double> changes;  ///< of each source row: the largest |δ|
  RowBuffer work;               ///< right sides, which solutions take the place of
  int strip = 0, lag = 0;       ///< packs; and how many the update stays behind right sides
  bool has_local = false, forms_directly = false, solves_whole = true, sweeps_along = false, goes_in_place = false;

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
        most_rows(Predictor::rows_for(o.seed_order, s.lattice().sites())),
        layout(s.lattice(), std::max(1, s.width()), s.placement() == Placement::brick_wall ? 2 : 1),
        equations(s, p, layout, table, history, most_rows),
        kept(s, layout, equations, table, history, o.turn),
        predictor(equations, layout, most_rows) {
    if (d > static_cast<int>(most_components)) throw NoConvergence("rows of so many components go slab by slab");
    choose_strips();
    if (!equations.iterates()) return;
    tolerance.emplace(system, equations, layout, table, options);
    changes.assign(tolerance->gains().size(), 0.0);
  }

  void choose_strips() {
    const auto& sources = equations.sources();
    if (!equations.has_walls() &&
        std::ranges::all_of(sources, [](const SourceRow& row) { return row.reads_unknown || row.is_local; }))
      for (int a = 0; a < d; ++a) sweeps.push_back(equations.solver(0).sweeps(a));
    if (std::ranges::any_of(sweeps, [](const auto& one) { return !one; })) sweeps.clear();
    int warm_up = 0;
    if (!sweeps.empty()) {
      const PackRange first = sweeps[0]->warm_up();
      warm_up = first.last - first.first;
      // Components that advance by other strips would have to wait for each other.
      if (std::ranges::any_of(sweeps, [&](const auto& one) {
            return one->warm_up().first != first.first || one->takes_whole_rows() != sweeps[0]->takes_whole_rows();
          }))
        sweeps.clear();
    }
    solves_whole = sweeps.empty() || sweeps[0]->takes_whole_rows();
    sweeps_along = !sweeps.empty() && (solves_whole || warm_up > 0);
    strip = sweeps.empty() ? layout.packs() : warm_up > 0 ? long_strip : short_strip;
    lag = std::max(warm_up, equations.reach());
    const bool is_long = !solves_whole && layout.packs() > 4 * long_strip;
    const int packs = solves_whole ? layout.packs() : std::min(layout.packs(), longest_strip() + 2 * lag);
    has_local = std::ranges::any_of(sources, &SourceRow::is_local);
    // Where the matrix is a number and row n stays, right sides are used as they are formed.
    forms_directly = !sweeps.empty() && !sweeps_along && equations.right_side(0, {});
    if (!forms_directly || is_long) work = RowBuffer(static_cast<std::size_t>(packs) * lanes, d);
    goes_in_place = !solves_whole && history == 2 && equations.reads_newest_alone() && options.fibre == Fibre::real &&
                    is_long && (warm_up == 0 || warm_up > equations.reach());
    const int parts = std::min(options.threads, layout.packs() / packs_of_a_thread);
    if (solves_whole || equations.iterates() || parts < 2) return;
    team.emplace(parts);
    goes_in_place = false;
  }

  std::int64_t n() const { return kept.newest(); }

  int longest_strip() const { return strip == long_strip ? 2 * strip : strip; }

  // ---- One pass over the row, strip by strip.

  enum class Kind { step, correction };

  /// Source terms of the packs from … to, of which no rows are kept.
  void find_sources(RowTable& rows, const ScratchRows& local, int from, int to) const {
    for (std::size_t s = 0; s < equations.sources().size(); ++s) {
      const SourceRow& source = equations.sources()[s];
      if (!source.is_local) continue;
      rows[source.ring.row(0)] = local[static_cast<int>(s)] - layout.at(from);
      if (source.component + 1 == source.outputs)
        evaluate(rows, s + 1 - static_cast<std::size_t>(source.outputs), from, to);
    }
  }
  /// A group of source terms, into number 0 of their rings.
  void evaluate(const RowTable& rows, std::size_t first, int from, int to, int back = 0) const {
    Pointers out;
    const SourceRow& source = equations.sources()[first];
    for (int c = 0; c < source.outputs; ++c)
      out[static_cast<std::size_t>(c)] = rows[equations.sources()[first + static_cast<std::size_t>(c)].ring.row(back)];
    equations.evaluate(rows, n(), source, back, from, to, out.data());
  }

  /// The same in whole rows, with their halos.
  void evaluate_rows(std::size_t first, int back = 0) {
    evaluate(table, first, 0, layout.packs(), back);
    for (int c = 0; c < equations.sources()[first].outputs; ++c)
      layout.fill_halo(table[equations.sources()[first + static_cast<std::size_t>(c)].ring.row(back)]);
  }

  /// v_{n+1} and y_{n+1} from w, pack by pack; of a correction, from what they were.
  struct Update {
    const double *v, *y;
    double *new_v, *new_y;
    Pack of_increment, of_change, largest;
    Update(const RowEquations& equations, const RowTable& rows, Kind kind, int a, Pack found)
        : v(rows[equations.v().row(kind == Kind::step ? 1 : 0, a)]),
          y(rows[equations.y().row(kind == Kind::step ? 1 : 0, a)]),
          new_v(rows[equations.v().row(0, a)]),
          new_y(rows[equations.y().row(0, a)]),
          of_increment(kind == Kind::step ? 1.0 : 0.0),
          of_change(kind == Kind::step ? 0.0 : 1.0),
          largest(found) {}
    [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) {
      const Pack increment = Pack::load(v + at) + w;
      const Pack value = Pack::load(y + at) + (of_increment * increment + of_change * w);
      increment.store(new_v + at);
      value.store(new_y + at);
      largest = largest_magnitude(largest, value);
    }
  };
  [[gnu::noinline]] void update(const RowTable& rows, Kind kind, int a, const double* w, PackRange packs,
                                Pack& found) const {
    Update made(equations, rows, kind, a, found);
    const std::ptrdiff_t end = layout.at(packs.last);
    for (std::ptrdiff_t at = layout.at(packs.first); at < end; at += lanes) made(at, Pack::load(w + at));
    found = made.largest;
  }
  /// The same where w is the right side.
  [[gnu::noinline]] void update(const RowTable& rows, Kind kind, int a, const RowSum& w, PackRange packs,
                                Pack& found) const {
    Update made(equations, rows, kind, a, found);
    w.pass<lanes>(rows.data(), layout.at(packs.first), layout.at(packs.last), made);
    found = made.largest;
  }

  /// δ = g′ − g, pack by pack: g is what the right side took.
  struct Compare {
    const double* now;
    double *g, *delta;  ///< delta: null where δ is not kept
    Pack most = 0.0;
    [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack taken) {
      const Pack value = Pack::load(now + at), change = value - taken;
      most = largest_magnitude(most, change);
      if (delta) change.store(delta + at);
      value.store(g + at);
    }
  };
  /// g′ of the packs from … to, and how much they have changed; g′ takes the place of g.
  void compare(const RowTable& rows, Kind kind, int from, int to) {
    for (std::size_t first = 0; first < equations.sources().size();
         first += static_cast<std::size_t>(equations.sources()[first].outputs)) {
      const SourceRow& source = equations.sources()[first];
      if (!source.reads_unknown) continue;
      const ScratchRows scratch(source.outputs, short_strip * lanes);
      for (int begin = from; begin < to; begin += short_strip) {
        const int end = std::min(to, begin + short_strip);
        Pointers out;
        for (int c = 0; c < source.outputs; ++c) out[static_cast<std::size_t>(c)] = scratch[c] - layout.at(begin);
        equations.evaluate(rows, n(), source, 0, begin, end, out.data());
        const int own = source.stride == 2 ? begin + static_cast<int>((begin + n() + source.newest) & 1) : begin;
        for (int c = 0; c < source.outputs; ++c) {
          const std::size_t s = first + static_cast<std::size_t>(c);
          const SourceRow& one = equations.sources()[s];
          Compare sink{out[static_cast<std::size_t>(c)], rows[one.ring.row(0)],
                       keeps(kind) ? rows[one.change] : nullptr};
          const RowSum& taken = equations.prediction(one, taking(kind).predicted_from);
          if (one.stride == 1) taken.pass<lanes>(rows.data(), layout.at(own), layout.at(end), sink);
          else taken.pass<2 * lanes>(rows.data(), layout.at(own), layout.at(end), sink);
          changes[s] = larger_or_nan(max_or_nan(sink.most), changes[s]);
        }
      }
    }
  }
  /// A correction takes what the source terms have changed by, and compares with what they are.
  RowEquations::Taking taking(Kind kind) const {
    if (kind == Kind::correction) return {0, true};
    return {equations.iterates() && source_rows_there > 0 ? predictor.order() : 0, false};
  }

  /// The strips of the packs from … to, of which those of a thread are one part. `compares`: source terms are evaluated at
  /// what has been made. `found`: the largest |y|.
  void pass(RowTable& rows, Kind kind, bool compares, RowBuffer& memory, int from, int to, Pack& found) {
    const ScratchRows local(has_local ? static_cast<int>(equations.sources().size()) : 0,
                            std::min(longest_strip(), layout.packs()) * lanes);
    Pointers w{};
    const auto window = [&](int begin) {
      for (int a = 0; a < memory.rows(); ++a) w[static_cast<std::size_t>(a)] = memory.row(a) - layout.at(begin);
    };
    int left = 0, right = 0;
    for (const SourceRow& source : equations.sources())
      if (source.reads_unknown) left = std::min(left, source.left), right = std::max(right, source.right);
    PackRange made{from, from}, compared{from, from};
    // Rows that stay in the cache are compared when all of them is there.
    const bool compares_on_the_way = compares && layout.packs() > 2 * short_strip;
    const auto compare_inside = [&] {
      if (!compares_on_the_way) return;
      const PackRange there{made.first - left, made.last - right};
      if (there.first >= there.last) return;
      if (compared.first == compared.last) compared = {there.first, there.first};
      if (there.first < compared.first) compare(rows, kind, there.first, compared.first);
      if (there.last > compared.last) compare(rows, kind, compared.last, there.last);
      compared = {std::min(there.first, compared.first), std::max(there.last, compared.last)};
    };
    const bool is_direct = forms_directly && !kept.in_place();
    const auto finish = [&](PackRange packs) {
      if (packs.first >= packs.last) return;
      for (int a = 0; a < d; ++a) {
        if (is_direct) update(rows, kind, a, *equations.right_side(a, taking(kind)), packs, found);
        else update(rows, kind, a, w[static_cast<std::size_t>(a)], packs, found);
      }
      if (made.first == made.last) made = packs;
      else made = {std::min(made.first, packs.first), std::max(made.last, packs.last)};
      compare_inside();
    };

    if (!sweeps.empty() && sweeps[0]->warm_up().first < sweeps[0]->warm_up().last) {
      const PackRange last = sweeps[0]->warm_up();
      window(last.first);
      if (kind == Kind::step) find_sources(rows, local, last.first, last.last);
      equations.right_sides(rows, n(), taking(kind), last.first, last.last, w.data());
    } else {
      window(from);
    }
    // Threads have parts of the row, and no recurrence.
    const bool is_part = to - from < layout.packs();
    for (int a = 0; a < d && sweeps_along; ++a)
      sweeps[static_cast<std::size_t>(a)]->begin(w[static_cast<std::size_t>(a)]);
    window(from);
    int done = from;
    for (int end = from; end < to;) {
      const int strip_begin = end;
      end = to - end < 2 * strip && strip == long_strip ? to : std::min(to, end + strip);
      if (kind == Kind::step) find_sources(rows, local, strip_begin, end);
      const bool forms_on_the_way = is_direct || (sweeps_along && equations.right_side(0, {}));
      if (!forms_on_the_way) equations.right_sides(rows, n(), taking(kind), strip_begin, end, w.data());
      if (sweeps.empty()) {
        equations.solver(n()).solve(w.data());
        for (int a = 0; a < d; ++a) layout.copy_overlaps(w[static_cast<std::size_t>(a)]);
        finish({from, to});
        break;
      }
      if (sweeps_along) {
        for (int a = 0; a < d; ++a) {
          Sweeps& sweep = *sweeps[static_cast<std::size_t>(a)];
          double* const to_solve = w[static_cast<std::size_t>(a)];
          if (forms_on_the_way) sweep.forward(*equations.right_side(a, taking(kind)), rows.data(), to_solve, end);
          else sweep.forward(to_solve, end);
        }
        // All components advance alike.
        for (;;) {
          PackRange ready{0, 0};
          for (int a = 0; a < d; ++a)
            ready = sweeps[static_cast<std::size_t>(a)]->backward(w[static_cast<std::size_t>(a)]);
          if (ready.first >= ready.last) break;
          done = std::max(done, ready.last);
          finish(ready);
        }
      } else if (is_direct) {
        finish({strip_begin, end});
        done = end;
      } else {
        // Right sides still to come read rows this far back.
        const int ready = end == to ? to : std::max(done, end - lag);
        finish({done, ready});
        done = ready;
      }
      if (solves_whole || is_direct || end == to) continue;
      // What is not used yet moves to the beginning of the window.
      for (int a = 0; a < d; ++a)
        std::memmove(memory.row(a), w[static_cast<std::size_t>(a)] + layout.at(done),
                     static_cast<std::size_t>(layout.at(end) - layout.at(done)) * sizeof(double));
      window(done);
    }
    if (is_part) return;
    close(rows);
    if (!compares) return;
    if (compared.first == compared.last) compared = {from, from};
    compare(rows, kind, from, compared.first);
    compare(rows, kind, compared.last, to);
    for (const SourceRow& source : equations.sources())
      if (source.reads_unknown) {
        layout.fill_halo(rows[source.ring.row(0)]);
        if (keeps(kind)) layout.fill_halo(rows[source.change]);
      }
  }
  bool keeps(Kind kind) const { return kind == Kind::correction || source_rows_there == 0; }

  /// Halos and overlaps of the new row.
  void close(const RowTable& rows) const {
    for (int a = 0; a < d; ++a) {
      double *const y = rows[equations.y().row(0, a)], *const v = rows[equations.v().row(0, a)];
      // Loads wait for slots of theirs that have just been stored alone.
      const bool overlaps_last = layout.halos_come_first();
      if (!overlaps_last) layout.copy_overlaps(v, y);
      layout.fill_halo(y, options.turn);
      if (equations.reads_increments_beside()) layout.fill_halo(v);
      if (overlaps_last) layout.copy_overlaps(v, y);
    }
  }

  /// The largest |y|.
  Pack pass(Kind kind, bool compares) {
    Pack found(0.0);
    std::ranges::fill(changes, 0.0);
    if (!team) {
      pass(table, kind, compares, work, 0, layout.packs(), found);
      return found;
    }
    const int parts = team->size();
    std::vector<RowTable> rows(static_cast<std::size_t>(parts), table);
    std::vector<RowBuffer> memory;
    std::vector<Pack> of_part(static_cast<std::size_t>(parts), Pack(0.0));
    for (int p = 0; p < parts; ++p) memory.emplace_back(static_cast<std::size_t>(work.stride()), work.rows());
    team->run(parts, [&](int p) {
      const auto at = static_cast<std::size_t>(p);
      pass(rows[at], kind, false, memory[at], layout.first_of_part(p, parts), layout.first_of_part(p + 1, parts),
           of_part[at]);
    });
    for (const Pack part : of_part) found = larger_size(found, part);
    close(table);
    return found;
  }

  // ---- A step.

  void begin_step() {
    for (std::size_t s = 0; s < equations.sources().size(); ++s) {
      const SourceRow& source = equations.sources()[s];
      if (source.component == 0 && !source.reads_unknown && !source.is_local) evaluate_rows(s);
    }
    if (!equations.iterates()) return;
    if (source_rows_there == 0) start_from_straight_line();
    else if (predictor.is_due(n())) choose_order();
  }
  /// Where no past source terms are there: those at y_n + v_n.
  void start_from_straight_line() {
    for (int a = 0; a < d; ++a) {
      const double *const y = table[equations.y().row(1, a)], *const v = table[equations.v().row(1, a)];
      double *const new_y = table[equations.y().row(0, a)], *const new_v = table[equations.v().row(0, a)];
      for (std::size_t i = 0; i < layout.doubles(); ++i) new_v[i] = v[i], new_y[i] = y[i] + v[i];
    }
    evaluate_unknown();
  }
  void evaluate_unknown() {
    for (std::size_t s = 0; s < equations.sources().size(); ++s)
      if (equations.sources()[s].component == 0 && equations.sources()[s].reads_unknown) evaluate_rows(s);
  }
  void choose_order() {
    tolerance->see_span(table);
    predictor.choose(table, n(), source_rows_there, tolerance->gains(), contraction_now(),
                     tolerance->enough(largest, contraction_now()), system.time_step());
  }
  double contraction_now() { return tolerance->contraction().next_change(largest, n()); }
  bool is_stiff(double size) { return tolerance && tolerance->contraction().is_stiff(size, n()); }

  /// The new row, beside the old one or over it. False if it could not be solved for; `continued` then says why.
  bool solve_step() {
    const bool iterates = equations.iterates();
    begin_step();
    iterations = 0;
    continued = Continued::no;
    Pack found = pass(Kind::step, iterates);
    double value = max_or_nan(found);
    if (overflowed(value)) return set_largest(value);
    if (!iterates) return set_largest(value);
    const double by = contraction_now(), enough = tolerance->enough(std::max({value, largest, largest_before}), by);
    double effect = tolerance->effect_of(changes);
    for (iterations = 1; !(effect <= enough);) {
      if (!(effect < 1e100)) return give_up(Continued::slow);
      if (iterations >= options.max_iterations) return give_up(Continued::out_of_iterations);
      if (iterations == 1 && source_rows_there > 0) find_changes();
      // An estimate of what is left after this correction may spare its evaluation.
      const bool is_last = options.tolerance >= smallest_estimated && by * effect <= enough;
      found = pass(Kind::correction, !is_last);
      value = max_or_nan(found);
      if (overflowed(value)) return give_up(Continued::slow);
      if (is_last) break;
      ++iterations;
      const double before = effect;
      effect = tolerance->effect_of(changes);
      // Changes that no longer shrink are rounding, if they are small, or else the fixed point does not contract.
      if (iterations >= 3 && effect > 0.5 * before) {
        if (effect <= 64 * round_off * std::max({value, largest, largest_before})) break;
        return give_up(Continued::slow);
      }
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
  /// δ = g′ − g again, where the first pass has not kept it.
  void find_changes() {
    for (std::size_t s = 0; s < equations.sources().size(); ++s) {
      const SourceRow& source = equations.sources()[s];
      if (!source.reads_unknown) continue;
      const double* const g = table[source.ring.row(0)];
      double* const delta = table[source.change];
      const RowSum& taken = equations.prediction(source, predictor.order());
      taken.evaluate(table.data(), layout.at(0), layout.at(layout.packs()), lanes, delta);
      for (std::ptrdiff_t at = layout.at(0); at < layout.at(layout.packs()); at += lanes)
        (Pack::load(g + at) - Pack::load(delta + at)).store(delta + at);
      layout.fill_halo(delta);
    }
  }

  /// Where the fixed point does not contract: by Newton's method, and where there may be other roots than the one that it
  /// finds, by following the root from a small time step.
  void solve_by_newton() {
    const Window past = kept.window(history);
    if (continued != Continued::stiff) {
      const NewtonResult direct = solve_slab(system, plan, past, options.tolerance,
                                             std::min(options.max_iterations, enough_iterations), false);
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
    evaluate_unknown();
  }
  /// Takes a row that Newton's method has found, unless there may be other roots near it.
  bool has_no_other_root_near(const std::vector<double>& row) {
    set_row(row);
    const double value = kept.largest(0);
    return !may_have_other_roots(value) && set_largest(value);
  }

  /// The same of row 1 of a centred start, from row 0 and y₋₁ = y₁ − 2hφ_t.
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
    kept.turn();
    turn_sources();
  }
  void turn_sources() {
    for (const SourceRow& source : equations.sources())
      if (!source.is_local) table.turn(source.ring);
    ++past_sources;
    count_sources();
  }
  /// Of bricks those of every second row stand at the same sites.
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
    kept.turn_in_place();
    turn_sources();
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
    const bool may_be_in_place = !looked_at && goes_in_place && (kept.in_place() || (kept.known() >= 2 && n() > kept.start_row())) &&
                                 !(equations.iterates() && source_rows_there == 0) && !is_stiff(largest);
    if (!may_be_in_place) step_beside();
    else if (!step_in_place()) step_again(n() + 1);
  }

  // ---- Rows.

  void start(const std::vector<std::vector<double>>& rows) {
    kept.start(rows);
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
      for (int back = 1; source.component == 0 && back <= source.newest - source.oldest; ++back) evaluate_rows(s, back);
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
      if (source.change >= 0) state.numbers("changes of source terms", table[source.change], layout.doubles());
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
      bytes += RowBuffer::bytes_of(layout.doubles(), source.ring.held + (source.change >= 0 ? 1 : 0));
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
  const Window first{&s.system.lattice(), s.d, s.options.turn, 0, {row0}};
  const auto solved = [&](bool followed) {
    return solve_centred_start(s.system, s.plan, first, velocity, followed, s.options.tolerance,
                               s.options.max_iterations).row;
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
  rows.turn_back(s.equations.y()), rows.turn_back(s.equations.v());
  for (const SourceRow& source : s.equations.sources())
    if (!source.is_local) rows.turn_back(source.ring);
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
  const std::size_t work = s.equations.work_bytes() + s.work.bytes() + s.layout.bytes();
  const bool comes = residual && s.equations.work_bytes() < s.equations.residual_bytes();
  const std::size_t to_come = comes ? s.equations.residual_bytes() : 0;
  return {
      .starting_rows = s.history,
      .iterates = s.equations.iterates(),
      .matrix_free = matrix == 0,
      .solver = s.equations.solver(0).name(),
      .layout = &s.layout,
      .bytes = rows + sources + matrix + work,
      .bytes_to_come = to_come,
      .memory = fmt::format("rows of the field and increments {} B, source terms {} B, matrix {} B, work space {} B",
                            rows, sources, matrix, work + to_come)};
}

}  // namespace delf
