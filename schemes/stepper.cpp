// SPDX-License-Identifier: MIT
#include "schemes/stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "lattice/error.hpp"
#include "schemes/equation_terms.hpp"
#include "schemes/flush_denormals.hpp"
#include "schemes/newton.hpp"
#include "schemes/row_sum.hpp"

namespace delf {

struct Stepper::Impl {
  const LatticeSystem& system;
  const SolvePlan& plan;
  StepOptions options;
  int d, N, history, seed_rows;
  bool bricks, iterative;
  AssembledEquations equations;
  RowLayout layout;
  RowBuffer y, v, w, known, total, absolute, positions, signs;
  /// The rows out_c of one family: a ring over the anchors' rows.
  struct Outputs {
    RowBuffer ring;
    int oldest = 0, newest = 0;          ///< anchors' rows that equations use, from n
    int first_time = 0, last_time = 0;   ///< of the pattern
    std::vector<int> absent;             ///< slots whose stencil leaves the lattice
  };
  std::vector<Outputs> outputs;
  std::unique_ptr<LinearSolver> solver[2];  ///< of even and odd rows, alike unless bricks differ

  std::int64_t n = -1;   ///< newest row
  double largest[3] = {0, 0, 0};
  int iterations = 0, newton_steps = 0;
  bool continued = false;
  RowSum sum;            ///< scratch of assemble_row
  std::vector<const double*> slab_rows, solver_in;
  std::vector<double*> slab_out, solver_out;

  Impl(const LatticeSystem& s, const SolvePlan& p, const StepOptions& o)
      : system(s), plan(p), options(o), d(s.components()), N(s.lattice().sites()),
        history(std::max(p.forward + p.backward, 2)), seed_rows(std::clamp(o.seed_order, 1, 12)),
        bricks(s.placement() == Placement::brick_wall), iterative(p.nonlinear_in_slab),
        equations(assemble(s, p)), layout(s.lattice(), std::max(1, s.width())) {
    bool one_row = plan.table.regular;
    for (int i : {0, N / 2, N - 1})
      for (int a = 0; a < d; ++a)
        one_row = one_row && plan.offset(i, a, 0) == 0 && plan.offset(i, a, 1) == 0 &&
                  plan.shift(i, a, 0) == plan.shift(i, a, 1);
    if (!one_row)
      throw BadInput("lattice.stencil", "the unknowns that this stencil matches in one step do not lie in one row, which "
                                        "this version does not step; use fixed walls or a circle");
    y = RowBuffer(layout, (history + 1) * d);
    v = RowBuffer(layout, (std::max(history - 1, iterative ? seed_rows - 1 : 1) + 1) * d);
    w = RowBuffer(layout, d);
    known = RowBuffer(layout, d);
    total = RowBuffer(layout, d);
    build_outputs();
    build_solvers();
    const bool placed = std::ranges::any_of(system.families(), [](const auto& f) { return f->is_placed(); });
    if (placed) {
      positions = RowBuffer(layout, 1);
      std::vector<double> x(static_cast<std::size_t>(N));
      for (int i = 0; i < N; ++i) x[static_cast<std::size_t>(i)] = system.lattice().position(i);
      layout.scatter(x, positions.row(0));
    }
    if (bricks) {
      signs = RowBuffer(layout, 1);
      std::vector<double> sign(static_cast<std::size_t>(N));
      for (int i = 0; i < N; ++i) sign[static_cast<std::size_t>(i)] = i % 2 == 0 ? 1 : -1;
      layout.scatter(sign, signs.row(0));
    }
    slab_out.resize(64);
    slab_rows.resize(64);
    solver_in.resize(static_cast<std::size_t>(d));
    solver_out.resize(static_cast<std::size_t>(d));
  }

  // ---- set-up

  void build_outputs() {
    for (std::size_t f = 0; f < system.families().size(); ++f) {
      const StencilFamily& family = *system.families()[f];
      Outputs o;
      const auto [first, last] = std::ranges::minmax(family.pattern().vertices, {}, &Site::time);
      o.first_time = first.time;
      o.last_time = last.time;
      o.oldest = std::numeric_limits<int>::max();
      o.newest = std::numeric_limits<int>::min();
      const auto scan = [&](const EquationTerms& equation) {
        for (const Term& t : equation.terms)
          if (t.source == Source::output && t.family == static_cast<int>(f))
            o.oldest = std::min(o.oldest, t.age), o.newest = std::max(o.newest, t.age);
      };
      for (const auto& equation : equations.bulk) scan(equation);
      for (const auto& special : equations.exceptional) scan(special.equation);
      if (o.oldest > o.newest) o.oldest = 0, o.newest = -1;
      o.ring = RowBuffer(layout, (o.newest - o.oldest + 1) * family.outputs());
      if (!system.lattice().is_circle())
        for (int i = 0; i < N; ++i)
          if (std::ranges::any_of(family.pattern().vertices,
                                  [&](Site s) { return i + s.space < 0 || i + s.space >= N; }))
            for (int slot : layout.slots_of(i)) o.absent.push_back(slot);
      outputs.push_back(std::move(o));
    }
  }

  void build_solvers() {
    bool alternating = false;
    for (const auto& row : equations.unknowns)
      for (const UnknownEntry& e : row) alternating = alternating || e.alternating != 0;
    for (const auto& special : equations.exceptional)
      for (const UnknownEntry& e : special.unknowns) alternating = alternating || e.alternating != 0;
    if (system.lattice().is_circle() && d == 1 && !alternating) {
      std::vector<BandEntry> stencil;
      for (const UnknownEntry& e : equations.unknowns[0]) stencil.push_back({e.space, e.coefficient});
      solver[0] = factor_uniform(system.lattice(), layout, stencil);
      return;
    }
    for (int parity = 0; parity < (alternating ? 2 : 1); ++parity) {
      std::vector<LatticeSystem::Entry> entries;
      std::set<std::pair<int, int>> special;
      const auto add = [&](int i, int a, int shift, const std::vector<UnknownEntry>& unknowns) {
        // `parity` is that of the unknown row; the equation sits `shift` rows below.
        const double sign = (parity - shift + i) % 2 == 0 ? 1 : -1;
        for (const UnknownEntry& e : unknowns) {
          const int column = system.lattice().is_circle() ? system.lattice().wrapped(i + e.space) : i + e.space;
          entries.push_back({i * d + a, column * d + e.component, e.coefficient + sign * e.alternating});
        }
      };
      for (const auto& s : equations.exceptional) {
        special.insert({s.site, s.component});
        if (s.fixed) entries.push_back({s.site * d + s.component, s.site * d + s.component, 1.0});
        else add(s.site, s.component, s.equation.shift, s.unknowns);
      }
      for (int i = 0; i < N; ++i)
        for (int a = 0; a < d; ++a)
          if (!special.contains({i, a})) {
            const auto at = static_cast<std::size_t>(a);
            add(i, a, equations.bulk[at].shift, equations.unknowns[at]);
          }
      solver[parity] = factor(system.lattice(), layout, d, entries);
    }
  }

  // ---- rows

  double* y_row(std::int64_t row, int a) { return y.row(static_cast<int>(row % (history + 1)) * d + a); }
  double* v_row(std::int64_t row, int a) { return v.row(static_cast<int>(row % (v.rows() / d)) * d + a); }
  double* out_row(int f, std::int64_t anchor_row, int c) {
    Outputs& o = outputs[static_cast<std::size_t>(f)];
    const int count = o.newest - o.oldest + 1, per = system.families()[static_cast<std::size_t>(f)]->outputs();
    return o.ring.row(static_cast<int>(((anchor_row % count) + count) % count) * per + c);
  }

  /// out of the stencils of family f anchored at a row, reading rows oldest … newest and no others.
  void evaluate(std::size_t f, std::int64_t anchor_row, std::int64_t oldest, std::int64_t newest) {
    const StencilFamily& family = *system.families()[f];
    const Outputs& o = outputs[f];
    const double h = system.time_step();
    for (int t = o.first_time; t <= o.last_time; ++t)
      for (int a = 0; a < d; ++a)
        slab_rows[static_cast<std::size_t>((t - o.first_time) * d + a)] =
            y_row(std::clamp(anchor_row + t, oldest, newest), a);
    for (int c = 0; c < family.outputs(); ++c)
      slab_out[static_cast<std::size_t>(c)] = out_row(static_cast<int>(f), anchor_row, c);
    family.evaluate({&layout, slab_rows.data(), positions.rows() ? positions.row(0) : nullptr,
                     static_cast<double>(anchor_row) * h, h, system.lattice().space_step()},
                    slab_out.data());
    for (int c = 0; c < family.outputs(); ++c) {
      double* out = slab_out[static_cast<std::size_t>(c)];
      for (int slot : o.absent) out[slot] = 0;
      if (family.pattern().placement == Placement::brick_wall) {
        const double sign = anchor_row % 2 == 0 ? 0.5 : -0.5;
        for (int p = 0; p < layout.packs(); ++p) {
          const auto at = layout.at(p);
          (Pack::load(out + at) * (0.5 + sign * Pack::load(signs.row(0) + at))).store(out + at);
        }
      }
      layout.fill_halo(out);
    }
  }

  bool is_new(std::size_t f, int age) const { return age + system.families()[f]->outputs_read_until() >= 1; }

  /// Outputs that depend on row base+1 (`fresh`), or those that do not.
  void evaluate_outputs(std::int64_t base, bool fresh) {
    for (std::size_t f = 0; f < outputs.size(); ++f)
      for (int age = outputs[f].oldest; age <= outputs[f].newest; ++age)
        if (is_new(f, age) == fresh) evaluate(f, base + age, base + 1 - history, fresh ? base + 1 : base);
  }

  // ---- the equations, row by row

  enum Part { known_part = 1, fresh_part = 2, unknown_part = 4 };
  bool belongs(const Term& t, int parts) const {
    if (t.source == Source::unknown) return parts & unknown_part;
    if (t.source == Source::output && is_new(static_cast<std::size_t>(t.family), t.age)) return parts & fresh_part;
    return parts & known_part;
  }
  const double* row_of(const Term& t, std::int64_t base) {
    switch (t.source) {
      case Source::difference:
      case Source::value: return y_row(base, t.component);
      case Source::increment: return v_row(base - t.age, t.component);
      case Source::unknown: return w.row(t.component);
      case Source::output: return out_row(t.family, base + t.age, t.output);
    }
    return nullptr;
  }

  /// E += the given parts of the equations that are solved with base as the newest known row. With A, also A += Σ|term|.
  void add_parts(std::int64_t base, int parts, RowBuffer& E, RowBuffer* A) {
    for (int a = 0; a < d; ++a) {
      const EquationTerms& equation = equations.bulk[static_cast<std::size_t>(a)];
      sum.clear();
      const double parity = (base + 1 - equation.shift) % 2 == 0 ? 1 : -1;
      for (const Term& t : equation.terms)
        if (belongs(t, parts))
          sum.add(row_of(t, base), static_cast<std::ptrdiff_t>(t.shift) * lanes, t.coefficient, parity * t.alternating,
                  t.source == Source::difference);
      const bool constant = parts & known_part;
      sum.evaluate(layout, constant ? equation.constant : 0, constant ? parity * equation.constant_alternating : 0,
                   bricks ? signs.row(0) : nullptr, E.row(a), A ? A->row(a) : nullptr);
    }
    for (const SiteEquation& special : equations.exceptional) {
      const int own = layout.slot(special.site), a = special.component;
      double value = 0, size = 0;
      if (special.fixed) {
        // v_{n+1} = v_n + w = 0
        if (parts & known_part) value += v_row(base, a)[own];
        if (parts & unknown_part) value += w.row(a)[own];
      } else {
        const EquationTerms& equation = special.equation;
        const double sign = (base + 1 - equation.shift + special.site) % 2 == 0 ? 1 : -1;
        if (parts & known_part) value += equation.constant + sign * equation.constant_alternating;
        for (const Term& t : equation.terms)
          if (belongs(t, parts)) {
            const double* row = row_of(t, base);
            const double x = row[slot_beside(special.site, t.shift)] - (t.source == Source::difference ? row[own] : 0);
            value += (t.coefficient + sign * t.alternating) * x;
            size += std::abs((t.coefficient + sign * t.alternating) * x);
          }
      }
      // The pass over whole rows has left the bulk's equation here: put this site's own sums in its place.
      double& so_far = exceptional_sums[static_cast<std::size_t>(&special - equations.exceptional.data())];
      so_far += value;
      for (int slot : layout.slots_of(special.site)) {
        E.row(a)[slot] = so_far;
        if (A) A->row(a)[slot] = size;
      }
    }
  }
  std::vector<double> exceptional_sums, known_exceptional_sums;
  int slot_beside(int site, int shift) const { return layout.slot(std::clamp(site + shift, 0, N - 1)); }

  void clear(RowBuffer& rows) {
    for (int a = 0; a < rows.rows(); ++a) std::fill_n(rows.row(a), layout.doubles(), 0.0);
    exceptional_sums.assign(equations.exceptional.size(), 0.0);
  }

  // ---- stepping

  /// v_{n+1} and y_{n+1} from w; returns the largest |change of v| against the candidate there before, and of |y|.
  struct Change {
    double change, value;
  };
  Change take_increment(bool correct) {
    Pack change(0.0), value(0.0);
    for (int a = 0; a < d; ++a) {
      double *v_new = v_row(n + 1, a), *y_new = y_row(n + 1, a), *increment = w.row(a);
      const double *v_old = v_row(n, a), *y_old = y_row(n, a);
      for (int p = 0; p < layout.packs(); ++p) {
        const auto at = layout.at(p);
        const Pack before = Pack::load(v_new + at);
        const Pack next = Pack::load(increment + at) + (correct ? before : Pack::load(v_old + at));
        const Pack y_next = Pack::load(y_old + at) + next;
        next.store(v_new + at);
        y_next.store(y_new + at);
        change = max_or_nan(abs(next - before), change);
        value = max_or_nan(abs(y_next), value);
      }
      layout.fill_halo(v_new);
      layout.fill_halo(y_new, options.turn);
    }
    return {max_or_nan(change), max_or_nan(value)};
  }

  void solve_increment() {
    const LinearSolver& A = *(solver[1] && (n + 1) % 2 != 0 ? solver[1] : solver[0]);
    for (int a = 0; a < d; ++a) {
      double* E = total.row(a);
      for (int p = 0; p < layout.packs(); ++p) {
        const auto at = layout.at(p);
        (-Pack::load(E + at)).store(E + at);
      }
      solver_in[static_cast<std::size_t>(a)] = E;
      solver_out[static_cast<std::size_t>(a)] = w.row(a);
    }
    A.solve(solver_in.data(), solver_out.data());
    for (int a = 0; a < d; ++a) layout.copy_overlaps(w.row(a));
  }

  /// v_{n+1} from past increments: the polynomial through the last rows, one degree less than rows (seed order).
  void seed() {
    const int held = static_cast<int>(std::min<std::int64_t>(n, v.rows() / d - 1));
    const int order = std::min(seed_rows - 1, held);
    double c[16];
    // v_{n+1} ≈ Σ_{m=1}^{order} (−1)^{m+1} C(order, m) v_{n+1−m}
    double binomial = 1;
    for (int m = 1; m <= order; ++m) {
      binomial = binomial * (order - m + 1) / m;
      c[m] = (m % 2 == 1 ? 1 : -1) * binomial;
    }
    for (int a = 0; a < d; ++a) {
      double *v_new = v_row(n + 1, a), *y_new = y_row(n + 1, a);
      const double* y_old = y_row(n, a);
      sum.clear();
      for (int m = 1; m <= order; ++m) sum.add(v_row(n + 1 - m, a), 0, c[m], 0, false);
      std::fill_n(v_new, layout.doubles(), 0.0);
      sum.evaluate(layout, 0, 0, nullptr, v_new, nullptr);
      for (int p = 0; p < layout.packs(); ++p) {
        const auto at = layout.at(p);
        (Pack::load(y_old + at) + Pack::load(v_new + at)).store(y_new + at);
      }
      layout.fill_halo(y_new, options.turn);
    }
  }

  void copy_known_to_total() {
    for (int a = 0; a < d; ++a) std::copy_n(known.row(a), layout.doubles(), total.row(a));
    exceptional_sums = known_exceptional_sums;
  }

  void step() {
    const FlushDenormals guard;
    iterations = newton_steps = 0;
    continued = false;
    clear(known);
    add_parts(n, known_part, known, nullptr);
    known_exceptional_sums = exceptional_sums;
    Change change{};
    if (!iterative) {
      // The unknown row enters linearly, with known coefficients: one solve, from any candidate.
      for (int a = 0; a < d; ++a) {
        std::copy_n(v_row(n, a), layout.doubles(), v_row(n + 1, a));
        std::copy_n(y_row(n, a), layout.doubles(), y_row(n + 1, a));
      }
      if (equations.correction_form) candidate_from_increment();
      evaluate_outputs(n, true);
      copy_known_to_total();
      add_parts(n, fresh_part, total, nullptr);
      solve_increment();
      change = take_increment(equations.correction_form);
      // What was computed from the candidate and not only from known rows is part of the next step's known part.
      evaluate_outputs(n, true);
    } else {
      seed();
      double last = std::numeric_limits<double>::infinity();
      bool done = false;
      while (!done && iterations < options.max_iterations) {
        ++iterations;
        evaluate_outputs(n, true);
        copy_known_to_total();
        add_parts(n, fresh_part, total, nullptr);
        solve_increment();
        change = take_increment(equations.correction_form);
        if (!std::isfinite(change.change)) break;
        const double scale = std::max({change.value, largest[0], largest[1]});
        done = change.change <= options.tolerance * scale ||
               change.change <= 4 * std::numeric_limits<double>::epsilon() * scale;
        // Contracting by less than a half: full Newton is cheaper from here, if it works at all.
        if (!done && iterations >= 3 && change.change > 0.5 * last) break;
        last = change.change;
      }
      // A field that overflowed has no root to look for.
      if (!done && overflowed(change.value)) report_not_finite();
      if (!done) change.value = full_newton();
    }
    if (overflowed(change.value)) report_not_finite();
    if (options.fibre == Fibre::circle) check_wrapped_differences();
    largest[1] = largest[0];
    largest[0] = change.value;
    ++n;
  }

  /// y_{n+1} = y_n + v_n, for an equation that is evaluated whole.
  void candidate_from_increment() {
    for (int a = 0; a < d; ++a) {
      double* y_new = y_row(n + 1, a);
      const double* v_new = v_row(n + 1, a);
      for (int p = 0; p < layout.packs(); ++p)
        (Pack::load(y_new + layout.at(p)) + Pack::load(v_new + layout.at(p))).store(y_new + layout.at(p));
      layout.fill_halo(y_new, options.turn);
    }
  }

  Window window(std::int64_t first, std::int64_t last) {
    Window result{&system.lattice(), d, options.turn, first, {}};
    for (std::int64_t r = first; r <= last; ++r) result.rows.push_back(site_row(r));
    return result;
  }
  std::vector<double> site_row(std::int64_t r) {
    std::vector<double> row(static_cast<std::size_t>(N * d)), one(static_cast<std::size_t>(N));
    for (int a = 0; a < d; ++a) {
      layout.gather(y_row(r, a), one);
      for (int i = 0; i < N; ++i) row[static_cast<std::size_t>(i * d + a)] = one[static_cast<std::size_t>(i)];
    }
    return row;
  }
  void set_row(std::int64_t r, const std::vector<double>& row) {
    std::vector<double> one(static_cast<std::size_t>(N));
    for (int a = 0; a < d; ++a) {
      for (int i = 0; i < N; ++i) one[static_cast<std::size_t>(i)] = row[static_cast<std::size_t>(i * d + a)];
      layout.scatter(one, y_row(r, a), options.turn);
    }
  }
  void set_increment(std::int64_t r) {
    for (int a = 0; a < d; ++a) {
      double* increment = v_row(r, a);
      const double *above = y_row(r, a), *below = y_row(r - 1, a);
      for (std::size_t s = 0; s < layout.doubles(); ++s) increment[s] = above[s] - below[s];
    }
  }

  /// Returns the largest |y| of the row found.
  double full_newton() {
    const Window past = window(n + 1 - history, n);
    seed();
    const NewtonResult result =
        solve_slab(system, plan, past, site_row(n + 1), options.tolerance, options.max_iterations);
    iterations += result.iterations;
    newton_steps = result.iterations;
    continued = result.continued;
    if (!result.converged)
      throw NoConvergence(fmt::format(
          "step {}, t = {:.6g}: the implicit equations were not solved: the simplified and the full Newton method did "
          "not converge from the extrapolated seed, or not to a root that is surely the right one, and following the "
          "root from a small time step failed; reduce lattice.courant or lattice.time_step",
          n + 1, static_cast<double>(n + 1) * system.time_step()));
    set_row(n + 1, result.row);
    set_increment(n + 1);
    evaluate_outputs(n, true);
    double value = 0;
    for (double x : result.row) value = std::max(value, std::abs(x));
    return value;
  }

  /// Beyond this squares overflow, and with them every energy: nothing that could be reported is a number any more.
  static bool overflowed(double largest_value) { return !(largest_value <= 1e150); }

  [[noreturn]] void report_not_finite() {
    // Implicit steps spread an overflow over the whole row: it is where the field was largest.
    const std::vector<double> row = site_row(n + 1), before = site_row(n);
    const auto fine = [](double x) { return !overflowed(std::abs(x)); };
    const bool everywhere = std::ranges::none_of(row, fine);
    const auto bad = everywhere ? std::ranges::max_element(before, {}, [](double x) { return std::abs(x); }) - before.begin()
                                : std::ranges::find_if_not(row, fine) - row.begin();
    throw NotFinite(fmt::format(
        "step {}, t = {:.6g}, site {}: the field is no longer finite: the scheme is unstable here; reduce "
        "lattice.courant or lattice.time_step, or choose an implicit stencil",
        n + 1, static_cast<double>(n + 1) * system.time_step(), bad / d));
  }

  /// S¹: wrapping says which way round only while differences on a stencil stay well below π.
  void check_wrapped_differences() {
    const auto check = [&](const double* from, const double* to, std::ptrdiff_t shift) {
      Pack most(0.0);
      for (int p = 0; p < layout.packs(); ++p)
        most = max_or_nan(abs(Pack::load(to + layout.at(p) + shift) - Pack::load(from + layout.at(p))), most);
      if (max_or_nan(most) <= largest_wrapped_difference) return;
      const std::vector<double> row = site_row(n + 1);
      std::ptrdiff_t site = 0;
      for (int slot = 0, i = 0; i < N; ++i) {
        slot = layout.slot(i);
        if (!(std::abs(to[slot + shift] - from[slot]) <= largest_wrapped_difference)) site = i;
      }
      throw NotFinite(fmt::format(
          "step {}, t = {:.6g}, site {}: on the fibre S1 a wrapped difference within a stencil is above 0.9 pi, where it "
          "cannot be told from its complement; refine the lattice, reduce lattice.courant, or use theory.fibre = R",
          n + 1, static_cast<double>(n + 1) * system.time_step(), site));
    };
    for (const auto& family : system.families()) {
      const auto& vertices = family->pattern().vertices;
      const int top = std::ranges::max(vertices, {}, &Site::time).time;
      for (const Site& vertex : vertices)
        for (int a = 0; a < d; ++a) {
          // The stencil whose top row is the new one, from its first vertex to each other.
          const std::int64_t rows[2] = {n + 1 - top + vertices[0].time, n + 1 - top + vertex.time};
          if (rows[0] < 0 || rows[1] < 0) continue;
          check(y_row(rows[0], a), y_row(rows[1], a),
                static_cast<std::ptrdiff_t>(vertex.space - vertices[0].space) * lanes);
        }
    }
  }

  double residual() {
    const std::int64_t base = n - 1;
    if (base < history - 1) return 0;
    if (!absolute.rows()) absolute = RowBuffer(layout, d);
    for (int a = 0; a < d; ++a) {
      double* increment = w.row(a);
      for (std::size_t s = 0; s < layout.doubles(); ++s) increment[s] = v_row(n, a)[s] - v_row(n - 1, a)[s];
    }
    evaluate_outputs(base, true);
    clear(total);
    for (int a = 0; a < d; ++a) std::fill_n(absolute.row(a), layout.doubles(), 0.0);
    add_parts(base, known_part | fresh_part | unknown_part, total, &absolute);
    double worst = 0, size = 0;
    for (int a = 0; a < d; ++a)
      for (int i = 0; i < N; ++i) {
        worst = std::max(worst, std::abs(total.row(a)[layout.slot(i)]));
        size = std::max(size, absolute.row(a)[layout.slot(i)]);
      }
    return size > 0 ? worst / size : 0;
  }
};

Stepper::Stepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : impl_(std::make_unique<Impl>(system, plan, options)) {}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;

int Stepper::starting_rows() const { return impl_->history; }

void Stepper::start(const std::vector<std::vector<double>>& rows) {
  Impl& s = *impl_;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    s.set_row(static_cast<std::int64_t>(r), rows[r]);
    if (r > 0) s.set_increment(static_cast<std::int64_t>(r));
    s.largest[1] = s.largest[0];
    s.largest[0] = 0;
    for (double x : rows[r]) s.largest[0] = std::isfinite(x) ? std::max(s.largest[0], std::abs(x)) : x;
    if (!std::isfinite(s.largest[0])) throw NotFinite(fmt::format("row {} of the start is not finite", r));
  }
  s.n = static_cast<std::int64_t>(rows.size()) - 1;
  s.evaluate_outputs(s.n, false);
}

void Stepper::start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) {
  Impl& s = *impl_;
  if (s.history != 2)
    throw BadInput("initial.start", "initial.start = centred makes one more row, and this stencil needs " +
                                        std::to_string(s.history) + " starting rows; choose initial.start = exact");
  const Window first{&s.system.lattice(), s.d, s.options.turn, 0, {row0}};
  const NewtonResult result =
      solve_centred_start(s.system, s.plan, first, velocity, s.options.tolerance, s.options.max_iterations);
  if (!result.converged)
    throw NoConvergence("the starting row of initial.start = centred was not found: Newton's method did not converge; "
                        "reduce lattice.courant or lattice.time_step");
  start({row0, result.row});
}

void Stepper::step() { impl_->step(); }
std::int64_t Stepper::newest() const { return impl_->n; }
std::vector<double> Stepper::row(int back) const { return impl_->site_row(impl_->n - back); }
double Stepper::residual() const { return impl_->residual(); }
int Stepper::iterations() const { return impl_->iterations; }
int Stepper::newton_steps() const { return impl_->newton_steps; }
bool Stepper::continued() const { return impl_->continued; }
const RowLayout& Stepper::layout() const { return impl_->layout; }
const double* Stepper::row_data(int back, int a) const { return impl_->y_row(impl_->n - back, a); }
const double* Stepper::newest_increment(int a) const { return impl_->v_row(impl_->n, a); }
std::string Stepper::solver_name() const { return impl_->solver[0]->name(); }

bool Stepper::matrix_free() const { return !impl_->solver[1] && impl_->solver[0]->bytes() == 0; }

std::size_t Stepper::bytes() const {
  const Impl& s = *impl_;
  std::size_t total = s.layout.bytes();
  for (const RowBuffer* b : {&s.y, &s.v, &s.w, &s.known, &s.total, &s.absolute, &s.positions, &s.signs})
    total += b->bytes();
  for (const auto& o : s.outputs) total += o.ring.bytes();
  for (const auto& solver : s.solver)
    if (solver) total += solver->bytes();
  return total;
}

std::string Stepper::memory_report() const {
  const Impl& s = *impl_;
  std::size_t outputs = 0, matrix = 0;
  for (const auto& o : s.outputs) outputs += o.ring.bytes();
  for (const auto& solver : s.solver)
    if (solver) matrix += solver->bytes();
  return fmt::format("rows of the field {} B, increments {} B, nonlinear terms {} B, matrix {} B, work space {} B",
                     s.y.bytes(), s.v.bytes(), outputs, matrix,
                     bytes() - s.y.bytes() - s.v.bytes() - outputs - matrix);
}

}  // namespace delf
