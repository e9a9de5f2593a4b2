// SPDX-License-Identifier: MIT
#include "schemes/stepping/kick_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "jets/fibre.hpp"
#include "jets/simd/exact_sum.hpp"
#include "jets/simd/pack_gather.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/newton.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/driven_values.hpp"
#include "schemes/system/momenta.hpp"

namespace delf {
namespace {

constexpr int rows_held = 5, strip = 256;

double* numbers(std::vector<Pack>& packs) { return reinterpret_cast<double*>(packs.data()); }
const double* numbers(const std::vector<Pack>& packs) { return reinterpret_cast<const double*>(packs.data()); }

/// The number of a listed stencil's own that is its place.
int place_number(const StencilFamily& family) {
  const DensityOnTable* const of = family.made_of();
  return of == nullptr ? -1 : of->table.points.front().own.place;
}

}  // namespace

/// What a slab's families add up to, node by node, while they are read.
struct KickStepper::Parts {
  struct Entry {
    int row, column;
    double value;
  };
  int fields, nodes, sites, padded;
  std::vector<std::vector<Entry>> entries;          ///< [node]: of K
  std::vector<std::vector<double>> constant, mass;  ///< [node][place]
  std::vector<std::vector<Source>> sources;

  Parts(int d, int S, int N)
      : fields(d),
        nodes(S),
        sites(N),
        padded((N + lanes - 1) / lanes * lanes),
        entries(at(S + 1)),
        constant(at(S + 1), std::vector<double>(d * padded, 0.0)),
        mass(at(S), std::vector<double>(d * padded, 0.0)),
        sources(at(S + 1)) {}

  int place(int site, int a) const { return a * padded + site; }

  /// A value of a stencil: which node of the slab, and where it is there.
  struct Value {
    int node, place;
    bool data;
  };
  Value value(const LatticeSystem& system, const StencilFamily& family, int anchor, int i) const {
    const int component = family.values()[i].component, site = family.column(anchor, i);
    return {family.site(i).time * nodes + component / fields, place(site, component % fields),
            system.is_held(site, component)};
  }
  bool add(const LatticeSystem&, const StencilFamily&, int anchor, const std::vector<Value>&);
  /// Sorts entries by row and column, and adds those of one place up in the order in which they came.
  static void collect(std::vector<Entry>&);
  bool add_sources(const LatticeSystem&, const StencilFamily&, int anchor, const std::vector<Value>&,
                   std::map<std::pair<int, int>, std::size_t>& known);
  Source new_source(const LatticeSystem&, const StencilFamily&, int group) const;
  void keep_some(Source&) const;
  Kick kick(std::initializer_list<int> nodes) const;
  bool is_symmetric() const;
};

bool KickStepper::Parts::add(const LatticeSystem& system, const StencilFamily& family, int anchor,
                             const std::vector<Value>& values) {
  // The kinetic terms are as 1/h and the others as h: in a step 2⁶⁰ times as long the others are left, without the rounding
  // of their difference from the kinetic ones.
  constexpr double longer = 0x1p60;
  Cell cell{system.time_step(), system.lattice().space_step(), 0, 0, anchor};
  const auto part = family.constant_part(cell);
  cell.time_step *= longer;
  const auto others = family.constant_part(cell);
  if (!part || !others) return false;
  constexpr double tiny = 0x1p-100;  // what is left of a kinetic term
  const std::size_t n = values.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Value& v = values[i];
    if (v.data) continue;
    constant[v.node][v.place] += others->r0[i] / longer;
    for (std::size_t m = 0; m < n; ++m) {
      const double J = part->J[i * n + m];
      const Value& u = values[m];
      if (J == 0) continue;
      const double K = others->J[i * n + m] / longer;
      const bool is_kinetic = std::abs(K) <= tiny * std::abs(J);
      if (u.node == v.node) {
        if (!is_kinetic) entries[v.node].push_back({v.place, u.place, K});
      } else if (!is_kinetic || u.place != v.place || std::abs(u.node - v.node) != 1) return false;
      else if (u.node > v.node) mass[v.node][v.place] -= J;
    }
  }
  return true;
}

void KickStepper::Parts::collect(std::vector<Entry>& all) {
  std::ranges::stable_sort(all, {}, [](const Entry& e) { return std::pair(e.row, e.column); });
  auto last = all.begin();
  for (auto next = last; next != all.end(); ++next) {
    if (next == all.begin()) continue;
    if (next->row == last->row && next->column == last->column) last->value += next->value;
    else *++last = *next;
  }
  if (!all.empty()) all.erase(last + 1, all.end());
}

KickStepper::Source KickStepper::Parts::new_source(const LatticeSystem& system, const StencilFamily& family,
                                                   int group) const {
  Source source{&family, group, Packs(at(fields * padded / lanes), Pack(0.0)), {}, {}};
  if (!family.is_placed()) return source;
  // Sites without a stencil, and what packs are padded with, read a place where the density has a value.
  const double any = family.listed() ? family.own_number(place_number(family), 0) : system.lattice().position(0);
  source.x.assign(at(padded / lanes), Pack(any));
  return source;
}

/// The weights and places of the sites of a family that is of a few of them alone.
void KickStepper::Parts::keep_some(Source& source) const {
  const ListedStencils* const listed = source.family->listed();
  if (listed == nullptr || listed->size() >= sites) return;
  for (int s = 0; s < listed->size(); ++s) source.sites.push_back(listed->site(s, 0));
  const std::size_t own = source.sites.size(), all = (own + lanes - 1) / lanes * lanes;
  source.sites.resize(all, source.sites.front());
  Packs weights(at(fields) * all / lanes, Pack(0.0)), x(source.x.empty() ? 0 : all / lanes, Pack(0.0));
  for (std::size_t n = 0; n < all; ++n) {
    for (int a = 0; a < fields && n < own; ++a)
      numbers(weights)[at(a) * all + n] = numbers(source.weights)[place(source.sites[n], a)];
    if (!x.empty()) numbers(x)[n] = numbers(source.x)[source.sites[n]];
  }
  source.weights = std::move(weights), source.x = std::move(x);
}

bool KickStepper::Parts::add_sources(const LatticeSystem& system, const StencilFamily& family, int anchor,
                                     const std::vector<Value>& values,
                                     std::map<std::pair<int, int>, std::size_t>& known) {
  const SourceTerms* const terms = family.sources();
  if (terms == nullptr) return false;
  const double hk = system.time_step() * system.lattice().space_step();
  for (int g = 0; g < static_cast<int>(terms->groups.size()); ++g) {
    const SourceTerms::Group& group = terms->groups[g];
    // the inputs are the fields of one site at one node, as they are
    std::vector<Value> inputs;
    for (const auto& input : group.inputs) {
      if (input.size() != 1 || input[0].weight != 1) return false;
      const auto i = std::ranges::find_if(family.values(), [&](const VertexValue& value) {
        const Site& v = family.pattern().vertices[value.vertex];
        return v.time == input[0].vertex.time && v.space == input[0].vertex.space &&
               value.component == input[0].component;
      });
      inputs.push_back(values[i - family.values().begin()]);
    }
    for (int c = 0; c < terms->outputs_per_group; ++c)
      for (int i = 0; i < family.size(); ++i) {
        const double weight = terms->weight(g * terms->outputs_per_group + c, i);
        if (weight == 0) continue;
        const Value& v = values[i];
        // N′ of component c kicks the same one, there
        if (v.node != inputs[c].node || v.place != inputs[c].place) return false;
        if (v.data) continue;
        if (family.is_placed() &&
            group.time != family.site(i).time + system.component(family.values()[i].component).at.time)
          return false;
        std::vector<Source>& list = sources[v.node];
        const auto [found, fresh] = known.try_emplace({v.node, g}, list.size());
        if (fresh) list.push_back(new_source(system, family, g));
        Source& source = list[found->second];
        if (family.is_placed() && family.listed())
          numbers(source.x)[v.place % padded] = family.own_number(place_number(family), anchor);
        numbers(source.weights)[v.place] += hk * weight * family.own_number(group.own, anchor);
      }
  }
  return true;
}

/// The kick of some nodes that are one: of the slab below and the slab above a row.
KickStepper::Kick KickStepper::Parts::kick(std::initializer_list<int> of) const {
  Kick kick;
  std::vector<Entry> K;
  kick.constant.assign(fields * padded / lanes, Pack(0.0));
  for (const int node : of) {
    K.insert(K.end(), entries[node].begin(), entries[node].end());
    for (int n = 0; n < fields * padded; ++n) numbers(kick.constant)[n] += constant[node][n];
    for (const Source& source : sources[node]) {
      // The functions of a family are those of its density, whatever the group.
      const auto same = std::ranges::find(kick.sources, source.family, &Source::family);
      if (same == kick.sources.end()) kick.sources.push_back(source);
      else
        for (std::size_t p = 0; p < source.weights.size(); ++p) same->weights[p] += source.weights[p];
    }
  }
  for (Source& source : kick.sources) keep_some(source);
  if (std::ranges::all_of(kick.constant, [](const Pack& c) { return max_or_nan(abs(c)) == 0; })) kick.constant.clear();
  collect(K);
  auto next = K.begin();
  for (int pack = 0; pack < fields * padded; pack += lanes) {
    kick.first.push_back(static_cast<std::int32_t>(kick.value.size()));
    const auto begin = next;
    // How many rows of the pack have an entry so far from their own place; then the entry that they share.
    std::map<int, int> entry_at;
    for (; next != K.end() && next->row < pack + lanes; ++next) ++entry_at[next->column - next->row];
    const auto add = [&](int column) {
      kick.column.push_back(column), kick.value.emplace_back(0.0);
      return static_cast<int>(kick.value.size()) - 1;
    };
    // Rows without an entry there read a value and take nothing of it.
    for (auto& [apart, at] : entry_at) {
      const bool shared = 2 * at >= lanes && pack + apart >= 0 && pack + apart + lanes <= fields * padded;
      at = shared ? add(pack + apart) : -1;
    }
    std::array<int, lanes> own;
    own.fill(static_cast<int>(kick.value.size()));
    for (auto entry = begin; entry != next; ++entry) {
      const int lane = entry->row - pack, shared = entry_at[entry->column - entry->row],
                e = shared < 0 ? own[lane]++ : shared;
      if (e == static_cast<int>(kick.value.size()))
        add(~static_cast<int>(kick.listed.size())), kick.listed.insert(kick.listed.end(), at(lanes), pack);
      if (shared < 0) kick.listed[~kick.column[e] + lane] = entry->column;
      numbers(kick.value)[e * lanes + lane] = entry->value;
    }
  }
  kick.first.push_back(static_cast<std::int32_t>(kick.value.size()));
  return kick;
}

/// A row's kick from below is its kick from above.
bool KickStepper::Parts::is_symmetric() const {
  const Kick below = kick({nodes}), above = kick({0});
  const auto equal = [](const Packs& a, const Packs& b) {
    double most = 0, apart = 0;
    if (a.size() != b.size()) return false;
    for (std::size_t n = 0; n < a.size() * lanes; ++n) {
      most = std::max(most, std::abs(numbers(a)[n]));
      apart = std::max(apart, std::abs(numbers(a)[n] - numbers(b)[n]));
    }
    return apart <= 1e-14 * most;
  };
  return below.column == above.column && below.listed == above.listed && equal(below.value, above.value) &&
         equal(below.constant, above.constant) &&
         std::ranges::equal(below.sources, above.sources, [&](const Source& a, const Source& b) {
           return a.family == b.family && equal(a.weights, b.weights);
         });
}

std::unique_ptr<StepMethod> KickStepper::make(const LatticeSystem& system, const SolvePlan& plan,
                                              const StepOptions& options) {
  const Lattice& lattice = system.lattice();
  if ((lattice.space() != Space::mesh && lattice.space() != Space::point) || system.height() != 1 ||
      !options.processor.empty() || options.fibre != Fibre::real || plan.history > 2)
    return nullptr;
  const int d = system.fields(), C = system.components(), N = lattice.sites();
  for (const Component& c : system.all_components())
    if (c.role != Role::field && c.role != Role::inner) return nullptr;
  if (C % d != 0) return nullptr;
  Parts parts(d, C / d, N);
  for (const auto& family : system.families()) {
    if (!family->is_variational()) return nullptr;
    std::map<std::pair<int, int>, std::size_t> known;
    std::vector<Parts::Value> values(family->size());
    for (int anchor = 0; anchor < system.anchors(*family); ++anchor) {
      if (!system.has_stencil(*family, 0, anchor)) continue;
      for (int i = 0; i < family->size(); ++i) values[i] = parts.value(system, *family, anchor, i);
      if (!parts.add(system, *family, anchor, values) || !parts.add_sources(system, *family, anchor, values, known))
        return nullptr;
    }
  }
  for (auto& entries : parts.entries) Parts::collect(entries);
  for (const auto& mass : parts.mass)
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < d; ++a)
        if (!system.is_held(i, a) && !(std::abs(mass[parts.place(i, a)]) > 0)) return nullptr;
  if (options.steps_vary && !parts.is_symmetric()) return nullptr;
  return std::unique_ptr<StepMethod>(new KickStepper(system, options, std::move(parts)));
}

KickStepper::KickStepper(const LatticeSystem& system, const StepOptions& options, Parts parts)
    : system_(system),
      monodromy_(options.monodromy),
      tolerance_(options.tolerance),
      max_iterations_(options.max_iterations),
      fields_(parts.fields),
      nodes_(parts.nodes),
      padded_(parts.padded),
      slots_(at(rows_held)) {
  const std::size_t packs = at(fields_ * padded_ / lanes);
  for (const Component& c : system.all_components()) behind_.push_back(c.role == Role::field ? 0 : 1);
  alone_ = parts.kick({0});
  kicks_.push_back(parts.kick({nodes_, 0}));
  for (int node = 1; node < nodes_; ++node) kicks_.push_back(parts.kick({node}));
  for (int node = 0; node < nodes_; ++node) {
    inverse_.emplace_back(packs, Pack(0.0));
    for (int place = 0; place < fields_ * padded_; ++place)
      if (const double M = parts.mass[node][place]; M != 0) numbers(inverse_.back())[place] = 1 / M;
  }
  ring_.assign(rows_held * nodes_, {Packs(packs, Pack(0.0)), Packs(packs, Pack(0.0))});
  std::iota(slots_.begin(), slots_.end(), 0);
  momentum_.assign(packs, Pack(0.0));
  inputs_.resize(fields_);
}

/// Rows that are no longer there are those next to them that are.
std::size_t KickStepper::index(std::int64_t row, int node) const {
  const auto back = std::clamp<std::int64_t>(newest_ - row, 0, std::max(held_ - 1, 0));
  return at(slots_[back] * nodes_ + node);
}

/// P ← P + κ w N′(y) at some sites.
void KickStepper::kick_some(const Source& source, double of_kick, double t, const double* from, double* P) const {
  const int all = static_cast<int>(source.sites.size());
  for (int first = 0; first < all; first += strip) {
    const int count = std::min(strip, all - first);
    const ScratchRows y(fields_, count), slope(fields_, count);
    for (int a = 0; a < fields_; ++a)
      for (int n = 0; n < count; ++n) y[a][n] = from[a * padded_ + source.sites[at(first + n)]];
    source.family->evaluate_sources(
        source.group, {count, y.data(), t, source.x.empty() ? nullptr : numbers(source.x) + first}, slope.data());
    for (int a = 0; a < fields_; ++a)
      for (int n = 0; n < count; ++n)
        P[a * padded_ + source.sites[at(first + n)]] +=
            of_kick * numbers(source.weights)[a * all + first + n] * slope[a][n];
  }
}

/// P ← P + κ (K y + c + w N′(y)),   y′ = y + δ M⁻¹ P, strip by strip, with κ and δ as they are given.
void KickStepper::kick_and_drift(const Kick& kick, int n, double of_kick, double of_drift, double t, Node& next) {
  const Node& here = node(newest_, n);
  const double *const from = numbers(here.y), *const from_low = numbers(here.low), *const drift = numbers(inverse_[n]),
                      *const value = numbers(kick.value),
                      *const constant = kick.constant.empty() ? nullptr : numbers(kick.constant);
  double *const P = numbers(momentum_), *const to = numbers(next.y), *const to_low = numbers(next.low);
  const ScratchRows slope(fields_, strip);
  const std::int32_t *const column = kick.column.data(), *const listed = kick.listed.data();
  for (const Source& source : kick.sources)
    if (!source.sites.empty()) kick_some(source, of_kick, t, from, P);
  for (int first = 0; first < padded_; first += strip) {
    const int count = std::min(strip, padded_ - first);
    for (int a = 0; a < fields_; ++a) {
      const int begin = a * padded_ + first;
      for (int i = begin; i < begin + count; i += lanes) {
        Pack sum = constant ? Pack::load(constant + i) : Pack(0.0);
        const int end = kick.first[i / lanes + 1];
        for (int e = kick.first[i / lanes]; e < end; ++e)
          sum += Pack::load(value + e * lanes) *
                 (column[e] >= 0 ? load_unaligned(from + column[e]) : gather(from, listed + ~column[e]));
        (Pack::load(P + i) + of_kick * sum).store(P + i);
      }
      inputs_[a] = from + begin;
    }
    for (const Source& source : kick.sources) {
      if (!source.sites.empty()) continue;
      const double* const x = source.x.empty() ? nullptr : numbers(source.x) + first;
      source.family->evaluate_sources(source.group, {count, inputs_.data(), t, x}, slope.data());
      for (int a = 0; a < fields_; ++a) {
        const int begin = a * padded_ + first;
        const double* const weight = numbers(source.weights) + begin;
        for (int i = 0; i < count; i += lanes)
          (Pack::load(P + begin + i) + of_kick * Pack::load(weight + i) * Pack::load(slope[a] + i))
              .store(P + begin + i);
      }
    }
    for (int a = 0; a < fields_; ++a) {
      const int begin = a * padded_ + first;
      for (int i = begin; i < begin + count; i += lanes) {
        Pack moved = Pack::load(from + i), low = Pack::load(from_low + i);
        add_exactly(moved, low, of_drift * Pack::load(drift + i) * Pack::load(P + i));
        moved.store(to + i), low.store(to_low + i);
        largest_ = largest_magnitude(largest_, moved);
      }
    }
  }
}

/// `share_below` of the kick at the row is of the slab below it.
void KickStepper::take_slab(const Kick& first, double share_below) {
  const FlushDenormals guard;
  largest_ = Pack(0.0);
  const RowTimes& times = *system_.times();
  const double h = system_.time_step(), above = times.step(newest_) / h,
               below = newest_ > 0 ? times.step(newest_ - 1) / h : above;
  const int slot = slots_.back();
  for (int n = 0; n < nodes_; ++n) {
    const double kick = n == 0 ? share_below * below + (1 - share_below) * above : above;
    const double t = times.time(newest_) + system_.component(n * fields_).at.time * times.step(newest_);
    Node& next = n + 1 < nodes_ ? node(newest_, n + 1) : ring_[slot * nodes_];
    kick_and_drift(n == 0 ? first : kicks_[n], n, kick, above, t, next);
    set_driven(n + 1 < nodes_ ? times.time(newest_) + system_.component((n + 1) * fields_).at.time * times.step(newest_)
                              : times.time(newest_ + 1),
               next);
  }
  if (overflowed(max_or_nan(largest_)))
    throw NotFinite(
        fmt::format("step {}, t = {:.6g}: the field is not finite; reduce lattice.time_step or lattice.courant",
                    newest_ + 1, times.time(newest_ + 1)));
  std::ranges::rotate(slots_, slots_.end() - 1);
  held_ = std::min(held_ + 1, rows_held);
  ++newest_;
}

std::vector<double> KickStepper::row_of(std::int64_t row, int behind, bool low) const {
  const int C = system_.components(), N = system_.lattice().sites();
  std::vector<double> values(N * C);
  for (int n = 0; n < nodes_; ++n) {
    const Node& from = node(std::max<std::int64_t>(0, n == 0 ? row : row - behind), n);
    for (int a = 0; a < fields_; ++a) {
      const double* const field = numbers(low ? from.low : from.y) + a * padded_;
      for (int i = 0; i < N; ++i) values[i * C + n * fields_ + a] = field[i];
    }
  }
  return values;
}

/// The fields of a row [i·C + c] as the values at a node. Packs are padded with copies of the last site, where the density has
/// a value: at 0 it need not have one.
void KickStepper::read(const std::vector<double>& row, Packs& y) const {
  const int C = system_.components(), last = system_.lattice().sites() - 1;
  for (int i = 0; i < padded_; ++i)
    for (int a = 0; a < fields_; ++a) numbers(y)[a * padded_ + i] = row[at(std::min(i, last) * C + a)];
}

void KickStepper::set_driven(double t, Node& node) const {
  for (const auto& [point, given] : driven_points(system_))
    for (int a = 0; a < fields_; ++a) {
      const int place = a * padded_ + point;
      numbers(node.y)[place] = given->value(a, t), numbers(node.low)[place] = 0;
    }
}

void KickStepper::start(const std::vector<std::vector<double>>& rows) {
  if (nodes_ > 1)
    throw BadInput("initial.start", "initial.start = exact: sub-steps begin from a row and its momenta; use legendre");
  newest_ = static_cast<std::int64_t>(rows.size()) - 1, held_ = 2;
  for (Node& any : ring_) std::ranges::fill(any.low, Pack(0.0));
  Packs &newest = node(newest_, 0).y, &before = node(newest_ - 1, 0).y;
  read(rows.back(), newest), read(rows[rows.size() - 2], before);
  for (const std::int64_t row : {newest_ - 1, newest_}) set_driven(system_.times()->time(row), node(row, 0));
  // P = M (y₁ − y₀) h/h₀
  const double longer = system_.times()->step(newest_ - 1) / system_.time_step();
  for (int n = 0; n < fields_ * padded_; ++n) {
    const double inverse = numbers(inverse_[0])[n];
    numbers(momentum_)[n] = inverse == 0 ? 0 : (numbers(newest)[n] - numbers(before)[n]) / (inverse * longer);
  }
}

void KickStepper::start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) {
  if (nodes_ > 1) return StepMethod::start_centred(row0, velocity);
  const SolvePlan plan = make_plan(system_.lattice(), system_.pattern());
  start({row0, solve_centred_start(system_, plan, system_.window(0, {row0}, monodromy_), velocity, false, tolerance_,
                                   max_iterations_)
                   .row});
}

void KickStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  newest_ = 0, held_ = 1;
  Node& first = node(0, 0);
  read(row0, first.y), read(momenta, momentum_);
  std::ranges::fill(first.low, Pack(0.0));
  set_driven(system_.times()->time(0), first);
  for (int i = 0; i < system_.lattice().sites(); ++i)
    for (int a = 0; a < fields_; ++a)
      if (system_.is_held(i, a)) numbers(momentum_)[a * padded_ + i] = 0;
  take_slab(alone_, 0);
}

void KickStepper::step(bool /*looked_at*/) { take_slab(kicks_[0], 0.5); }

std::vector<double> KickStepper::row(int back) const { return row_of(newest_ - back, 1, false); }

Window KickStepper::window(int rows) const {
  std::vector<std::vector<double>> newest_rows, low_rows;
  const std::int64_t first = newest_ - rows + 1;
  for (std::int64_t r = first; r <= newest_; ++r) {
    newest_rows.push_back(row_of(r, 0, false));
    low_rows.push_back(row_of(r, 0, true));
  }
  Window window = system_.window(first, std::move(newest_rows), monodromy_);
  window.low = std::move(low_rows);
  return window;
}

/// E = P below the row before the newest − P above it there, and at the nodes of the slab above ∂S/∂y_s.
double KickStepper::residual() const {
  if (newest_ < 2) return 0;  // of row 0 there are no equations
  if (held_ < 3) return std::numeric_limits<double>::quiet_NaN();
  const Window rows = window(3);
  std::vector<double> size_below, size_above;
  const std::vector<double> below = half_equations(system_, rows, newest_ - 1, Side::below, &size_below),
                            above = half_equations(system_, rows, newest_ - 1, Side::above, &size_above);
  const int C = system_.components();
  double worst = 0, size = 0;
  for (std::size_t n = 0; n < below.size(); ++n) {
    if (system_.is_held(static_cast<int>(n) / C, static_cast<int>(n) % C)) continue;
    worst = larger_or_nan(std::abs(below[n] - above[n]), worst);
    size = larger_or_nan(size_below[n] + size_above[n], size);
  }
  return size == 0 ? 0 : worst / size;
}

std::size_t KickStepper::bytes_of(const Kick& kick) {
  std::size_t sum = 4 * (kick.first.size() + kick.column.size() + kick.listed.size()) +
                    sizeof(Pack) * (kick.value.size() + kick.constant.size());
  for (const Source& source : kick.sources)
    sum += sizeof(Pack) * (source.weights.size() + source.x.size()) + 4 * source.sites.size();
  return sum;
}

StepReport KickStepper::report(bool /*residual*/) const {
  const std::size_t packs = sizeof(Pack) * momentum_.size(), rows = 2 * packs * ring_.size();
  std::size_t kicks = bytes_of(alone_);
  for (const Kick& kick : kicks_) kicks += bytes_of(kick);
  const std::size_t work = packs * (inverse_.size() + 1);
  return {.starting_rows = 2,
          .behind = behind_,
          .iterates = false,
          .solver = nodes_ > 1 ? "a sparse product and a division a sub-step" : "a sparse product and a division a row",
          .bytes = rows + kicks + work,
          .memory = fmt::format("rows of the section {} B, kicks {} B, work space {} B", rows, kicks, work)};
}

void KickStepper::visit(SavedState& state) {
  state("newest", newest_), state("rows held", held_), state("places of rows", slots_);
  state("momentum", momentum_);
  for (Node& node : ring_) state("values", node.y), state("low parts", node.low);
}

}  // namespace delf
