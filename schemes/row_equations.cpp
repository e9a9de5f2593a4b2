// SPDX-License-Identifier: MIT
#include "schemes/row_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace delf {

RowEquations::RowEquations(const LatticeSystem& system, const SolvePlan& plan, SectionRows& rows, int history)
    : system_(system),
      rows_(rows),
      layout_(rows.layout()),
      d_(system.components()),
      history_(history),
      turn_(rows.turn()),
      time_step_(system.time_step()),
      space_step_(system.lattice().space_step()),
      bricks_(system.placement() == Placement::brick_wall),
      equations_(assemble(system, plan)),
      y_slots_(rows.rows_held()),
      v_slots_(rows.increments_held()),
      candidate_(layout_, d_) {
  build_solvers();
  build_loop();
  build_outputs();
  build_marks();
  build_sums();
  build_looks();
}

// ---- set-up

void RowEquations::build_solvers() {
  const Lattice& lattice = system_.lattice();
  bool alternating = false, coupled = false;
  for (std::size_t a = 0; a < equations_.unknowns.size(); ++a)
    for (const UnknownEntry& e : equations_.unknowns[a]) {
      alternating = alternating || e.alternating != 0;
      coupled = coupled || e.component != static_cast<int>(a);
    }
  for (const auto& special : equations_.exceptional)
    for (const UnknownEntry& e : special.unknowns) alternating = alternating || e.alternating != 0;
  if (lattice.is_circle() && !coupled && !alternating) {
    std::vector<std::unique_ptr<LinearSolver>> solvers;
    for (const auto& unknowns : equations_.unknowns) {
      std::vector<BandEntry> stencil;
      for (const UnknownEntry& e : unknowns) stencil.push_back({e.space, e.coefficient});
      solvers.push_back(factor_uniform(lattice, layout_, stencil));
    }
    solver_[0] = by_component(std::move(solvers));
    return;
  }
  for (int parity = 0; parity < (alternating ? 2 : 1); ++parity) {
    std::vector<LatticeSystem::Entry> entries;
    std::set<std::pair<int, int>> special;
    const auto add = [&](int i, int a, int shift, const std::vector<UnknownEntry>& unknowns) {
      // `parity` is that of the unknown row; the equation sits `shift` rows below.
      const double sign = (parity - shift + i) % 2 == 0 ? 1 : -1;
      for (const UnknownEntry& e : unknowns) {
        const int column = lattice.is_circle() ? lattice.wrapped(i + e.space) : i + e.space;
        entries.push_back({i * d_ + a, column * d_ + e.component, e.coefficient + sign * e.alternating});
      }
    };
    for (const auto& s : equations_.exceptional) {
      special.insert({s.site, s.component});
      if (s.fixed) entries.push_back({s.site * d_ + s.component, s.site * d_ + s.component, 1.0});
      else add(s.site, s.component, s.equation.shift, s.unknowns);
    }
    for (int i = 0; i < layout_.sites(); ++i)
      for (int a = 0; a < d_; ++a)
        if (!special.contains({i, a})) {
          const auto at = static_cast<std::size_t>(a);
          add(i, a, equations_.bulk[at].shift, equations_.unknowns[at]);
        }
    solver_[parity] = factor(lattice, layout_, d_, entries);
  }
}

/// One loop will do if the unknown row has one coefficient, and all that is known are differences to neighbours and
/// outputs of the site's own value.
void RowEquations::build_loop() {
  if (system_.families().size() != 1 || bricks_ || equations_.correction_form || !equations_.exceptional.empty())
    return;
  const RowKernel& kernel = *system_.families()[0]->row_kernel();
  const auto neighbours = kernel.explicit_neighbours();
  if (neighbours.empty() || kernel.nonlinearity() != Nonlinearity::values) return;
  std::vector<double> linear(neighbours.size() * static_cast<std::size_t>(d_), 0.0), nonlinear;
  for (int a = 0; a < d_; ++a) {
    const auto own = static_cast<std::size_t>(a);
    const EquationTerms& equation = equations_.bulk[own];
    const auto& unknowns = equations_.unknowns[own];
    if (unknowns.size() != 1 || unknowns[0].space != 0 || unknowns[0].component != a || equation.constant != 0) return;
    const double factor = -1 / unknowns[0].coefficient;
    nonlinear.push_back(0);
    for (const Term& t : equation.terms) {
      const auto at = std::ranges::find(neighbours, t.shift) - neighbours.begin();
      const bool beside = at < static_cast<std::ptrdiff_t>(neighbours.size());
      if (t.source == Source::output && t.age + kernel.outputs_read_until() <= 0)
        nonlinear.back() += factor * t.coefficient;
      else if (t.source == Source::difference && t.component == a && beside)
        linear[own * neighbours.size() + static_cast<std::size_t>(at)] += factor * t.coefficient;
      else if (t.source != Source::unknown) return;
    }
  }
  one_loop_ = &kernel;
  loop_linear_ = std::move(linear);
  loop_nonlinear_ = std::move(nonlinear);
  loop_reach_ = std::ranges::max(neighbours);
  loop_now_.resize(static_cast<std::size_t>(d_));
  loop_v_before_.resize(static_cast<std::size_t>(d_));
  loop_y_.resize(static_cast<std::size_t>(d_));
  loop_v_.resize(static_cast<std::size_t>(d_));
}

void RowEquations::build_outputs() {
  for (std::size_t f = 0; f < system_.families().size(); ++f) {
    const StencilFamily* family = system_.families()[f].get();
    Outputs o{.family = family, .kernel = family->row_kernel(), .ring = {}, .slots = RingSlots(1)};
    const auto& vertices = o.family->pattern().vertices;
    o.first_time = std::ranges::min(vertices, {}, &Site::time).time;
    o.last_time = std::ranges::max(vertices, {}, &Site::time).time;
    int oldest = std::numeric_limits<int>::max(), newest = std::numeric_limits<int>::min();
    const auto scan = [&](const EquationTerms& equation) {
      for (const Term& t : equation.terms)
        if (t.source == Source::output && t.family == static_cast<int>(f)) {
          oldest = std::min(oldest, t.age), newest = std::max(newest, t.age);
          o.lowest = std::min(o.lowest, t.shift), o.highest = std::max(o.highest, t.shift);
        }
    };
    for (const auto& equation : equations_.bulk) scan(equation);
    for (const auto& special : equations_.exceptional) scan(special.equation);
    if (oldest <= newest) o.oldest = oldest, o.newest = newest;
    o.slots = RingSlots(std::max(1, o.rows()));
    if (!is_one_loop()) o.ring = RowBuffer(layout_, o.rows() * o.kernel->outputs());
    slab_rows_.resize(std::max(slab_rows_.size(), static_cast<std::size_t>((o.last_time - o.first_time + 1) * d_)));
    slab_out_.resize(std::max(slab_out_.size(), static_cast<std::size_t>(o.kernel->outputs())));
    outputs_.push_back(std::move(o));
  }
}

void RowEquations::build_marks() {
  if (std::ranges::none_of(system_.families(), [](const auto& f) { return f->is_placed(); })) return;
  std::vector<double> site(static_cast<std::size_t>(layout_.sites()));
  positions_ = RowBuffer(layout_, 1);
  for (int i = 0; i < layout_.sites(); ++i) site[static_cast<std::size_t>(i)] = system_.lattice().position(i);
  layout_.scatter(site, positions_.row(0));
}

void RowEquations::build_sums() {
  const auto terms_of = [&](const auto& f) {
    for (const auto& equation : equations_.bulk) std::ranges::for_each(equation.terms, f);
    for (const auto& special : equations_.exceptional) std::ranges::for_each(special.equation.terms, f);
  };
  terms_of([&](const Term& t) {
    if (t.source == Source::increment) ages_ = std::max(ages_, t.age + 1);
  });
  y_base_ = 0;
  v_base_ = d_;
  int next = v_base_ + ages_ * d_;
  for (Outputs& o : outputs_) {
    o.base = next;
    next += o.rows() * o.kernel->outputs();
  }
  E_base_ = next;
  w_base_ = next + d_;
  bases_.resize(static_cast<std::size_t>(w_base_ + d_));

  is_stored_ = bricks_ || !equations_.exceptional.empty();
  for (int a = 0; a < d_; ++a) {
    const EquationTerms& equation = equations_.bulk[static_cast<std::size_t>(a)];
    for (int parity = 0; parity < (bricks_ ? 2 : 1); ++parity) {
      const double sign = parity == 0 ? 1 : -1;
      RowSum known, all;
      for (const Term& t : equation.terms) {
        if (bricks_ && !brick_exists(t, equation.shift, parity)) continue;
        const double coefficient = t.coefficient + sign * t.alternating;
        add_term(all, t, coefficient);
        if (t.source != Source::unknown) add_term(known, t, coefficient);
      }
      for (RowSum* sum : {&all, &known}) sum->add_constant(equation.constant + sign * equation.constant_alternating);
      known.scale(is_stored_ ? -1 : -solver_[0]->right_side_scale(a));
      sums_.push_back(std::move(known));
      measured_.push_back(std::move(all));
    }
    if (!is_stored_) continue;
    RowSum stored;
    stored.add(E_base_ + a, 0, solver_[0]->right_side_scale(a));
    stored_.push_back(std::move(stored));
  }
  if (is_one_loop()) return;
  if (solver_[0]->needs_work_rows() || equations_.correction_form) w_ = RowBuffer(layout_, d_);
  for (int a = 0; a < d_; ++a) w_rows_.push_back(w_.rows() ? w_.row(a) : nullptr);
  increments_.resize(static_cast<std::size_t>(d_));
}

/// What outputs look at, at the unknown row, from the first of its vertices on; each alike but for a shift counts once.
void RowEquations::build_looks() {
  if (!reads_unknown_row()) return;
  constexpr int packs_in_cache = 4096;
  const bool one_age = outputs_.size() == 1 && outputs_[0].reads_unknown_row(outputs_[0].newest) &&
                       !outputs_[0].reads_unknown_row(outputs_[0].newest - 1);
  if (d_ == 1 && equations_.exceptional.empty() && !solver_[1] && !equations_.correction_form && turn_ == 0 &&
      one_age && layout_.packs() >= packs_in_cache)
    is_streamed_ = solver_[0]->stream(layout_, right_side(0), {}) != nullptr;
  for (const Outputs& o : outputs_) {
    const Argument whole{{{Site{}, 1.0}}};
    const auto& arguments = o.kernel->arguments();
    for (std::size_t c = 0; c < std::max<std::size_t>(1, arguments.size()); ++c) {
      Argument look;
      if (arguments.empty()) look = whole;
      else
        for (const Argument::Part& part : arguments[c].parts)
          if (part.vertex.time == o.kernel->outputs_read_until()) look.parts.push_back(part);
      if (look.parts.empty()) continue;
      if (look.parts.size() > 3) look = whole;
      const int first = look.parts[0].vertex.space;
      for (Argument::Part& part : look.parts) part.vertex = {0, part.vertex.space - first};
      const auto same = [&](const Argument& other) {
        return std::ranges::equal(other.parts, look.parts, [](const Argument::Part& p, const Argument::Part& q) {
          return p.vertex == q.vertex && p.weight == q.weight;
        });
      };
      if (std::ranges::none_of(looks_, same)) looks_.push_back(std::move(look));
    }
  }
  // One look at neighbours that follow each other can be taken while the row is made.
  if (looks_.size() != 1 || static_cast<int>(looks_[0].parts.size()) > layout_.packs()) return;
  for (std::size_t p = 0; p < looks_[0].parts.size(); ++p)
    if (looks_[0].parts[p].vertex.space != static_cast<int>(p)) return;
  looks_on_the_way_ = true;
  for (RowIncrement& increment : increments_)
    for (std::size_t p = 0; p < looks_[0].parts.size(); ++p) increment.look.weights[p] = looks_[0].parts[p].weight;
}

double RowEquations::least_weight() const {
  double least = 1;
  for (const Argument& look : looks_) {
    double sum = 0;
    for (const Argument::Part& part : look.parts) sum += std::abs(part.weight);
    least = std::min(least, sum);
  }
  return least;
}

/// With E = Σ_c W_c * out_c, the change of y_{n+1} is at most Σ_c ‖A₊⁻¹ W_c‖₁ times that of the outputs; and the nonlinear
/// part of ∂E/∂y_{n+1} sums to ℓ″ Σ_c |W_c| |weights of argument c|.
double RowEquations::gain() {
  if (d_ != 1 || !equations_.exceptional.empty() || equations_.correction_form || solver_[1]) return 0;
  if (system_.families().size() != 1 || system_.families()[0]->row_kernel()->arguments().empty()) return 0;
  const Outputs& o = outputs_[0];
  RowBuffer impulse(layout_, 1), response(layout_, 1);
  std::vector<double> sites(static_cast<std::size_t>(layout_.sites()));
  double responses = 0, sums[2] = {0, 0};
  for (int age = o.oldest; age <= o.newest; ++age)
    for (int c = 0; c < o.kernel->outputs() && o.reads_unknown_row(age); ++c) {
      std::ranges::fill(sites, 0.0);
      double weights = 0;
      for (const Argument::Part& part :
           o.kernel->arguments()[static_cast<std::size_t>(c % static_cast<int>(o.kernel->arguments().size()))].parts)
        if (part.vertex.time + age == 1) weights += std::abs(part.weight);
      if (weights == 0) continue;
      for (const Term& t : equations_.bulk[0].terms)
        if (t.source == Source::output && t.age == age && t.output == c) {
          sites[static_cast<std::size_t>(system_.lattice().wrapped(layout_.sites() / 2 - t.shift))] += t.coefficient;
          for (int parity = 0; parity < 2; ++parity)
            if (!bricks_ || brick_exists(t, equations_.bulk[0].shift, parity))
              sums[parity] += std::abs(t.coefficient) * weights;
        }
      layout_.scatter(sites, impulse.row(0));
      const double* const rhs[] = {impulse.row(0)};
      double* const w[] = {response.row(0)};
      solver_[0]->solve(rhs, w);
      layout_.copy_overlaps(w[0]);
      layout_.gather(w[0], sites);
      for (double x : sites) responses += std::abs(x);
    }
  const double sum = std::max(sums[0], sums[1]);
  return sum > 0 ? responses / sum : 0;
}

/// Whether the term's brick is there, for an equation whose row + site has this parity.
bool RowEquations::brick_exists(const Term& t, int equation_shift, int parity) const {
  if (t.source != Source::output) return true;
  const bool bricks = outputs_[static_cast<std::size_t>(t.family)].family->pattern().placement == Placement::brick_wall;
  return !bricks || (parity + t.age - 1 + equation_shift + t.shift) % 2 == 0;
}

int RowEquations::index_of(const Term& t) const {
  switch (t.source) {
    case Source::difference:
    case Source::value:
      return y_base_ + t.component;
    case Source::increment:
      return v_base_ + t.age * d_ + t.component;
    case Source::unknown:
      return w_base_ + t.component;
    case Source::output:
      break;
  }
  const Outputs& o = outputs_[static_cast<std::size_t>(t.family)];
  return o.base + (t.age - o.oldest) * o.kernel->outputs() + t.output;
}

void RowEquations::add_term(RowSum& sum, const Term& t, double coefficient) const {
  if (coefficient == 0) return;
  if (t.source == Source::difference) sum.add_difference(index_of(t), t.shift, coefficient);
  else sum.add(index_of(t), t.shift, coefficient);
}

// ---- a step

void RowEquations::begin(std::int64_t n) {
  n_ = n;
  if (is_one_loop()) return;
  y_slots_.at(n);
  v_slots_.at(n);
  for (int a = 0; a < d_; ++a) {
    bases_[static_cast<std::size_t>(y_base_ + a)] = rows_.y_at(y_slots_(0), a);
    for (int age = 0; age < ages_; ++age)
      bases_[static_cast<std::size_t>(v_base_ + age * d_ + a)] = rows_.v_at(v_slots_(age), a);
  }
  for (Outputs& o : outputs_) {
    o.slots.at(n);
    const int count = o.kernel->outputs();
    for (int age = o.oldest; age <= o.newest; ++age)
      for (int c = 0; c < count; ++c)
        bases_[static_cast<std::size_t>(o.base + (age - o.oldest) * count + c)] = o.ring.row(o.slots(-age) * count + c);
  }
  for (int a = 0; a < d_; ++a) {
    const auto at = static_cast<std::size_t>(a);
    double *const v = rows_.v_at(v_slots_(-1), a), *const y = rows_.y_at(y_slots_(-1), a);
    RowIncrement& increment = increments_[at];
    increment.v_before = equations_.correction_form ? v : rows_.v_at(v_slots_(0), a);
    increment.y_before = rows_.y_at(y_slots_(0), a);
    increment.v = v, increment.y = y;
    bases_[static_cast<std::size_t>(E_base_ + a)] = y;
  }
  for (RowSum& sum : sums_) sum.bind(bases_.data());
  for (RowSum& sum : stored_) sum.bind(bases_.data());
}

int RowEquations::first_of_part(int part, int parts) const {
  if (part == 0 || part == parts) return part == 0 ? 0 : layout_.packs();
  return static_cast<int>(static_cast<long long>(part) * layout_.packs() / parts);
}

/// At the ends of the row that is its halo, which stays; in between it is a copy.
const double* RowEquations::edge(int part, int parts, int side, int a) const {
  const double* const y = loop_now_[static_cast<std::size_t>(a)];
  if (part == 0 && side == 0) return y + layout_.at(-loop_reach_);
  if (part + 1 == parts && side == 1) return y + layout_.at(layout_.packs());
  return edges_.row(0) + static_cast<std::ptrdiff_t>(((2 * part + side) * d_ + a) * loop_reach_) * lanes;
}

void RowEquations::begin_loop(int parts, bool in_place) {
  const bool known = loop_row_ == n_;
  if (in_place) rows_.overwrite_newest();
  for (int c = 0; c < d_; ++c) {
    const auto a = static_cast<std::size_t>(c);
    // Where rows lie takes divisions to find: a step in place after another goes on where that one was.
    if (known) loop_now_[a] = loop_y_[a], loop_v_before_[a] = loop_v_[a];
    if (known && in_place) continue;
    loop_y_[a] = rows_.y(n_ + 1, c), loop_v_[a] = rows_.v(n_ + 1, c);
    if (known) continue;
    loop_now_[a] = in_place ? loop_y_[a] : rows_.y(n_, c);
    loop_v_before_[a] = in_place ? loop_v_[a] : rows_.v(n_, c);
  }
  loop_row_ = n_ + 1;
  if (parts == 1) return;
  if (edges_.bytes() < edge_doubles(parts) * sizeof(double)) edges_ = RowBuffer(edge_doubles(parts));
  for (int boundary = 1; boundary < parts; ++boundary)
    for (int a = 0; a < d_; ++a) {
      const double* const y = loop_now_[static_cast<std::size_t>(a)] + layout_.at(first_of_part(boundary, parts));
      const int doubles_beside = loop_reach_ * lanes;
      std::copy_n(y, doubles_beside, const_cast<double*>(edge(boundary - 1, parts, 1, a)));
      std::copy_n(y - doubles_beside, doubles_beside, const_cast<double*>(edge(boundary, parts, 0, a)));
    }
}

double RowEquations::loop(int part, int parts) const {
  constexpr int most = RowKernel::most_components;
  const double *now[most], *v_before[most], *before[most], *after[most];
  double *v[most], *y[most];
  for (int a = 0; a < d_; ++a) {
    now[a] = loop_now_[static_cast<std::size_t>(a)];
    v_before[a] = loop_v_before_[static_cast<std::size_t>(a)];
    v[a] = loop_v_[static_cast<std::size_t>(a)];
    y[a] = loop_y_[static_cast<std::size_t>(a)];
    before[a] = edge(part, parts, 0, a);
    after[a] = edge(part, parts, 1, a);
  }
  return one_loop_->explicit_step({{&layout_, now, positions_.rows() ? positions_.row(0) : nullptr,
                                    static_cast<double>(n_) * time_step_, time_step_, space_step_},
                                   before,
                                   after,
                                   v_before,
                                   v,
                                   y,
                                   loop_linear_.data(),
                                   loop_nonlinear_.data()},
                                  {first_of_part(part, parts), first_of_part(part + 1, parts)});
}

void RowEquations::close_loop() {
  for (int a = 0; a < d_; ++a) layout_.fill_halo(loop_y_[static_cast<std::size_t>(a)], turn_);
}

void RowEquations::close_new_row() {
  for (int a = 0; a < d_; ++a) {
    double *const v = rows_.v_at(v_slots_(-1), a), *const y = rows_.y_at(y_slots_(-1), a);
    layout_.copy_overlaps(v);
    layout_.copy_overlaps(y);
    layout_.fill_halo(v);
    layout_.fill_halo(y, turn_);
  }
}

/// Wherever the equations of a pack read outputs: beyond the ends of arcs too.
PackRange RowEquations::where_read(const Outputs& o) const {
  if (turn_ != 0) return layout_.all();  // what is read across the seam is the site's own output, whatever the density
  return {o.lowest, layout_.packs() + o.highest};
}

/// The outputs of the stencils anchored `age` rows after row n, reading rows n + 1 − history … n + 1 and no others.
void RowEquations::evaluate(const Outputs& o, int age, double* const* out, At which, const PackRange& given) {
  PackRange packs = given;
  const std::int64_t anchor_row = n_ + age;
  const int newest = o.reads_unknown_row(age) ? 1 : 0;
  for (int t = o.first_time; t <= o.last_time; ++t)
    for (int a = 0; a < d_; ++a) {
      const int row = std::clamp(age + t, 1 - history_, newest);
      slab_rows_[static_cast<std::size_t>((t - o.first_time) * d_ + a)] =
          row == 1 && which == At::candidate ? candidate_.row(a)
          : is_one_loop()                    ? rows_.y(n_ + row, a)
                                             : rows_.y_at(y_slots_(-row), a);
    }
  if (o.family->pattern().placement == Placement::brick_wall) {
    packs.stride = 2;
    if ((packs.first + anchor_row) % 2 != 0) ++packs.first;
  }
  o.kernel->evaluate({&layout_, slab_rows_.data(), positions_.rows() ? positions_.row(0) : nullptr,
                      static_cast<double>(anchor_row) * time_step_, time_step_, space_step_},
                     out, packs);
  if (turn_ != 0)
    for (int c = 0; c < o.kernel->outputs(); ++c) layout_.fill_halo(out[c]);
}

void RowEquations::evaluate_outputs() {
  if (is_one_loop()) return;
  for (Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      if (!o.reads_unknown_row(age)) evaluate_in_ring(o, age, At::row);
}

void RowEquations::evaluate_unknown_outputs(At at) {
  for (Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      if (o.reads_unknown_row(age)) evaluate_in_ring(o, age, at);
}

void RowEquations::evaluate_in_ring(Outputs& o, int age, At at, const PackRange& packs) {
  const int count = o.kernel->outputs(), slot = o.slots(-age);
  for (int c = 0; c < count; ++c) slab_out_[static_cast<std::size_t>(c)] = o.ring.row(slot * count + c);
  evaluate(o, age, slab_out_.data(), at, packs);
}

void RowEquations::evaluate_known_outputs() {
  for (Outputs& o : outputs_)
    if (o.oldest <= o.newest && !o.reads_unknown_row(o.newest)) evaluate_in_ring(o, o.newest, At::row);
}

bool RowEquations::reads_unknown_row() const {
  return std::ranges::any_of(outputs_, [](const Outputs& o) { return o.rows() > 0 && o.reads_unknown_row(o.newest); });
}

/// −E of some packs: bricks differ by the parity of row + site.
void RowEquations::store_right_sides(const PackRange& packs) {
  const std::int64_t equation_row = n_ + 1 - equations_.bulk[0].shift;
  for (int a = 0; a < d_; ++a) {
    const auto at = static_cast<std::size_t>(a);
    double* const E = stored_right_side(a);
    const auto store = [E](std::ptrdiff_t to, Pack sum) __attribute__((always_inline)) { sum.store(E + to); };
    if (!bricks_) sums_[at].pass(layout_, packs, store);
    else
      for (int first = packs.first; first < packs.first + 2; ++first)
        sums_[2 * at + static_cast<std::size_t>((equation_row + first) % 2 != 0)].pass(layout_, {first, packs.last, 2},
                                                                                       store);
  }
}

RowEquations::Advance RowEquations::advance(bool compared) {
  const RowSum* right_sides[RowKernel::most_components];
  for (int a = 0; a < d_; ++a) {
    right_sides[a] = &right_side(a);
    RowLook& look = increments_[static_cast<std::size_t>(a)].look;
    look.parts = compared && looks_on_the_way_ ? static_cast<int>(looks_[0].parts.size()) : 0;
    look.expected = candidate_.row(a);
  }
  if (is_stored_) store_right_sides(layout_.all());
  if (!equations_.exceptional.empty()) set_exceptional_sites();
  const bool odd = solver_[1] && (n_ + 1) % 2 != 0;
  RowChange all = solver_[odd ? 1 : 0]->advance(layout_, d_, right_sides, increments_.data(), w_rows_.data());
  close_new_row();
  if (!compared) return {max_or_nan(all.largest), 0};
  if (!looks_on_the_way_) return {max_or_nan(all.largest), largest_change(looks_)};
  // What looks beyond the end.
  for (const RowIncrement& increment : increments_)
    for (int v = layout_.packs() + 1 - increment.look.parts; v < layout_.packs(); ++v) {
      Pack look(0.0);
      for (int p = 0; p < increment.look.parts; ++p) {
        const std::ptrdiff_t at = layout_.at(v + p);
        look += increment.look.weights[p] * (Pack::load(increment.y + at) - Pack::load(increment.look.expected + at));
      }
      all.change = max_or_nan(abs(look), all.change);
    }
  return {max_or_nan(all.largest), max_or_nan(all.change)};
}

RowEquations::Advance RowEquations::advance_streamed(const std::function<void(PackRange)>& find) {
  Outputs& o = outputs_[0];
  const int packs = layout_.packs(), halo = layout_.halo();
  const PackRange read = where_read(o);
  int reach = 0;
  for (const Argument& look : looks_)
    for (const Argument::Part& part : look.parts) reach = std::max(reach, part.vertex.space);

  const auto stream = solver_[0]->stream(layout_, right_side(0), increments_[0]);
  const PackRange last = stream->last_packs();
  const int window = window_packs(last);
  if (last.first < last.last) {
    if (find) {
      candidate_.hold_window(window, last.first - halo, 0);
      find({last.first - halo, packs + halo});
    }
    evaluate_in_ring(o, o.newest, At::candidate, {last.first + o.lowest, read.last});
    if (is_stored_) store_right_sides(last);
  }
  stream->begin();
  if (find) {
    candidate_.hold_window(window, -halo, 0);
    find({-halo, halo});
  }
  int found = halo, evaluated = read.first, stored = 0, changed = 0;
  double change = 0;
  for (int end = 0; end < packs;) {
    end = packs - end < 2 * strip ? packs : end + strip;
    const bool all = end == packs;
    if (find) {
      candidate_.hold_window(window, std::max(-halo, changed - 2 * halo), found);
      find({found, all ? packs + halo : end + halo});
    }
    found = end + halo;
    evaluate_in_ring(o, o.newest, At::candidate, {evaluated, all ? read.last : end + o.highest});
    evaluated = end + o.highest;
    if (is_stored_) store_right_sides({stored, end});
    stored = end;
    const int done = stream->advance(end);
    if (!all && done - reach > changed) {
      change = larger_or_nan(largest_change(looks_, {changed, done - reach}), change);
      changed = done - reach;
    }
  }
  close_new_row();
  return {stream->largest(), larger_or_nan(largest_change(looks_, {changed, packs}), change)};
}

void RowEquations::make_row_the_candidate() {
  candidate_.hold_whole();
  for (int a = 0; a < d_; ++a) std::copy_n(rows_.y_at(y_slots_(-1), a), layout_.doubles(), candidate_.row(a));
}

namespace {

/// max |Σ_p weight_p (y − z)(shifted by p)| for a number of parts that is known.
template <int count>
Pack largest_difference(const RowLayout& layout, PackRange packs, const Argument& look, const double* y,
                        const double* z) {
  const double *above[count], *below[count];
  double weight[count];
  for (int p = 0; p < count; ++p) {
    const auto& part = look.parts[static_cast<std::size_t>(p)];
    const std::ptrdiff_t shift = static_cast<std::ptrdiff_t>(part.vertex.space) * lanes;
    above[p] = y + shift, below[p] = z + shift, weight[p] = part.weight;
  }
  const auto difference = [&](int v) {
    const std::ptrdiff_t at = layout.at(v);
    Pack sum(0.0);
    for (int p = 0; p < count; ++p) sum += weight[p] * (Pack::load(above[p] + at) - Pack::load(below[p] + at));
    return abs(sum);
  };
  // Two at a time: a maximum waits for the one before it.
  Pack largest(0.0), other(0.0);
  int v = packs.first;
  for (; v + 1 < packs.last; v += 2) {
    largest = max_or_nan(difference(v), largest);
    other = max_or_nan(difference(v + 1), other);
  }
  if (v < packs.last) largest = max_or_nan(difference(v), largest);
  return max_or_nan(other, largest);
}

}  // namespace

double RowEquations::largest_change(const std::vector<Argument>& looks, PackRange packs) const {
  Pack largest(0.0);
  for (const Argument& look : looks)
    for (int a = 0; a < d_; ++a) {
      const double *y = rows_.y_at(y_slots_(-1), a), *z = candidate_.row(a);
      switch (look.parts.size()) {
        case 1:
          largest = max_or_nan(largest_difference<1>(layout_, packs, look, y, z), largest);
          break;
        case 2:
          largest = max_or_nan(largest_difference<2>(layout_, packs, look, y, z), largest);
          break;
        default:
          largest = max_or_nan(largest_difference<3>(layout_, packs, look, y, z), largest);
          break;
      }
    }
  return max_or_nan(largest);
}

/// The pass over whole rows has left the bulk's equation at these sites: puts their own sums in its place.
void RowEquations::set_exceptional_sites() {
  for (const SiteEquation& special : equations_.exceptional) {
    const double E = value_at(special, false, nullptr);
    for (int slot : layout_.slots_of(special.site)) stored_right_side(special.component)[slot] = -E;
  }
}

/// E at one site, by its own terms.
double RowEquations::value_at(const SiteEquation& special, bool unknown_too, double* absolute) const {
  const int own = layout_.slot(special.site), a = special.component;
  if (special.fixed) {
    // v_{n+1} = v_n + w = 0; where w corrects the candidate, v_{n+1} is the candidate's
    if (equations_.correction_form || unknown_too) return rows_.v_at(v_slots_(-1), a)[own];
    return rows_.v_at(v_slots_(0), a)[own];
  }
  const EquationTerms& equation = special.equation;
  const double sign = (n_ + 1 - equation.shift + special.site) % 2 == 0 ? 1 : -1;
  double value = equation.constant + sign * equation.constant_alternating;
  for (const Term& t : equation.terms) {
    if (t.source == Source::unknown && !unknown_too) continue;
    const double* row = bases_[static_cast<std::size_t>(index_of(t))];
    const int beside = layout_.slot(std::clamp(special.site + t.shift, 0, layout_.sites() - 1));
    const double x =
        (t.coefficient + sign * t.alternating) * (row[beside] - (t.source == Source::difference ? row[own] : 0));
    value += x;
    if (absolute) *absolute += std::abs(x);
  }
  return value;
}

namespace {

struct LargestTerms {
  Pack sum = 0.0, absolute = 0.0;
  [[gnu::always_inline]] void operator()(std::ptrdiff_t, Pack s, Pack a) {
    sum = max_or_nan(abs(s), sum);
    absolute = max_or_nan(a, absolute);
  }
};

}  // namespace

double RowEquations::residual(std::int64_t n) {
  begin(n);
  for (int a = 0; a < d_; ++a) {
    bases_[static_cast<std::size_t>(y_base_ + a)] = rows_.y(n, a);
    for (int age = 0; age < ages_; ++age)
      bases_[static_cast<std::size_t>(v_base_ + age * d_ + a)] = rows_.v(n - age, a);
  }
  // A step goes on from the outputs of its last iterate: what is taken here from the accepted row goes elsewhere, or a
  // run would depend on when it was looked at. The oldest rows, which the next step writes over, are room where nothing
  // reads them: the increment unless there are seeds, y in one loop.
  if (!scratch_.rows() && residual_rows() > 0) scratch_ = RowBuffer(layout_, residual_rows());
  for (int a = 0; a < d_; ++a) {
    double* const w = has_spare_increment() ? rows_.v(n + 2 - rows_.increments_held(), a) : scratch_.row(a);
    const double *v_new = rows_.v(n + 1, a), *v = rows_.v(n, a);
    for (std::size_t s = 0; s < layout_.doubles(); ++s) w[s] = v_new[s] - v[s];
    bases_[static_cast<std::size_t>(w_base_ + a)] = w;
  }
  const int first = scratch_rows_of_sums();
  int next = first - (is_one_loop() ? d_ : 0);
  for (const Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age) {
      if (!o.reads_unknown_row(age) && !is_one_loop()) continue;
      const int count = o.kernel->outputs();
      for (int c = 0; c < count; ++c, ++next) {
        slab_out_[static_cast<std::size_t>(c)] =
            next < first ? rows_.y(n + 2 - rows_.rows_held(), next - first + d_) : scratch_.row(next);
        bases_[static_cast<std::size_t>(o.base + (age - o.oldest) * count + c)] =
            slab_out_[static_cast<std::size_t>(c)];
      }
      evaluate(o, age, slab_out_.data(), At::row, where_read(o));
    }

  const std::int64_t equation_row = n_ + 1 - equations_.bulk[0].shift;
  const auto measure = [&](int a, const auto& consume) {
    const auto pass = [&](int pack, const auto& with) {
      const auto at = static_cast<std::size_t>(bricks_ ? 2 * a + ((equation_row + pack) % 2 != 0 ? 1 : 0) : a);
      measured_[at].bind(bases_.data());
      return measured_[at].measure(layout_, {pack, layout_.packs(), bricks_ ? 2 : 1}, with);
    };
    return bricks_ ? pass(1, pass(0, consume)) : pass(0, consume);
  };
  LargestTerms all;
  for (int a = 0; a < d_; ++a) {
    if (equations_.exceptional.empty()) {
      all = measure(a, all);
      continue;
    }
    // Sites near walls have their own sums, in the place of the bulk's.
    const int of_w = has_spare_increment() ? 0 : d_;
    double *const E = scratch_.row(of_w + a), *const size = scratch_.row(of_w + d_ + a);
    measure(a, [E, size](std::ptrdiff_t to, Pack sum, Pack absolute) {
      sum.store(E + to);
      absolute.store(size + to);
    });
    for (const SiteEquation& special : equations_.exceptional) {
      if (special.component != a) continue;
      double absolute = 0;
      const double value = value_at(special, true, &absolute);
      for (int slot : layout_.slots_of(special.site)) E[slot] = value, size[slot] = absolute;
    }
    for (int v = 0; v < layout_.packs(); ++v) all(0, Pack::load(E + layout_.at(v)), Pack::load(size + layout_.at(v)));
  }
  const double size = max_or_nan(all.absolute);
  return size != 0 ? max_or_nan(all.sum) / size : 0;
}

/// w; near walls E and Σ|terms| too.
int RowEquations::scratch_rows_of_sums() const {
  return (has_spare_increment() ? 0 : d_) + (equations_.exceptional.empty() ? 0 : 2 * d_);
}

/// And outputs, the first of which stand where one loop has a y to spare.
int RowEquations::residual_rows() const {
  int rows = scratch_rows_of_sums() - (is_one_loop() ? d_ : 0);
  for (const Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      if (o.reads_unknown_row(age) || is_one_loop()) rows += o.kernel->outputs();
  return std::max(rows, 0);
}

std::size_t RowEquations::bytes_to_come(int parts, bool residual) const {
  const auto missing = [](std::size_t doubles, std::size_t there) {
    return doubles * sizeof(double) > there ? doubles * sizeof(double) - there : 0;
  };
  std::size_t total = missing(edge_doubles(parts), edges_.bytes());
  if (residual) total += missing(static_cast<std::size_t>(residual_rows()) * layout_.doubles(), scratch_.bytes());
  if (is_streamed_) {
    // First steps, whose seeds are of low order, iterate: their candidate is whole.
    const PackRange last = solver_[0]->stream(layout_, right_side(0), {})->last_packs();
    total += missing(static_cast<std::size_t>(window_packs(last)) * lanes + layout_.doubles(), candidate_.bytes());
  }
  return total;
}

std::size_t RowEquations::output_bytes() const {
  std::size_t total = 0;
  for (const Outputs& o : outputs_) total += o.ring.bytes();
  return total;
}
std::size_t RowEquations::matrix_bytes() const { return solver_[0]->bytes() + (solver_[1] ? solver_[1]->bytes() : 0); }
std::size_t RowEquations::work_bytes() const {
  std::size_t total = layout_.bytes();
  for (const RowBuffer* b : {&w_, &scratch_, &positions_, &edges_}) total += b->bytes();
  return total + candidate_.bytes();
}

}  // namespace delf
