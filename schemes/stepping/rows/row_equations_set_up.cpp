// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_equations.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace delf {

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
    o.held = o.rows();
    o.slots = RingSlots(std::max(1, o.held));
    if (!is_one_loop()) o.ring = RowBuffer(layout_, o.rows() * o.kernel->outputs());
    slab_rows_.resize(std::max(slab_rows_.size(), static_cast<std::size_t>((o.last_time - o.first_time + 1) * d_)));
    slab_out_.resize(std::max(slab_out_.size(), static_cast<std::size_t>(o.kernel->outputs())));
    has_known_outputs_ = has_known_outputs_ || (o.oldest <= o.newest && !o.reads_unknown_row(o.newest));
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
    if (t.source == Source::unknown) measured_reach_ = std::max(measured_reach_, std::abs(t.shift));
  });
  y_base_ = 0;
  v_base_ = d_;
  int next = v_base_ + ages_ * d_;
  for (Outputs& o : outputs_) {
    o.base = next;
    next += o.rows() * o.kernel->outputs();
  }
  E_base_ = next;
  v_new_base_ = next + d_;
  next = v_new_base_ + d_;
  for (Outputs& o : outputs_) {
    o.measured_base = next;
    next += o.measured_rows();
  }
  own_.bases.resize(static_cast<std::size_t>(next));
  oldest_value_ = 1 - history_;
  for (const Outputs& o : outputs_) {
    oldest_value_ = std::min(oldest_value_, o.oldest + o.first_time);
    newest_value_ = std::max(newest_value_, o.newest + o.last_time);
  }
  own_.values.resize(value_index(newest_value_ + 1));

  is_stored_ = solver_[1] || !equations_.exceptional.empty();
  for (int a = 0; a < d_; ++a) {
    const EquationTerms& equation = equations_.bulk[static_cast<std::size_t>(a)];
    for (int parity = 0; parity < (bricks_ ? 2 : 1); ++parity) {
      const double sign = parity == 0 ? 1 : -1;
      RowSum known, all;
      for (const Term& t : equation.terms) {
        if (bricks_ && !brick_exists(t, equation.shift, parity)) continue;
        const double coefficient = t.coefficient + sign * t.alternating;
        add_term(all, t, coefficient, true);
        if (t.source != Source::unknown) add_term(known, t, coefficient, false);
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
  for (auto* sums : {&sums_, &stored_, &measured_})
    for (RowSum& sum : *sums) sum.bind(summed_);
  for (auto* sums : {&sums_, &measured_})
    for (std::size_t first = 0; bricks_ && first < sums->size(); first += 2)
      (*sums)[first].take_turns_with((*sums)[first + 1]);
  for (int a = 0; a < d_; ++a)
    right_sides_.push_back(is_stored_ ? &stored_[static_cast<std::size_t>(a)] : &sums_[first_sum(a)]);
  if (is_one_loop()) return;
  if (solver_[0]->needs_work_rows() || equations_.correction_form) w_ = RowBuffer(layout_, d_);
  for (int a = 0; a < d_; ++a) w_rows_.push_back(w_.rows() ? w_.row(a) : nullptr);
  own_.increments.resize(static_cast<std::size_t>(d_));
  for (RowIncrement& rows : own_.increments) rows.turn = turn_;
}

/// Whether the term's brick is there, for an equation whose row + site has this parity.
bool RowEquations::brick_exists(const Term& t, int equation_shift, int parity) const {
  if (t.source != Source::output) return true;
  const bool bricks = outputs_[static_cast<std::size_t>(t.family)].family->pattern().placement == Placement::brick_wall;
  return !bricks || (parity + t.age - 1 + equation_shift + t.shift) % 2 == 0;
}

int RowEquations::index_of(const Term& t, bool measured) const {
  switch (t.source) {
    case Source::difference:
    case Source::value:
      return y_base_ + t.component;
    case Source::increment:
      return v_base_ + t.age * d_ + t.component;
    case Source::unknown:
      return v_new_base_ + t.component;
    case Source::output:
      break;
  }
  const Outputs& o = outputs_[static_cast<std::size_t>(t.family)];
  return measured && o.reads_unknown_row(t.age) ? o.measured_index(t.age, t.output) : o.index(t.age, t.output);
}

void RowEquations::add_term(RowSum& sum, const Term& t, double coefficient, bool measured) const {
  if (coefficient == 0) return;
  const int row = index_of(t, measured);
  if (t.source == Source::unknown) sum.add_change(row, v_base_ + t.component, t.shift, coefficient);  // w
  else if (t.source == Source::difference) sum.add_difference(row, t.shift, coefficient);
  else sum.add(row, t.shift, coefficient);
}

}  // namespace delf
