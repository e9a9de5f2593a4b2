// SPDX-License-Identifier: MIT
#include "schemes/system/assembly.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <tuple>

#include "jets/simd/exact_sum.hpp"
#include "jets/simd/pack_gather.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// Numbers of nodes, looked up by their place between the first and the last column that has one: −1 where there is none.
class NodeNumbers {
 public:
  NodeNumbers(const std::vector<Node>& nodes, int copies, int components) : components_(components) {
    if (nodes.empty()) return;
    const auto [low, high] = std::ranges::minmax(nodes, {}, [](const Node& n) { return n.site.time; });
    const auto [left, right] = std::ranges::minmax(nodes, {}, [](const Node& n) { return n.site.space; });
    low_ = low.site.time, high_ = high.site.time, left_ = left.site.space, right_ = right.site.space;
    numbers_.assign(at(high_ - low_ + 1) * at((right_ - left_ + 1) * components), -1);
    const std::size_t count = nodes.size() / at(copies);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      numbers_[index(nodes[n].site.time, nodes[n].site.space, nodes[n].component)] = static_cast<int>(n % count);
  }
  int operator()(int row, int site, int component) const {
    return row < low_ || row > high_ || site < left_ || site > right_ ? -1 : numbers_[index(row, site, component)];
  }

 private:
  std::size_t index(int row, int site, int component) const {
    return (at(row - low_) * at(right_ - left_ + 1) + at(site - left_)) * at(components_) + at(component);
  }
  int components_, low_ = 0, high_ = -1, left_ = 0, right_ = -1;
  std::vector<int> numbers_;
};

}  // namespace

/// The rows that batches read, component by component: neighbouring stencils read neighbouring numbers.
class Assembly::Columns {
 public:
  enum class Of { all, known, unknown };  ///< batches: those without an unknown, those with one
  /// The lowest and the highest row that they read.
  static std::pair<int, int> rows(const std::vector<Batch>& batches, Of which) {
    std::pair<int, int> all{0, -1};
    for (const Batch& b : batches) {
      if (which != Of::all && b.unknowns.empty() != (which == Of::known)) continue;
      const auto [low, high] = std::ranges::minmax(b.rows);
      const bool first = all.second < all.first;
      all = {first ? low : std::min(all.first, low), first ? high : std::max(all.second, high)};
    }
    return all;
  }
  Columns(const Assembly& assembly, SectionView section, std::int64_t J, Of which)
      : Columns(assembly, section, J, which, assembly.columns_) {}
  Columns(const Assembly& assembly, SectionView section, std::int64_t J, Of which, Numbers& room)
      : section_(section), J_(section.index(J)), components_(assembly.components_) {
    sites_ = section.row_size() / at(components_);
    are_rows_ = components_ == 1 || sites_ == 1;
    if (are_rows_) return;
    const auto [low, high] = rows(assembly.batches_, which);
    low_ = low;
    const std::size_t size = at(high - low + 1) * section.row_size();
    room.resize(section.has_low() ? 2 * size : size);
    double* to = room.data();
    columns_ = to, low_parts_ = to + size;
    const auto add = [&](const double* from) {
      for (int c = 0; c < components_; ++c)
        for (std::size_t i = 0; i < sites_; ++i) *to++ = from[i * at(components_) + at(c)];
    };
    for (int row = low; row <= high; ++row) add(section.beside(J_, row));
    if (!section.has_low()) return;
    for (int row = low; row <= high; ++row) add(section.low_of(section.beside(J_, row)));
  }
  const double* operator()(int row, int c) const {
    return are_rows_ ? section_.beside(J_, row) + c : columns_ + at((row - low_) * components_ + c) * sites_;
  }
  bool has_low() const { return section_.has_low(); }
  const double* low(int row, int c) const {
    return are_rows_ ? section_.low_of(section_.beside(J_, row)) + c
                     : low_parts_ + at((row - low_) * components_ + c) * sites_;
  }
  /// Value i of a pack of stencils from the s-th on.
  [[gnu::always_inline]] Pack operator()(const Batch& b, int i, int s) const {
    const double* const column = (*this)(b.rows[i], b.family->values()[i].component);
    return of(column, b, b.read(i, s));
  }
  [[gnu::always_inline]] static Pack of(const double* column, const Batch& b, int read) {
    const int* const place = b.place.data() + read;
    if (b.side_by_side[read / lanes] != 0) return load_unaligned(column + *place);
    return b.stencils == 1 ? Pack(column[*place]) : delf::gather(column, place);
  }

 private:
  SectionView section_;
  int J_, components_, low_ = 0;
  std::size_t sites_ = 0;
  bool are_rows_ = false;  ///< a column is a row, or one number of it
  const double *columns_ = nullptr, *low_parts_ = nullptr;
};

SectionRing::SectionRing(const Window& window, std::int64_t first, std::int64_t last)
    : SectionRing(static_cast<int>(last - first + 1), window.rows.front().size(), window.has_low()) {
  for (std::int64_t r = first; r <= last; ++r) {
    const std::size_t n = std::clamp(r, window.first_row, window.last_row()) - window.first_row;
    std::ranges::copy(window.rows[n], row(r));
    if (has_low_) std::ranges::copy(window.low[n], low(r));
  }
}

Assembly::Parts Assembly::slab(const SolvePlan& plan, int parity, int past, int future, double monodromy) {
  Slab slab = plan.slab(parity);
  for (auto* nodes : {&slab.unknowns, &slab.equations})
    for (Node& node : *nodes) node.site.time -= parity;
  return {.equations = std::move(slab.equations),
          .unknowns = std::move(slab.unknowns),
          .matched = slab.matched,
          .parity = parity,
          .past = past,
          .future = future,
          .monodromy = monodromy};
}

Assembly::Parts Assembly::across(const LatticeSystem& system, int parity, double monodromy) {
  std::vector<Anchor> anchors;
  for (int f = 0; f < static_cast<int>(system.families().size()); ++f) {
    const StencilFamily& family = *system.families()[f];
    const auto [low, high] = std::ranges::minmax(family.pattern().vertices, {}, &Site::time);
    for (int row = -high.time; row + low.time < 0; ++row)
      for (int i = 0; i < system.anchors(family); ++i)
        if (system.has_stencil(family, row + parity, i)) anchors.push_back({f, {row, i}});
  }
  return {.equations = {},
          .parity = parity,
          .past = system.height(),
          .future = system.height(),
          .monodromy = monodromy,
          .stencils = std::move(anchors)};
}

Assembly::Assembly(const LatticeSystem& system, Parts parts)
    : times_(system.times()),
      space_step_(system.lattice().space_step()),
      components_(system.components()),
      parts_(std::move(parts)) {
  list_stencils(system);
  list_reads(system);
  take_constant_parts();
}

/// The batches with their stencils, without what those read.
void Assembly::list_stencils(const LatticeSystem& system) {
  const Lattice& lattice = system.lattice();
  std::vector<Anchor> anchors;
  if (parts_.stencils) anchors = *std::move(parts_.stencils);
  else
    for (const Node& e : parts_.equations)
      for (const auto& touch : system.touching(e.site + Site{parts_.parity, 0}, e.component)) {
        const Site site = e.site + touch.anchor;
        const int place = touch.family->listed() ? touch.anchor.space : lattice.home(site.space);
        anchors.push_back({touch.family_index, {site.time, place}});
      }
  std::ranges::sort(anchors);
  anchors.erase(std::ranges::unique(anchors).begin(), anchors.end());
  for (const Anchor& anchor : anchors) {
    const auto [number, site] = anchor;
    if (batches_.empty() || batches_.back().number != number || batches_.back().row != site.time) {
      const StencilFamily& family = *system.families()[number];
      batches_.push_back({.family = &family,
                          .number = number,
                          .size = family.size(),
                          .row = site.time,
                          .lowest_row = site.time,
                          .stencils = 0,
                          .padded = 0});
      for (int i = 0; i < family.size(); ++i) {
        batches_.back().rows.push_back(site.time + family.site(i).time);
        batches_.back().lowest_row = std::min(batches_.back().lowest_row, batches_.back().rows.back());
      }
    }
    batches_.back().sites.push_back(site.space);
  }
  for (Batch& b : batches_) {
    b.stencils = static_cast<int>(b.sites.size());
    b.padded = (b.stencils + lanes - 1) / lanes * lanes;
    b.sites.resize(b.padded, b.sites.back());
    if (b.family->listed()) continue;
    b.x.resize(b.padded / lanes);
    for (int s = 0; s < b.padded; ++s) b.x[s / lanes].v[s % lanes] = lattice.position(b.sites[s]);
  }
}

void Assembly::list_reads(const LatticeSystem& system) {
  const Lattice& lattice = system.lattice();
  const NodeNumbers unknown_at(parts_.unknowns, parts_.copies, components_);
  const NodeNumbers equation_at(parts_.equations, 1, components_);
  std::vector<std::vector<int>> unknown(batches_.size());
  for (std::size_t n = 0; n < batches_.size(); ++n) {
    Batch& b = batches_[n];
    const std::size_t reads = at(b.size) * at(b.padded);
    b.place.resize(reads), b.side_by_side.resize(reads / at(lanes)), b.equation.resize(reads), unknown[n].resize(reads);
    if (parts_.monodromy != 0) b.gained.resize(reads);
    for (int i = 0; i < b.size; ++i) {
      const Site vertex = b.family->site(i);
      const int c = b.family->values()[i].component, row = b.rows[i];
      const double monodromy = system.monodromy_of(c, parts_.monodromy);
      bool is_equation = false, is_unknown = false;
      for (int s = 0; s < b.padded; ++s) {
        const int x = b.family->column(b.sites[s], i), home = lattice.home(x);
        const std::size_t read = at(b.read(i, s));
        const int equation = s < b.stencils && b.family->is_varied(i) ? equation_at(row, home, c) : -1;
        b.place[read] = place(Site{row, home, vertex.node});
        b.equation[read] = equation < 0 ? size() : equation;
        unknown[n][read] = unknown_at(row, home, c);
        if (parts_.monodromy != 0) b.gained[read] = monodromy * ((x - home) / lattice.sites());
        is_equation = is_equation || equation >= 0;
        is_unknown = is_unknown || unknown[n][read] >= 0;
      }
      for (int s = 0; s < b.padded; s += lanes) {
        const auto first = b.place.begin() + b.read(i, s);
        b.side_by_side[b.read(i, s) / lanes] =
            std::adjacent_find(first, first + lanes, [](int p, int q) { return q != p + 1; }) == first + lanes;
      }
      if (is_equation) b.equations.push_back(i), b.evaluated.push_back(i);
      if (is_unknown) b.unknowns.push_back(i);
      b.rows[i] = std::clamp(row, -parts_.past, parts_.future);
    }
  }
  list_places(unknown);
  if (components_ == 1) return;
  const auto [low, high] = Columns::rows(batches_, Columns::Of::all);
  int sites = 0;
  for (const Batch& b : batches_) sites = std::max(sites, std::ranges::max(b.place) + 1);
  columns_.reserve((high - low + 1) * sites * components_);
}

int Assembly::strip_length(const Batch& b, std::size_t numbers) {
  const int fit = largest_strip / static_cast<int>(std::max<std::size_t>(numbers, 1)) / lanes * lanes;
  return std::min(std::clamp(fit, lanes, most_together), b.padded);
}

/// The entries of the Jacobian, each once, and which of them each stencil gives a share of.
void Assembly::list_places(const std::vector<std::vector<int>>& unknown) {
  const auto each_share = [&](const auto& use) {
    for (std::size_t n = 0; n < batches_.size(); ++n) {
      Batch& b = batches_[n];
      b.entry.resize(b.equations.size() * b.unknowns.size() * at(b.padded), -1);
      int* entry = b.entry.data();
      for (const int i : b.equations)
        for (const int m : b.unknowns)
          for (int s = 0; s < b.padded; ++s, ++entry)
            if (const int e = b.equation[b.read(i, s)], u = unknown[n][b.read(m, s)]; e < size() && u >= 0)
              use(e, u, *entry);
    }
  };
  // The unknowns of all shares, equation by equation; then each once.
  std::vector<std::size_t> first(at(size()) + 1, 0);
  each_share([&](int e, int, int&) { ++first[at(e) + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> unknowns(first.back());
  std::vector<std::size_t> end(first.begin(), first.end() - 1);
  each_share([&](int e, int u, int&) { unknowns[end[at(e)]++] = u; });
  std::vector<std::size_t> first_place(first.size(), 0);
  for (int e = 0; e < size(); ++e) {
    const std::span all(unknowns.data() + first[at(e)], first[at(e) + 1] - first[at(e)]);
    std::ranges::sort(all);
    for (std::size_t n = 0; n < all.size(); ++n)
      if (n == 0 || all[n] != all[n - 1]) places_.push_back({e, all[n]});
    first_place[at(e) + 1] = places_.size();
  }
  places_.shrink_to_fit();
  each_share([&](int e, int u, int& entry) {
    const std::span all(places_.data() + first_place[at(e)], first_place[at(e) + 1] - first_place[at(e)]);
    entry = static_cast<int>(std::ranges::lower_bound(all, u, {}, &Place::unknown) - all.begin() +
                             static_cast<std::ptrdiff_t>(first_place[at(e)]));
  });
  for (Batch& b : batches_) std::ranges::replace(b.entry, -1, static_cast<int>(places_.size()));
}

void Assembly::take_constant_parts() {
  fixed_.clear();
  for (Batch& b : batches_) {
    if (b.family->listed()) continue;  // each stencil has a J of its own
    const auto part = b.family->constant_part(cell(b, 0, b.x[0][0]));
    b.linear = part && part->is_all;
    if (!b.linear) continue;
    fixed_.resize(places_.size() + 1, 0.0);
    b.at_zero.clear(), b.terms.clear();
    for (std::size_t e = 0; e < b.evaluated.size(); ++e) {
      const int i = b.evaluated[e];
      if (i >= b.size) break;  // such families are not asked for their constant parts
      b.at_zero.push_back(part->r0[i]);
      for (int m = 0; m < b.size; ++m)
        if (const double value = part->J[i * b.size + m]; value != 0)
          b.terms.push_back({static_cast<int>(e), m, value});
    }
    add_constant(b, part->J, fixed_);
    b.by_differences = keeps_low_ && b.family->reads_low() && take_matrix_of_differences(b);
  }
}

/// r at a unit of each value y_m − y₀ of a column, y₀ its first one, and of y₀ with all of the column: there a family has no
/// φ_t, where a sum of J's entries would have the rounding of 1/h². False if a rate may read a value that is in no column.
bool Assembly::take_matrix_of_differences(Batch& b) const {
  const std::vector<std::vector<int>>& columns = b.family->sums();
  const int count = (b.size + lanes) / lanes * lanes;  // the last ones are zero, as is y of r(0)
  const std::size_t packs = at(count / lanes);
  Packs y(at(b.size) * packs, Pack(0.0)), low = y, r(b.evaluated.size() * packs), x(packs, b.x[0]);
  const auto is_in_column = [&](const Term& term) {
    return std::ranges::any_of(columns, [&](const auto& column) { return std::ranges::count(column, term.m) > 0; });
  };
  if (!b.family->sums_vanish() && !std::ranges::all_of(b.terms, is_in_column)) return false;
  const auto set = [&](int i, int s) { numbers_of(y.data())[i * count + s] = 1; };
  for (int m = 0; m < b.size; ++m) set(m, m);
  for (const std::vector<int>& column : columns)
    for (const int i : column) set(i, column.front());
  b.family->residual({cell(b, 0, b.x[0][0]), count, numbers_of(x.data()), numbers_of(y.data()), numbers_of(low.data())},
                     b.evaluated, numbers_of(r.data()));
  b.at_zero.clear(), b.terms.clear();
  for (std::size_t e = 0; e < b.evaluated.size(); ++e) {
    const double* const row = numbers_of(r.data()) + e * at(count);
    b.at_zero.push_back(row[count - 1]);
    for (int m = 0; m < b.size; ++m)
      if (const double value = row[m] - row[count - 1]; value != 0) b.terms.push_back({static_cast<int>(e), m, value});
  }
  return true;
}

void Assembly::set_time_step(double h) {
  own_step_ = h;
  take_constant_parts();
}

/// h, k, t and x of a stencil: h is the step above its anchor's row. A step of its own is counted from row J − 1.
Cell Assembly::cell(const Batch& b, std::int64_t J, double x) const {
  const std::int64_t row = J + b.row;
  if (own_step_) return {*own_step_, space_step_, times_->time(J - 1) + static_cast<double>(b.row + 1) * *own_step_, x};
  return {times_->step(row), space_step_, times_->time(row), x};
}

/// `low`: with low parts, if the section has any and the family reads them.
template <class Use>
void Assembly::strips(const Batch& b, const Columns& columns, std::int64_t J, int numbers, bool low,
                      const Use& use) const {
  low = low && columns.has_low() && b.family->reads_low();
  alignas(sizeof(Pack)) static constexpr std::array<double, most_together> no_place{};
  const int most = strip_length(b, at(numbers));
  for (int first = 0; first < b.padded; first += most) {
    const int count = std::min(most, b.padded - first);
    const int values = b.size * count / lanes;
    const ScratchRows room(1, (low ? 2 : 1) * b.size * count), results(1, numbers * count);
    Pack *const begin = reinterpret_cast<Pack*>(room[0]), *y = begin, *rest = begin + values;
    for (int i = 0; i < b.size; ++i) {
      const int c = b.family->values()[i].component;
      const double* const column = columns(b.rows[i], c);
      const double* const low_parts = low ? columns.low(b.rows[i], c) : nullptr;
      for (int s = first; s < first + count; s += lanes, ++y) {
        Pack read = Columns::of(column, b, b.read(i, s));
        if (low) *rest = Columns::of(low_parts, b, b.read(i, s));
        if (!b.gained.empty()) {
          const Pack before = read, gained = load_unaligned(b.gained.data() + b.read(i, s));
          read += gained;
          if (low) *rest += rounding_of_sum(before, gained, read);
        }
        *y = read;
        if (low) ++rest;
      }
    }
    use(StencilBatch{cell(b, J, 0), count, b.x.empty() ? no_place.data() : numbers_of(b.x.data() + first / lanes),
                     room[0], low ? numbers_of(begin + values) : nullptr, b.sites.data() + first},
        first, reinterpret_cast<Pack*>(results[0]), begin);
  }
}

/// The values of a strip, counted from the first of their column, which keeps its own.
void Assembly::take_differences(const Batch& b, int packs, Pack* y) {
  const Pack* const low = y + b.size * packs;
  for (const std::vector<int>& column : b.family->sums())
    for (int p = 0; p < packs; ++p) {
      const int first = column.front() * packs + p;
      for (const int i : column)
        if (const int n = i * packs + p; n != first) y[n] = (y[n] - y[first]) + (low[n] - low[first]);
    }
}

/// Adds residuals; with `gain`, also what stencils add to the known part of the next slab.
void Assembly::add_residual(const Batch& b, const Columns& columns, std::int64_t J, double* E, double* absolute,
                            double* gain) const {
  const std::vector<int>& evaluated = gain != nullptr ? b.evaluated : b.equations;
  const int equations = static_cast<int>(evaluated.size());
  if (equations == 0) return;
  // J y has lost the digits that differences of y + low have.
  const bool low = columns.has_low() && b.family->reads_low();
  const bool by_matrix = b.linear && steady() && low == b.by_differences;
  strips(b, columns, J, equations, true, [&](const StencilBatch& strip, int first, Pack* r, Pack* y) {
    const int packs = strip.count / lanes;
    if (by_matrix) {
      if (low) take_differences(b, packs, y);
      for (int e = 0; e < equations; ++e) std::fill_n(r + e * packs, packs, Pack(b.at_zero[e]));
      for (const auto& [e, m, value] : b.terms) {
        if (e >= equations) break;
        for (int p = 0; p < packs; ++p) r[e * packs + p] += Pack(value) * y[m * packs + p];
      }
    } else {
      b.family->residual(strip, evaluated, numbers_of(r));
    }
    if (gain != nullptr)
      for (const auto& [e, equation] : b.gains)
        for (int p = 0; p < packs; ++p)
          scatter_add(r[e * packs + p], gain, equation.data() + first + p * lanes, b.stencils - first - p * lanes);
    // No two stencils of a row have the same equation at the same value.
    for (const int i : b.equations)
      for (int p = 0; p < packs; ++p, ++r) {
        const int s = first + p * lanes, own = b.stencils - s;
        const int* const equation = b.equation.data() + b.read(i, s);
        scatter_add(*r, E, equation, own);
        if (absolute) scatter_add(abs(*r), absolute, equation, own);
      }
  });
}

/// Zero, or the momenta of row 0. One number more than there are equations takes what belongs to none.
void Assembly::begin(std::int64_t J, const std::vector<double>* momenta, std::vector<double>& E) const {
  E.assign(at(size()) + 1, 0.0);
  if (!momenta) return;
  for (int n = 0; n < size(); ++n)
    if (J + equation(n).site.time == 0) E[n] = (*momenta)[place(equation(n))];
}

void Assembly::residual(SectionView section, std::int64_t J, std::vector<double>& E, std::vector<double>* absolute,
                        const std::vector<double>* momenta) const {
  begin(J, momenta, E);
  if (absolute) absolute->assign(E.size(), 0.0);
  const Columns columns(*this, section, J, Columns::Of::all);
  for (const Batch& b : batches_)
    if (!below_start(b, J, momenta != nullptr))
      add_residual(b, columns, J, E.data(), absolute ? absolute->data() : nullptr);
  E.resize(size());
  if (absolute) absolute->resize(E.size());
}

void Assembly::known(SectionView section, std::int64_t J, std::vector<double>& E,
                     const std::vector<double>* momenta) const {
  begin(J, momenta, E);
  const Columns columns(*this, section, J, Columns::Of::known);
  for (const Batch& b : batches_)
    if (b.unknowns.empty() && !below_start(b, J, momenta != nullptr)) add_residual(b, columns, J, E.data(), nullptr);
}

void Assembly::residual_from(const std::vector<double>& known, SectionView section, std::int64_t J,
                             std::vector<double>& E) const {
  E = known;
  const Columns columns(*this, section, J, Columns::Of::unknown);
  for (const Batch& b : batches_)
    if (!b.unknowns.empty()) add_residual(b, columns, J, E.data(), nullptr);
}

void Assembly::residual_and_gain(const std::vector<double>& known, SectionView section, std::int64_t J,
                                 std::vector<double>& E, std::vector<double>& gain) const {
  E = known;
  gain.assign(at(size()) + 1, 0.0);
  const Columns columns(*this, section, J, Columns::Of::unknown);
  for (const Batch& b : batches_)
    if (!b.unknowns.empty()) add_residual(b, columns, J, E.data(), nullptr, gain.data());
}

bool Assembly::keep_low(const LatticeSystem& system) {
  keeps_low_ = true;
  const bool follows = list_gains(system);
  for (Batch& b : batches_)
    if (!follows) b.evaluated = b.equations, b.gains.clear();
  columns_.reserve(2 * columns_.capacity());
  take_constant_parts();
  return follows;
}

/// False if the known part of the next slab does not follow from this one.
bool Assembly::list_gains(const LatticeSystem& system) {
  const auto column_of = [&](int site, int component) -> std::optional<std::tuple<int, int, double>> {
    const Component& c = system.component(component);
    if (c.role != Role::field && c.role != Role::inner && c.role != Role::trace) return std::nullopt;
    return std::tuple{site, c.field, c.at.space};
  };
  const auto site_of = [&](const Batch& b, int i, int s) {
    return system.lattice().home(b.family->column(b.sites[s], i));
  };
  // Residuals of the rows alone add up to momenta where a family leaves nodes out of its sums.
  const auto leaves_out = [&](const StencilFamily& family, int i) {
    return !family.sums().empty() && system.component(family.values()[i].component).at.time != 0 &&
           std::ranges::none_of(family.sums(), [i](const auto& sum) { return std::ranges::count(sum, i) > 0; });
  };
  bool with_nodes = true;
  for (const auto& family : system.families())
    for (int i = 0; i < family->size(); ++i) with_nodes = with_nodes && !leaves_out(*family, i);

  // The equation of each column that has a known part, and of which values, by number and site of a stencil above.
  std::map<std::tuple<int, int, double>, int> equation_of;
  std::map<std::tuple<int, int, int>, std::vector<int>> above;  // family, row, site: [i]
  for (const Batch& b : batches_) {
    if (!b.unknowns.empty()) {
      if (b.lowest_row < -1) return false;
      continue;
    }
    for (int s = 0; s < b.stencils; ++s) {
      std::vector<int> equations(b.size, size());
      for (int i = 0; i < b.size; ++i) {
        const int n = equations[i] = b.equation[b.read(i, s)];
        if (n == size()) continue;
        // Families without low parts gain nothing.
        if (!b.family->reads_low()) return false;
        const auto column = column_of(site_of(b, i, s), equation(n).component);
        if (!column || equation_of.try_emplace(*column, n).first->second != n) return false;
      }
      above.emplace(std::tuple{b.number, b.row + 1, b.sites[s]}, std::move(equations));
    }
  }
  if (equation_of.empty()) return false;

  std::size_t met = 0;
  for (Batch& b : batches_) {
    if (b.unknowns.empty()) continue;
    const std::size_t padded = at(b.padded);
    std::vector<std::vector<int>> to(b.size, std::vector<int>(padded, size()));
    for (int s = 0; s < b.stencils; ++s) {
      const auto upper = above.find({b.number, b.row, b.sites[s]});
      if (upper != above.end()) ++met;
      for (int i = 0; i < b.size; ++i) {
        const int component = b.family->values()[i].component;
        if (upper != above.end()) to[i][s] = upper->second[i];
        const auto column = column_of(site_of(b, i, s), component);
        if (!column || b.equation[b.read(i, s)] == size()) continue;
        if (!with_nodes && system.component(component).at.time != 0) continue;
        if (const auto found = equation_of.find(*column); found != equation_of.end()) to[i][s] = found->second;
      }
    }
    const auto add = [&](int e, const std::vector<int>& equations) {
      if (std::ranges::all_of(equations, [&](int n) { return n == size(); })) return;
      const auto found = std::ranges::find(b.evaluated, e) - b.evaluated.begin();
      if (found == std::ssize(b.evaluated)) b.evaluated.push_back(e);
      b.gains.push_back({static_cast<int>(found), equations});
    };
    std::vector<char> added(b.size, false);
    for (std::size_t n = 0; n < b.family->sums().size(); ++n) {
      const std::vector<int>& values = b.family->sums()[n];
      if (values.empty() || std::ranges::any_of(values, [&](int i) { return to[i] != to[values[0]]; })) continue;
      for (const int i : values) added[i] = true;
      if (!b.family->sums_vanish()) add(b.size + static_cast<int>(n), to[values[0]]);
    }
    for (int i = 0; i < b.size; ++i)
      if (!added[i]) add(i, to[i]);
  }
  return met == above.size();
}

void Assembly::jacobian(SectionView section, std::int64_t J, std::vector<double>& values,
                        const std::vector<double>* momenta) const {
  if (fixed_.empty() || !steady()) values.assign(places_.size() + 1, 0.0);
  else values = fixed_;
  const Columns columns(*this, section, J, Columns::Of::unknown);
  for (const Batch& b : batches_) {
    if ((b.linear && steady()) || below_start(b, J, momenta != nullptr)) continue;
    const int pairs = static_cast<int>(b.equations.size() * b.unknowns.size());
    if (pairs == 0) continue;
    strips(b, columns, J, pairs, false, [&](const StencilBatch& strip, int first, Pack* derivatives, Pack*) {
      b.family->jacobian(strip, b.equations, b.unknowns, numbers_of(derivatives));
      for (int n = 0; n < pairs; ++n)
        for (int s = 0; s < strip.count; s += lanes)
          scatter_add(*derivatives++, values.data(), b.entry.data() + n * b.padded + first + s, b.stencils - first - s);
    });
  }
  values.resize(places_.size());
}

/// Adds the constant part of a batch all of whose stencils have this J.
void Assembly::add_constant(const Batch& b, const Numbers& J, Numbers& values) const {
  const int* entry = b.entry.data();
  for (const int i : b.equations)
    for (const int m : b.unknowns)
      for (int s = 0; s < b.padded; ++s) values[*entry++] += J[i * b.size + m];
}

/// Adds the constant parts of a batch whose stencils each have their own.
bool Assembly::add_own_constants(const Batch& b, Numbers& values) const {
  const std::size_t pairs = b.equations.size() * b.unknowns.size();
  for (int s = 0; s < b.stencils; ++s) {
    Cell of = cell(b, 0, 0);
    of.stencil = b.sites[s];
    const auto part = b.family->constant_part(of);
    if (!part) return false;
    for (std::size_t n = 0; n < pairs; ++n)
      values[b.entry[n * at(b.padded) + at(s)]] +=
          part->J[at(b.equations[n / b.unknowns.size()] * b.size + b.unknowns[n % b.unknowns.size()])];
  }
  return true;
}

bool Assembly::constant_jacobian(std::vector<double>& values) const {
  values.assign(places_.size() + 1, 0.0);
  for (const Batch& b : batches_) {
    if (b.unknowns.empty()) continue;
    // One cell stands for all: values that depend on the place are not in the constant part.
    if (b.family->listed()) {
      if (!add_own_constants(b, values)) return false;
      continue;
    }
    const auto part = b.family->constant_part(cell(b, 0, b.x[0][0]));
    if (!part) return false;
    add_constant(b, part->J, values);
  }
  values.resize(places_.size());
  std::vector<char> has(size(), false);
  for (std::size_t p = 0; p < values.size(); ++p) has[places_[p].equation] |= values[p] != 0;
  return std::ranges::all_of(has, [](char any) { return any != 0; });
}

bool Assembly::is_linear() const {
  for (const Batch& b : batches_) {
    auto entry = b.entry.begin();
    for (const int i : b.equations)
      for (const int m : b.unknowns) {
        const auto end = entry + b.padded;
        if (!b.family->is_constant(i, m) && std::any_of(entry, end, [&](int e) { return at(e) < places_.size(); }))
          return false;
        entry = end;
      }
  }
  return true;
}

void Assembly::linearised(SectionView y, std::int64_t J, std::span<Variation> V, std::vector<double>& values) const {
  values.assign(places_.size() + 1, 0.0);
  for (Variation& v : V) v.E.assign(at(size()) + 1, 0.0), v.absolute.assign(v.E.size(), 0.0);
  const Columns columns(*this, y, J, Columns::Of::all);
  std::vector<Numbers> room(V.size());
  std::vector<Columns> of_V;
  for (std::size_t v = 0; v < V.size(); ++v) of_V.emplace_back(*this, V[v].V, J, Columns::Of::all, room[v]);
  std::vector<int> all;
  for (const Batch& b : batches_) {
    all.resize(b.size);
    std::iota(all.begin(), all.end(), 0);
    const int pairs = static_cast<int>(b.equations.size()) * b.size;
    strips(b, columns, J, pairs, false, [&](const StencilBatch& strip, int first, Pack* derivatives, Pack*) {
      b.family->jacobian(strip, b.equations, all, numbers_of(derivatives));
      const int packs = strip.count / lanes;
      const int* entry = b.entry.data() + first;
      for (std::size_t e = 0; e < b.equations.size(); ++e)
        for (std::size_t u = 0; u < b.unknowns.size(); ++u, entry += b.padded)
          for (int p = 0; p < packs; ++p)
            scatter_add(derivatives[(static_cast<int>(e) * b.size + b.unknowns[u]) * packs + p], values.data(),
                        entry + p * lanes, b.stencils - first - p * lanes);
      for (std::size_t v = 0; v < V.size(); ++v)
        for (std::size_t e = 0; e < b.equations.size(); ++e)
          for (int p = 0; p < packs; ++p) {
            const int s = first + p * lanes;
            Pack sum(0.0), absolute(0.0);
            for (int m = 0; m < b.size; ++m) {
              const Pack term = derivatives[(static_cast<int>(e) * b.size + m) * packs + p] * of_V[v](b, m, s);
              sum += term, absolute += abs(term);
            }
            const int* const equation = b.equation.data() + b.read(b.equations[e], s);
            scatter_add(sum, V[v].E.data(), equation, b.stencils - s);
            scatter_add(absolute, V[v].absolute.data(), equation, b.stencils - s);
          }
    });
  }
  for (Variation& v : V) v.E.resize(size()), v.absolute.resize(size());
  values.resize(places_.size());
}

void Assembly::each(bool jacobian, SectionView section, std::int64_t J, const Visit& visit) const {
  std::vector<int> all, places;
  Numbers y, derivatives;
  const Columns columns(*this, section, J, Columns::Of::all);
  for (const Batch& b : batches_) {
    all.resize(b.size), places.resize(b.size), y.resize(b.size);
    std::iota(all.begin(), all.end(), 0);
    derivatives.resize(jacobian ? at(b.size * b.size) : at(b.size));
    const int numbers = static_cast<int>(derivatives.size());
    strips(b, columns, J, numbers, !jacobian, [&](const StencilBatch& strip, int first, Pack* out, Pack*) {
      if (jacobian) b.family->jacobian(strip, all, all, numbers_of(out));
      else b.family->residual(strip, all, numbers_of(out));
      for (int s = 0; s < std::min(strip.count, b.stencils - first); ++s) {
        for (int i = 0; i < b.size; ++i) {
          places[i] = b.place[b.read(i, first + s)] * components_ + b.family->values()[i].component;
          y[i] = strip.y[i * strip.count + s];
        }
        for (std::size_t n = 0; n < derivatives.size(); ++n)
          derivatives[n] = numbers_of(out)[n * at(strip.count) + at(s)];
        visit({*b.family, {b.number, {b.row, b.sites[first + s]}}, b.rows, places, y, derivatives});
      }
    });
  }
}

void Assembly::gather(const Local& local, SectionView V, std::int64_t J, std::vector<double>& v) {
  v.clear();
  for (std::size_t i = 0; i < local.places.size(); ++i) v.push_back(V.row(J + local.rows[i])[local.places[i]]);
}

std::vector<char> Assembly::present() const {
  const int depth = parts_.past + parts_.future + 1;
  int row_size = 0;
  for (const Batch& b : batches_)
    for (const int place : b.place) row_size = std::max(row_size, (place + 1) * components_);
  SectionRing ring(depth, at(row_size));
  std::mt19937_64 engine(20251121);
  std::vector<char> found(places_.size(), false);
  std::vector<double> values;
  for (int sample = 0; sample < 3; ++sample) {
    for (int r = 0; r < depth; ++r)
      for (int n = 0; n < row_size; ++n) ring.row(r)[n] = 4.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 2.0;
    jacobian(ring, depth, values);
    std::vector<double> largest(size(), 0.0);
    for (std::size_t p = 0; p < values.size(); ++p) {
      double& size = largest[places_[p].equation];
      size = std::max(size, std::abs(values[p]));
    }
    for (std::size_t p = 0; p < values.size(); ++p)
      if (!(std::abs(values[p]) <= 1e-13 * largest[places_[p].equation])) found[p] = true;
  }
  return found;
}

int Assembly::stencils() const {
  return std::accumulate(batches_.begin(), batches_.end(), 0, [](int n, const Batch& b) { return n + b.stencils; });
}

std::size_t Assembly::bytes() const {
  std::size_t total = places_.size() * sizeof(Place) + fixed_.size() * sizeof(double) +
                      columns_.capacity() * sizeof(double) +
                      (parts_.equations.size() + parts_.unknowns.size()) * sizeof(Node);
  for (const Batch& b : batches_)
    total += sizeof(Batch) + b.x.size() * sizeof(Pack) + b.gained.size() * sizeof(double) + b.side_by_side.size() +
             (b.sites.size() + b.rows.size() + b.place.size() + b.equation.size() + b.entry.size() +
              b.gains.size() * at(b.padded)) *
                 sizeof(int);
  return total;
}

}  // namespace delf
