// SPDX-License-Identifier: MIT
#include "schemes/row_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace delf {

RowEquations::RowEquations(const LatticeSystem& system, const SolvePlan& plan, SectionRows& rows, int history)
    : system_(system), rows_(rows), layout_(rows.layout()), d_(system.components()), history_(history),
      bricks_(system.placement() == Placement::brick_wall), equations_(assemble(system, plan)), w_(layout_, d_),
      E_(layout_, d_), kept_(layout_, d_), solver_in_(static_cast<std::size_t>(d_)),
      solver_out_(static_cast<std::size_t>(d_)) {
  build_outputs();
  build_solvers();
  build_marks();
}

// ---- set-up

void RowEquations::build_outputs() {
  for (std::size_t f = 0; f < system_.families().size(); ++f) {
    const StencilFamily* family = system_.families()[f].get();
    Outputs o{.family = family, .kernel = family->row_kernel(), .ring = {}, .absent = {}};
    const auto& vertices = o.family->pattern().vertices;
    o.first_time = std::ranges::min(vertices, {}, &Site::time).time;
    o.last_time = std::ranges::max(vertices, {}, &Site::time).time;
    o.oldest = std::numeric_limits<int>::max();
    o.newest = std::numeric_limits<int>::min();
    const auto scan = [&](const EquationTerms& equation) {
      for (const Term& t : equation.terms)
        if (t.source == Source::output && t.family == static_cast<int>(f))
          o.oldest = std::min(o.oldest, t.age), o.newest = std::max(o.newest, t.age);
    };
    for (const auto& equation : equations_.bulk) scan(equation);
    for (const auto& special : equations_.exceptional) scan(special.equation);
    if (o.oldest > o.newest) o.oldest = 0, o.newest = -1;
    o.ring = RowBuffer(layout_, (o.newest - o.oldest + 1) * o.kernel->outputs());
    const int N = layout_.sites();
    if (!system_.lattice().is_circle())
      for (int i = 0; i < N; ++i)
        if (std::ranges::any_of(vertices, [&](Site s) { return i + s.space < 0 || i + s.space >= N; }))
          for (int slot : layout_.slots_of(i)) o.absent.push_back(slot);
    slab_rows_.resize(std::max(slab_rows_.size(), static_cast<std::size_t>((o.last_time - o.first_time + 1) * d_)));
    slab_out_.resize(std::max(slab_out_.size(), static_cast<std::size_t>(o.kernel->outputs())));
    outputs_.push_back(std::move(o));
  }
}

void RowEquations::build_solvers() {
  const Lattice& lattice = system_.lattice();
  bool alternating = false;
  for (const auto& row : equations_.unknowns)
    for (const UnknownEntry& e : row) alternating = alternating || e.alternating != 0;
  for (const auto& special : equations_.exceptional)
    for (const UnknownEntry& e : special.unknowns) alternating = alternating || e.alternating != 0;
  if (lattice.is_circle() && d_ == 1 && !alternating) {
    std::vector<BandEntry> stencil;
    for (const UnknownEntry& e : equations_.unknowns[0]) stencil.push_back({e.space, e.coefficient});
    solver_[0] = factor_uniform(lattice, layout_, stencil);
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

void RowEquations::build_marks() {
  std::vector<double> site(static_cast<std::size_t>(layout_.sites()));
  if (std::ranges::any_of(system_.families(), [](const auto& f) { return f->is_placed(); })) {
    positions_ = RowBuffer(layout_, 1);
    for (int i = 0; i < layout_.sites(); ++i) site[static_cast<std::size_t>(i)] = system_.lattice().position(i);
    layout_.scatter(site, positions_.row(0));
  }
  if (bricks_) {
    signs_ = RowBuffer(layout_, 1);
    for (int i = 0; i < layout_.sites(); ++i) site[static_cast<std::size_t>(i)] = i % 2 == 0 ? 1 : -1;
    layout_.scatter(site, signs_.row(0));
  }
}

// ---- the nonlinear part

double* RowEquations::Outputs::row(std::int64_t anchor_row, int c) {
  const int count = newest - oldest + 1;
  return ring.row(static_cast<int>(((anchor_row % count) + count) % count) * kernel->outputs() + c);
}

/// The outputs of the stencils anchored at a row, reading rows oldest … newest and no others.
void RowEquations::evaluate(Outputs& o, std::int64_t anchor_row, std::int64_t oldest, std::int64_t newest) {
  const double h = system_.time_step();
  for (int t = o.first_time; t <= o.last_time; ++t)
    for (int a = 0; a < d_; ++a)
      slab_rows_[static_cast<std::size_t>((t - o.first_time) * d_ + a)] =
          rows_.y(std::clamp(anchor_row + t, oldest, newest), a);
  const int count = o.kernel->outputs();
  for (int c = 0; c < count; ++c) slab_out_[static_cast<std::size_t>(c)] = o.row(anchor_row, c);
  o.kernel->evaluate({&layout_, slab_rows_.data(), positions_.rows() ? positions_.row(0) : nullptr,
                      static_cast<double>(anchor_row) * h, h, system_.lattice().space_step()},
                     slab_out_.data());
  for (int c = 0; c < count; ++c) {
    double* out = slab_out_[static_cast<std::size_t>(c)];
    for (int slot : o.absent) out[slot] = 0;
    if (o.family->pattern().placement == Placement::brick_wall) {
      const double sign = anchor_row % 2 == 0 ? 0.5 : -0.5;
      for (int p = 0; p < layout_.packs(); ++p) {
        const auto at = layout_.at(p);
        (Pack::load(out + at) * (0.5 + sign * Pack::load(signs_.row(0) + at))).store(out + at);
      }
    }
    layout_.fill_halo(out);
  }
}

void RowEquations::evaluate_outputs(std::int64_t n, bool reading_unknown_row) {
  for (Outputs& o : outputs_)
    for (int age = o.oldest; age <= o.newest; ++age)
      if (o.reads_unknown_row(age) == reading_unknown_row)
        evaluate(o, n + age, n + 1 - history_, reading_unknown_row ? n + 1 : n);
}

void RowEquations::evaluate_known_outputs(std::int64_t n) {
  for (Outputs& o : outputs_)
    if (o.oldest <= o.newest && !o.reads_unknown_row(o.newest)) evaluate(o, n + o.newest, n + 1 - history_, n);
}

// ---- the equations, row by row

bool RowEquations::belongs(const Term& t, int parts) const {
  if (t.source == Source::unknown) return parts & unknown;
  if (t.source == Source::output && outputs_[static_cast<std::size_t>(t.family)].reads_unknown_row(t.age))
    return parts & fresh;
  return parts & known;
}

const double* RowEquations::row_of(const Term& t, std::int64_t n) {
  switch (t.source) {
    case Source::difference:
    case Source::value: return rows_.y(n, t.component);
    case Source::increment: return rows_.v(n - t.age, t.component);
    case Source::unknown: return w_.row(t.component);
    case Source::output: return outputs_[static_cast<std::size_t>(t.family)].row(n + t.age, t.output);
  }
  return nullptr;
}

void RowEquations::clear() {
  for (int a = 0; a < d_; ++a) std::fill_n(E_.row(a), layout_.doubles(), 0.0);
  exceptional_.assign(equations_.exceptional.size(), 0.0);
}

void RowEquations::keep() {
  for (int a = 0; a < d_; ++a) std::copy_n(E_.row(a), layout_.doubles(), kept_.row(a));
  kept_exceptional_ = exceptional_;
}

void RowEquations::restore() {
  for (int a = 0; a < d_; ++a) std::copy_n(kept_.row(a), layout_.doubles(), E_.row(a));
  exceptional_ = kept_exceptional_;
}

void RowEquations::add(std::int64_t n, int parts, bool measure) {
  if (measure) {
    if (!absolute_.rows()) absolute_ = RowBuffer(layout_, d_);
    for (int a = 0; a < d_; ++a) std::fill_n(absolute_.row(a), layout_.doubles(), 0.0);
  }
  for (int a = 0; a < d_; ++a) {
    const EquationTerms& equation = equations_.bulk[static_cast<std::size_t>(a)];
    sum_.clear();
    const double parity = (n + 1 - equation.shift) % 2 == 0 ? 1 : -1;
    for (const Term& t : equation.terms)
      if (belongs(t, parts))
        sum_.add(row_of(t, n), static_cast<std::ptrdiff_t>(t.shift) * lanes, t.coefficient, parity * t.alternating,
                 t.source == Source::difference);
    const bool constant = parts & known;
    sum_.evaluate(layout_, constant ? equation.constant : 0, constant ? parity * equation.constant_alternating : 0,
                  bricks_ ? signs_.row(0) : nullptr, E_.row(a), measure ? absolute_.row(a) : nullptr);
  }
  if (!equations_.exceptional.empty()) add_at_exceptional_sites(n, parts, measure);
}

int RowEquations::slot_beside(int site, int shift) const {
  return layout_.slot(std::clamp(site + shift, 0, layout_.sites() - 1));
}

/// The pass over whole rows has left the bulk's equation at these sites: puts their own sums in its place.
void RowEquations::add_at_exceptional_sites(std::int64_t n, int parts, bool measure) {
  for (std::size_t e = 0; e < equations_.exceptional.size(); ++e) {
    const SiteEquation& special = equations_.exceptional[e];
    const int own = layout_.slot(special.site), a = special.component;
    double value = 0, size = 0;
    if (special.fixed) {
      // v_{n+1} = v_n + w = 0; where w corrects the candidate, v_{n+1} is the candidate's
      if (equations_.correction_form) {
        if (parts & fresh) value += rows_.v(n + 1, a)[own];
      } else {
        if (parts & known) value += rows_.v(n, a)[own];
        if (parts & unknown) value += w_.row(a)[own];
      }
    } else {
      const EquationTerms& equation = special.equation;
      const double sign = (n + 1 - equation.shift + special.site) % 2 == 0 ? 1 : -1;
      if (parts & known) value += equation.constant + sign * equation.constant_alternating;
      for (const Term& t : equation.terms) {
        if (!belongs(t, parts)) continue;
        const double* row = row_of(t, n);
        const double x = row[slot_beside(special.site, t.shift)] - (t.source == Source::difference ? row[own] : 0);
        value += (t.coefficient + sign * t.alternating) * x;
        size += std::abs((t.coefficient + sign * t.alternating) * x);
      }
    }
    exceptional_[e] += value;
    for (int slot : layout_.slots_of(special.site)) {
      E_.row(a)[slot] = exceptional_[e];
      if (measure) absolute_.row(a)[slot] = size;
    }
  }
}

void RowEquations::solve(std::int64_t n) {
  for (int a = 0; a < d_; ++a) {
    double* E = E_.row(a);
    for (int p = 0; p < layout_.packs(); ++p) {
      const auto at = layout_.at(p);
      (-Pack::load(E + at)).store(E + at);
    }
    solver_in_[static_cast<std::size_t>(a)] = E;
    solver_out_[static_cast<std::size_t>(a)] = w_.row(a);
  }
  (solver_[1] && (n + 1) % 2 != 0 ? solver_[1] : solver_[0])->solve(solver_in_.data(), solver_out_.data());
  for (int a = 0; a < d_; ++a) layout_.copy_overlaps(w_.row(a));
}

double RowEquations::residual(std::int64_t n) {
  for (int a = 0; a < d_; ++a)
    for (std::size_t s = 0; s < layout_.doubles(); ++s) w_.row(a)[s] = rows_.v(n + 1, a)[s] - rows_.v(n, a)[s];
  // A step goes on from the outputs of its last iterate: what is taken here from the accepted row must not stay, or a
  // run would depend on when it was looked at.
  std::vector<std::vector<double>> before;
  const auto each_fresh_output = [&](const auto& f) {
    for (Outputs& o : outputs_)
      for (int age = o.oldest; age <= o.newest; ++age)
        for (int c = 0; c < o.kernel->outputs() && o.reads_unknown_row(age); ++c) f(o.row(n + age, c));
  };
  each_fresh_output([&](const double* row) { before.emplace_back(row, row + layout_.doubles()); });
  evaluate_outputs(n, true);
  clear();
  add(n, known | fresh | unknown, true);
  std::size_t next = 0;
  each_fresh_output([&](double* row) { std::ranges::copy(before[next++], row); });

  double worst = 0, size = 0;
  for (int a = 0; a < d_; ++a)
    for (int i = 0; i < layout_.sites(); ++i) {
      worst = std::max(worst, std::abs(E_.row(a)[layout_.slot(i)]));
      size = std::max(size, absolute_.row(a)[layout_.slot(i)]);
    }
  return size > 0 ? worst / size : 0;
}

std::size_t RowEquations::output_bytes() const {
  std::size_t total = 0;
  for (const Outputs& o : outputs_) total += o.ring.bytes();
  return total;
}
std::size_t RowEquations::matrix_bytes() const {
  return solver_[0]->bytes() + (solver_[1] ? solver_[1]->bytes() : 0);
}
std::size_t RowEquations::work_bytes() const {
  std::size_t total = layout_.bytes();
  for (const RowBuffer* b : {&w_, &E_, &kept_, &absolute_, &positions_, &signs_}) total += b->bytes();
  return total;
}

}  // namespace delf
