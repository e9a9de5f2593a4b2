// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

constexpr std::size_t most_values = 32;  // that a group of source terms reads, or gives

}  // namespace

RowTable::Ring RowTable::add(const RowLayout& layout, int held, int width) {
  const Ring ring{static_cast<int>(rows_.size()), held, width};
  memory_.push_back(std::make_shared<RowBuffer>(layout, held * width));
  for (int r = 0; r < held * width; ++r) rows_.push_back(memory_.back()->row(r));
  if (held == 0) rows_.resize(rows_.size() + at(width), nullptr);
  return ring;
}
void RowTable::advance(const Ring& ring) {
  const auto first = rows_.begin() + ring.first, last = first + ring.held * ring.width;
  std::rotate(first, last - ring.width, last);
}
void RowTable::go_back(const Ring& ring) {
  const auto first = rows_.begin() + ring.first;
  std::rotate(first, first + ring.width, first + ring.held * ring.width);
}

RowEquations::RowEquations(const LatticeSystem& system, const SolvePlan& plan, const RowLayout& layout, RowTable& table,
                           int history, int source_rows)
    : system_(system),
      layout_(layout),
      d_(system.components()),
      bricks_(system.placement() == Placement::brick_wall),
      equations_(assemble(system, plan)),
      most_rows_(source_rows) {
  build_solvers();
  int ages = 2;
  for (const EquationTerms& equation : equations_.bulk)
    for (const Term& t : equation.terms)
      if (t.source == Source::increment) ages = std::max(ages, t.age + 1);
  for (const SiteEquation& special : equations_.exceptional)
    for (const Term& t : special.equation.terms)
      if (t.source == Source::increment) ages = std::max(ages, t.age + 1);
  y_ = table.add(layout, history + 1, d_);
  v_ = table.add(layout, std::max(ages, history) + 1, d_);
  build_rows(table, source_rows);
  build_sums();
  if (std::ranges::any_of(system.families(), [](const auto& f) { return f->is_placed(); })) {
    std::vector<double> x;
    for (int i = 0; i < layout.sites(); ++i) x.push_back(system.lattice().position(i));
    positions_ = RowBuffer(layout, 1);
    layout.scatter(x, positions_.row(0));
  }
}

void RowEquations::build_solvers() {
  const Lattice& lattice = system_.lattice();
  bool coupled = false, alternating = false;
  for (std::size_t a = 0; a < equations_.unknowns.size(); ++a)
    for (const UnknownEntry& e : equations_.unknowns[a]) {
      coupled = coupled || e.component != static_cast<int>(a);
      alternating = alternating || e.alternating != 0;
    }
  if (!has_walls() && !coupled && !alternating) {
    std::vector<std::unique_ptr<LinearSolver>> solvers;
    for (const auto& unknowns : equations_.unknowns) {
      std::vector<BandEntry> stencil;
      for (const UnknownEntry& e : unknowns) stencil.push_back({e.space, e.coefficient});
      solvers.push_back(factor_uniform(lattice, layout_, stencil));
    }
    solver_[0] = by_component(std::move(solvers));
    return;
  }
  const auto see = [this](const std::vector<UnknownEntry>& unknowns) {
    for (const UnknownEntry& e : unknowns) wall_scale_ = std::max(wall_scale_, std::abs(e.coefficient));
  };
  std::ranges::for_each(equations_.unknowns, see);
  for (const SiteEquation& s : equations_.exceptional) see(s.unknowns);
  if (wall_scale_ == 0) wall_scale_ = 1;  // of two fixed walls alone
  for (int parity = 0; parity < (alternating ? 2 : 1); ++parity) {
    std::vector<MatrixEntry> entries;
    std::set<std::pair<int, int>> special;
    const auto add = [&](int i, int a, int shift, const std::vector<UnknownEntry>& unknowns) {
      // The step is from a row of this parity; the equation sits `shift` rows below the unknown one.
      const double sign = (parity + 1 - shift + i) % 2 == 0 ? 1 : -1;
      for (const UnknownEntry& e : unknowns) {
        const int column = lattice.home(i + e.space);
        entries.push_back({i * d_ + a, column * d_ + e.component, e.coefficient + sign * e.alternating});
      }
    };
    for (const auto& s : equations_.exceptional) {
      special.insert({s.site, s.component});
      if (s.fixed) entries.push_back({s.site * d_ + s.component, s.site * d_ + s.component, wall_scale_});
      else add(s.site, s.component, s.equation.shift, s.unknowns);
    }
    for (int i = 0; i < layout_.sites(); ++i)
      for (int a = 0; a < d_; ++a)
        if (!special.contains({i, a})) add(i, a, equations_.bulk[a].shift, equations_.unknowns[a]);
    solver_[parity] = factor(lattice, layout_, d_, entries);
  }
}

void RowEquations::build_rows(RowTable& table, int source_rows) {
  for (std::size_t f = 0; f < system_.families().size(); ++f) {
    const StencilFamily& family = *system_.families()[f];
    const SourceTerms& terms = *family.sources();
    if (terms.groups.empty()) continue;
    const bool bricks = family.pattern().placement == Placement::brick_wall;
    for (int c = 0; c < terms.outputs(); ++c) {
      SourceRow row{.family = static_cast<int>(f),
                    .group = c / terms.outputs_per_group,
                    .component = c % terms.outputs_per_group,
                    .ring = {},
                    .stride = bricks ? 2 : 1};
      int oldest = std::numeric_limits<int>::max(), newest = std::numeric_limits<int>::min();
      const auto scan = [&](const EquationTerms& equation) {
        for (const Term& t : equation.terms)
          if (t.source == Source::output && t.family == row.family && t.output / terms.outputs_per_group == row.group) {
            oldest = std::min(oldest, t.age), newest = std::max(newest, t.age);
            row.lowest = std::min(row.lowest, t.shift), row.highest = std::max(row.highest, t.shift);
          }
      };
      for (const auto& equation : equations_.bulk) scan(equation);
      const bool in_bulk = oldest <= newest;
      for (const auto& special : equations_.exceptional) scan(special.equation);
      if (oldest > newest) oldest = newest = 0;
      row.oldest = oldest, row.newest = newest;
      row.reads_unknown = newest + terms.groups[row.group].latest_time() >= 1;
      find_packs(row, in_bulk || row.reads_unknown);
      row.is_local =
          !row.reads_unknown && oldest == newest && row.lowest == 0 && row.highest == 0 && !bricks && !has_walls();
      const int held = std::max(newest - oldest + 1, row.reads_unknown ? source_rows * row.stride + 1 : 1);
      row.ring = table.add(layout_, row.is_local ? 0 : held);
      if (row.reads_unknown) row.correction = table.add(layout_, 1).first;
      row.outputs = terms.outputs_per_group;
      if (std::max(terms.groups[row.group].inputs.size(), at(row.outputs)) > most_values)
        throw NoConvergence("source terms of so many values go slab by slab");
      iterates_ = iterates_ || row.reads_unknown;
      sources_.push_back(row);

      inputs_.push_back(make_inputs(terms.groups[row.group], sources_.back()));
    }
  }
}

/// The term of a natural wall is read there alone, and evaluated nowhere else.
void RowEquations::find_packs(SourceRow& row, bool everywhere) const {
  row.first_pack = everywhere ? 0 : layout_.packs();
  row.last_pack = everywhere ? layout_.packs() : 0;
  if (everywhere) return;
  for (const SiteEquation& special : equations_.exceptional)
    for (const Term& t : special.equation.terms)
      if (t.source == Source::output && t.family == row.family) {
        const int pack = layout_.slot(special.site + t.shift) / lanes - layout_.halo();
        row.first_pack = std::min(row.first_pack, pack), row.last_pack = std::max(row.last_pack, pack + 1);
      }
}

/// Quadrature values as sums of rows. Rows before the newest that is read are taken from it and the increments,
/// y_{j−1} = y_j − v_j, so that they may have been written over.
RowEquations::Inputs RowEquations::make_inputs(const SourceTerms::Group& group, SourceRow& row) {
  Inputs inputs{.family = system_.families()[row.family].get(),
                .values = {},
                .single_rows = {},
                .unknown = {},
                .outputs = row.outputs,
                .time = group.time,
                .space = group.space};
  int newest = std::numeric_limits<int>::min();
  for (const auto& value : group.inputs)
    for (const SourceTerms::Part& part : value) {
      newest = std::max(newest, part.vertex.time);
      row.left = std::min(row.left, part.vertex.space), row.right = std::max(row.right, part.vertex.space);
    }
  for (const auto& value : group.inputs) {
    std::map<std::pair<int, int>, double> weights;  // of rows at shifts
    inputs.unknown.push_back(0);
    for (const SourceTerms::Part& part : value) {
      if (row.newest + part.vertex.time == 1) inputs.unknown.back() += std::abs(part.weight);
      const int back = 1 - (row.newest + newest);  // of the newest row that is read
      weights[{y_.row(back, part.component), part.vertex.space}] += part.weight;
      for (int r = 0; r < newest - part.vertex.time; ++r)
        weights[{v_.row(back + r, part.component), part.vertex.space}] -= part.weight, reads_increments_beside_ = true;
      row.reads_back = row.reads_back || newest - part.vertex.time > 1;
    }
    RowSum sum;
    for (const auto& [where, weight] : weights) sum.add(where.first, where.second, weight);
    sum.pair_up();
    inputs.single_rows.push_back(row.stride == 1 ? sum.one_row() : RowSum::OneRow{});
    inputs.formed += inputs.single_rows.back().row < 0;
    inputs.values.push_back(std::move(sum));
  }
  return inputs;
}

bool RowEquations::reads_newest_alone() const {
  for (const EquationTerms& equation : equations_.bulk)
    for (const Term& t : equation.terms)
      if (t.source == Source::increment && t.age > 0) return false;
  return !has_walls() && std::ranges::all_of(sources_, [](const SourceRow& row) {
    return row.is_local || (row.reads_unknown && !row.reads_back);
  });
}

const SourceRow& RowEquations::source_of(const Term& t) const {
  const auto found = std::ranges::find_if(sources_, [&](const SourceRow& row) {
    return row.family == t.family &&
           row.group * system_.families()[t.family]->sources()->outputs_per_group + row.component == t.output;
  });
  return *found;
}

/// The place in the table of a term of the known part.
int RowEquations::known_row(const Term& t) const {
  switch (t.source) {
    case Source::difference:
    case Source::value:
      return y_.row(1, t.component);
    case Source::increment:
      return v_.row(1 + t.age, t.component);
    default: {
      const SourceRow& row = source_of(t);
      return row.ring.row(row.newest - t.age);
    }
  }
}

/// The place of a term in residual(): source terms that read row n + 1, or have no row, are among the measured ones.
int RowEquations::measured_row(const Term& t) const {
  if (t.source == Source::unknown) return measured_ + t.component;
  if (t.source != Source::output) return known_row(t);
  const SourceRow& row = source_of(t);
  const bool measured = row.is_local || (row.reads_unknown && t.age == row.newest);
  return measured ? measured_ + d_ + static_cast<int>(&row - sources_.data()) : known_row(t);
}
int RowEquations::measured_count() const { return d_ + static_cast<int>(sources_.size()) + 2 * d_; }

bool RowEquations::brick_exists(const Term& t, int equation_shift, int parity) const {
  if (t.source != Source::output) return true;
  const bool bricks = system_.families()[t.family]->pattern().placement == Placement::brick_wall;
  return !bricks || (parity + t.age - 1 + equation_shift + t.shift) % 2 == 0;
}

/// g ≈ Σ_{j=1}^{p} (−1)^{j+1} C(p, j) g_{n+1−j}
double prediction_weight(int p, int j) {
  double ways = 1;
  for (int i = 1; i <= j; ++i) ways = ways * (p + 1 - i) / i;  // whole numbers all the way
  return j % 2 == 0 ? -ways : ways;
}

void RowEquations::add_sources(RowSum& sum, const Term& t, double c, Solving solving) const {
  const SourceRow& row = source_of(t);
  const bool unknown = row.reads_unknown && t.age == row.newest;
  if (solving == Solving::step) sum.add(known_row(t), t.shift, c);
  else if (unknown) sum.add(row.correction, t.shift, c);
}

void RowEquations::build_sums() {
  measured_ = v_.row(v_.held);
  for (const SourceRow& row : sources_)
    measured_ = std::max({measured_, row.ring.row(std::max(1, row.ring.held)), row.correction + 1});
  for (int a = 0; a < d_; ++a) {
    const EquationTerms& equation = equations_.bulk[a];
    for (int parity = 0; parity < (bricks_ ? 2 : 1); ++parity) {
      const double sign = parity == 0 ? 1 : -1;
      const double constant = equation.constant + sign * equation.constant_alternating;
      RowSum known, correction, all;
      for (const Term& t : equation.terms) {
        if (bricks_ && !brick_exists(t, equation.shift, parity)) continue;
        const double c = t.coefficient + sign * t.alternating;
        if (c == 0) continue;
        if (t.source != Source::output) reach_ = std::max(reach_, std::abs(t.shift));
        if (t.source == Source::increment && t.shift != 0) reads_increments_beside_ = true;
        if (t.source == Source::difference) all.add_difference(measured_row(t), t.shift, c);
        else all.add(measured_row(t), t.shift, c);
        if (t.source == Source::output)
          add_sources(known, t, c, Solving::step), add_sources(correction, t, c, Solving::correction);
        else if (t.source == Source::difference) known.add_difference(known_row(t), t.shift, c);
        else if (t.source != Source::unknown) known.add(known_row(t), t.shift, c);
      }
      const auto finish = [this, a](RowSum& sum) { sum.scale(-scale_of(a)), sum.pair_up(); };
      all.add_constant(constant);
      all_.push_back(std::move(all));
      finish(correction);
      correction_.push_back(std::move(correction));
      known.add_constant(constant);
      finish(known);
      known_.push_back(std::move(known));
    }
  }
  for (const SourceRow& row : sources_) {
    predictions_.emplace_back(at(most_rows_ + 1));
    for (int p = 0; p <= most_rows_ && row.reads_unknown; ++p) {
      RowSum& sum = predictions_.back()[p];
      for (int j = 1; j <= p; ++j) sum.add(row.ring.row(j * row.stride), 0, prediction_weight(p, j));
    }
  }
}

void RowEquations::right_side(const RowTable& table, std::int64_t n, int a, Solving solving, int from, int to,
                              double* w) const {
  if (!bricks_) return sum_of(a, 0, solving).evaluate(table.data(), layout_.at(from), layout_.at(to), lanes, w);
  // Packs of even and odd sites take turns; site + row of the equation tells which sum is theirs.
  const int row_parity = static_cast<int>((n + 1 - equations_.bulk[a].shift) & 1);
  for (int half = 0; half < 2; ++half)
    sum_of(a, ((from + half) & 1) ^ row_parity, solving)
        .evaluate(table.data(), layout_.at(from + half), layout_.at(to), 2 * lanes, w);
}

void RowEquations::right_sides(const RowTable& table, std::int64_t n, Solving solving, int from, int to,
                               double* const* w) const {
  for (int a = 0; a < d_; ++a) right_side(table, n, a, solving, from, to, w[a]);
  for (const SiteEquation& special : equations_.exceptional) {
    const double E = value_at(special, table, n, &solving, nullptr);
    for (int slot : layout_.slots_of(special.site)) w[special.component][slot] = -E;
  }
}

/// E at one site, by its own terms: the part of it that is the right side, or, if `solving` is null, all of it at row n + 1.
double RowEquations::value_at(const SiteEquation& special, const RowTable& table, std::int64_t n,
                              const Solving* solving, double* absolute) const {
  const int own = layout_.slot(special.site), a = special.component;
  const bool corrects = solving && *solving == Solving::correction;
  if (special.fixed)  // v_{n+1} = v_n + w = 0
    return corrects ? 0 : wall_scale_ * table[v_.row(solving ? 1 : 0, a)][own];
  const EquationTerms& equation = special.equation;
  const double sign = (n + 1 - equation.shift + special.site) % 2 == 0 ? 1 : -1;
  double value = corrects ? 0 : equation.constant + sign * equation.constant_alternating;
  for (const Term& t : equation.terms) {
    const int beside = layout_.slot(std::clamp(special.site + t.shift, 0, layout_.sites() - 1));
    const double c = t.coefficient + sign * t.alternating;
    double x = 0;
    if (solving && t.source == Source::output) {
      RowSum sum;
      add_sources(sum, t, c, *solving);
      x = sum.at(table.data(), beside - t.shift * lanes);
    } else if (!solving || (!corrects && t.source != Source::unknown)) {
      const double* const row = table[solving ? known_row(t) : measured_row(t)];
      x = c * (row[beside] - (t.source == Source::difference ? row[own] : 0));
    }
    value += x;
    if (absolute) *absolute += std::abs(x);
  }
  return value;
}

template <class Visit>
[[gnu::always_inline]] inline void RowEquations::for_each_batch(const double* const* rows, std::int64_t anchors,
                                                                const SourceRow& source, int from, int to,
                                                                Visit visit) const {
  constexpr int most_packs = 64;
  from = std::max(from, source.first_pack), to = std::min(to, source.last_pack);
  const Inputs& inputs = inputs_[&source - sources_.data()];
  const int count = static_cast<int>(inputs.values.size());
  const bool bricks = source.stride == 2, placed = positions_.rows() > 0;
  const ScratchRows scratch(inputs.formed + placed, most_packs * lanes);
  std::array<const double*, most_values> slots;
  // Bricks stand where row + site is even: at every second pack.
  const int stride = bricks ? 2 : 1;
  for (int first = bricks ? from + static_cast<int>((from + anchors) & 1) : from; first < to;
       first += most_packs * stride) {
    const int packs = std::min(most_packs, (to - first + stride - 1) / stride);
    const std::ptrdiff_t begin = layout_.at(first), end = layout_.at(first + (packs - 1) * stride) + lanes;
    int next = 0;
    for (int j = 0; j < count; ++j)
      if (const RowSum::OneRow& one = inputs.single_rows[j]; one.row >= 0) {
        slots[at(j)] = rows[one.row] + begin + one.by;
      } else {
        inputs.values[j].evaluate_dense(rows, begin, end, stride * lanes, scratch[next]);
        slots[at(j)] = scratch[next++];
      }
    JetBatch batch{packs * lanes, slots.data(), 0, nullptr};
    if (placed) {
      double* const x = scratch[inputs.formed];
      for (int p = 0; p < packs; ++p)
        (Pack::load(positions_.row(0) + begin + p * stride * lanes) + inputs.space * system_.lattice().space_step())
            .store(x + p * lanes);
      batch.x = x;
      batch.t = (static_cast<double>(anchors) + inputs.time) * system_.time_step();
    }
    visit(batch, begin, packs);
  }
}

void RowEquations::evaluate(const RowTable& table, std::int64_t n, const SourceRow& source, int back, int from, int to,
                            double* const* out) const {
  const Inputs& inputs = inputs_[&source - sources_.data()];
  const bool bricks = source.stride == 2;
  // The rows of the anchors `back` rows before: further back in the rings of y and v.
  for_each_batch(table.data() + back * d_, n + source.newest - back, source, from, to,
                 [&](const JetBatch& batch, std::ptrdiff_t begin, int packs) {
                   std::array<double*, most_values> results;
                   const ScratchRows every_second(bricks ? inputs.outputs : 0, batch.count);
                   for (int c = 0; c < inputs.outputs; ++c) results[c] = bricks ? every_second[c] : out[c] + begin;
                   inputs.family->evaluate_sources(source.group, batch, results.data());
                   for (int c = 0; c < inputs.outputs && bricks; ++c)
                     for (int p = 0; p < packs; ++p)
                       Pack::load(results[c] + p * lanes).store(out[c] + begin + 2 * p * lanes);
                 });
}

/// max Σ_j W_j |∂g_c/∂m_j| over a batch, if it is more than slopes[c].
void RowEquations::add_slopes(const SourceRow& source, const JetBatch& batch, double* slopes) const {
  const Inputs& inputs = inputs_[&source - sources_.data()];
  const int count = static_cast<int>(inputs.values.size());
  const ScratchRows derivatives(inputs.outputs * count, batch.count);
  inputs.family->differentiate_sources(source.group, batch, derivatives.data());
  for (int c = 0; c < inputs.outputs; ++c) {
    Pack most(slopes[c]);
    for (int i = 0; i < batch.count; i += lanes) {
      Pack sum(0.0);
      for (int j = 0; j < count; ++j)
        if (inputs.unknown[j] != 0) sum += inputs.unknown[j] * abs(Pack::load(derivatives[c * count + j] + i));
      most = max_or_nan(sum, most);
    }
    slopes[c] = max_or_nan(most);
  }
}

/// Quadrature values that are all the same, and random ones; those at which a derivative is not finite say nothing.
std::vector<double> RowEquations::slopes_within(double size, std::int64_t n) const {
  constexpr int alike = 128, all = 2 * alike;
  std::vector<double> slopes(sources_.size(), 0.0);
  std::mt19937_64 generator(1);
  const auto random = [&] { return std::ldexp(static_cast<double>(generator() >> 11), -52) - 1; };
  for (std::size_t s = 0; s < sources_.size(); s += at(sources_[s].outputs)) {
    const SourceRow& source = sources_[s];
    if (!source.reads_unknown) continue;
    const Inputs& inputs = inputs_[s];
    const int count = static_cast<int>(inputs.values.size());
    const ScratchRows values(count, all), x(1, all);
    for (int i = 0; i < all; ++i) {
      for (int j = 0; j < count; ++j) values[j][i] = size * (i < alike ? 2.0 * i / (alike - 2) - 1 : random());
      x[0][i] = system_.lattice().position(static_cast<int>(static_cast<std::int64_t>(i) * layout_.sites() / all));
    }
    const double t = (static_cast<double>(n + source.newest) + inputs.time) * system_.time_step();
    for (int i = 0; i < all; i += lanes) {
      std::array<const double*, most_values> slots;
      for (int j = 0; j < count; ++j) slots[at(j)] = values[j] + i;
      std::array<double, most_values> found{};
      add_slopes(source, {lanes, slots.data(), t, x[0] + i}, found.data());
      for (int c = 0; c < source.outputs; ++c)
        if (std::isfinite(found[c])) slopes[s + at(c)] = std::max(slopes[s + at(c)], found[c]);
    }
  }
  return slopes;
}

std::vector<double> RowEquations::slopes_at(const RowTable& table, std::int64_t n, double s) const {
  std::vector<double> slopes(sources_.size(), 0.0);
  constexpr int strip = 64;
  for (std::size_t first = 0; first < sources_.size(); first += at(sources_[first].outputs)) {
    const SourceRow& source = sources_[first];
    if (!source.reads_unknown) continue;
    for (int from = 0; from < layout_.packs(); from += strip) {
      const int to = std::min(from + strip, layout_.packs());
      // y = y_n + s (y_n − y_{n−1}) + s² (y_{n+1} − 2y_n + y_{n−1}) and v = y − y_n of the strip, and as far beside it as
      // its quadrature values read.
      const ScratchRows way(2 * d_, (to - from + source.right - source.left) * lanes);
      RowTable rows = table;
      for (int a = 0; a < d_; ++a) {
        const double *const next = table[y_.row(0, a)], *const now = table[y_.row(1, a)],
                            *const last = table[y_.row(2, a)];
        double *const y = way[a] - layout_.at(from + source.left), *const v =
                                                                       way[d_ + a] - layout_.at(from + source.left);
        for (std::ptrdiff_t i = layout_.at(from + source.left); i < layout_.at(to + source.right); i += lanes) {
          const Pack before = Pack::load(now + i) - Pack::load(last + i),
                     after = Pack::load(next + i) - Pack::load(now + i);
          const Pack moved = s * before + (s * s) * (after - before);
          moved.store(v + i);
          (Pack::load(now + i) + moved).store(y + i);
        }
        rows[y_.row(0, a)] = y, rows[v_.row(0, a)] = v;
      }
      for_each_batch(rows.data(), n + source.newest, source, from, to,
                     [&](const JetBatch& batch, std::ptrdiff_t, int) { add_slopes(source, batch, &slopes[first]); });
    }
  }
  return slopes;
}

std::size_t RowEquations::residual_bytes() const { return RowBuffer::bytes_of(layout_.doubles(), measured_count()); }

double RowEquations::residual(RowTable table, std::int64_t n) {
  if (!measured_rows_.rows()) measured_rows_ = RowBuffer(layout_, measured_count());
  const int numbers = measured_ + measured_count();
  table.reserve(numbers);
  for (int r = 0; r < measured_count(); ++r) table[measured_ + r] = measured_rows_.row(r);
  for (int a = 0; a < d_; ++a) {
    double* const w = table[measured_ + a];
    const double *v = table[v_.row(0, a)], *before = table[v_.row(1, a)];
    for (int p = 0; p < layout_.packs(); ++p)
      (Pack::load(v + layout_.at(p)) - Pack::load(before + layout_.at(p))).store(w + layout_.at(p));
    layout_.fill_halo(w);
  }
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    if (sources_[s].component != 0 || !(sources_[s].is_local || sources_[s].reads_unknown)) continue;
    double* const* const out = &table[measured_ + d_ + static_cast<int>(s)];
    evaluate(table, n, sources_[s], 0, 0, layout_.packs(), out);
    for (int c = 0; c < sources_[s].outputs; ++c) layout_.fill_halo(out[c]);
  }
  double largest = 0, scale = 0;
  for (int a = 0; a < d_; ++a) {
    // Sites near walls have their own sums, in the place of the bulk's.
    double *const E = measured_rows_.row(measured_count() - 2 * d_ + a), *const size = measured_rows_.row(
                                                                             measured_count() - d_ + a);
    const auto store = [&](std::ptrdiff_t place, Pack sum, Pack absolute) {
      sum.store(E + place), absolute.store(size + place);
    };
    const int row_parity = static_cast<int>((n + 1 - equations_.bulk[a].shift) & 1);
    for (int half = 0; half < (bricks_ ? 2 : 1); ++half)
      all_[index_of(a, (half & 1) ^ row_parity)].measure(table.data(), layout_.at(half), layout_.at(layout_.packs()),
                                                         (bricks_ ? 2 : 1) * lanes, store);
    for (const SiteEquation& special : equations_.exceptional) {
      if (special.component != a) continue;
      double absolute = 0;
      const double value = value_at(special, table, n, nullptr, &absolute);
      for (int slot : layout_.slots_of(special.site)) E[slot] = value, size[slot] = absolute;
    }
    for (std::size_t i = at(layout_.at(0)); i < at(layout_.at(layout_.packs())); ++i) {
      largest = larger_or_nan(std::abs(E[i]), largest);
      scale = larger_or_nan(size[i], scale);
    }
  }
  if (!std::isfinite(scale)) return std::numeric_limits<double>::quiet_NaN();
  return scale != 0 ? largest / scale : 0;
}

}  // namespace delf
