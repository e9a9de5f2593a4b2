// SPDX-License-Identifier: MIT
#include "schemes/stepping/kick_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "jets/fibre.hpp"
#include "jets/simd/exact_sum.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/system/slab_extent.hpp"

namespace delf {
namespace {

constexpr int rows_held = 6, strip = 256;

std::size_t at(int i) { return static_cast<std::size_t>(i); }
double* numbers(std::vector<Pack>& packs) { return reinterpret_cast<double*>(packs.data()); }
const double* numbers(const std::vector<Pack>& packs) { return reinterpret_cast<const double*>(packs.data()); }

}  // namespace

/// What a slab's families add up to, node by node, while they are read.
struct KickStepper::Parts {
  int fields, nodes, sites, padded;
  std::vector<std::map<std::pair<int, int>, double>> entries;  ///< [node]: of K
  std::vector<std::vector<double>> constant, mass;             ///< [node][place]
  std::vector<std::vector<Source>> sources;

  Parts(int d, int S, int N)
      : fields(d),
        nodes(S),
        sites(N),
        padded((N + lanes - 1) / lanes * lanes),
        entries(at(S + 1)),
        constant(at(S + 1), std::vector<double>(at(d * padded), 0.0)),
        mass(at(S), std::vector<double>(at(d * padded), 0.0)),
        sources(at(S + 1)) {}

  int place(int site, int a) const { return a * padded + site; }

  /// A value of a stencil: which node of the slab, and where it is there.
  struct Value {
    int node, place;
    bool data;
  };
  Value value(const LatticeSystem& system, const StencilFamily& family, int anchor, int i) const {
    const int component = family.values()[at(i)].component, site = family.column(anchor, i);
    return {family.site(i).time * nodes + component / fields, place(site, component % fields),
            system.is_held(site, component)};
  }
  bool add(const LatticeSystem&, const StencilFamily&, int anchor, const std::vector<Value>&);
  bool add_sources(const LatticeSystem&, const StencilFamily&, int anchor, const std::vector<Value>&,
                   std::map<std::pair<int, int>, std::size_t>& known);
  Kick kick(int node) const;
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
    constant[at(v.node)][at(v.place)] += others->r0[i] / longer;
    for (std::size_t m = 0; m < n; ++m) {
      const double J = part->J[i * n + m];
      const Value& u = values[m];
      if (J == 0) continue;
      if (u.node == v.node) {
        if (const double K = others->J[i * n + m] / longer; std::abs(K) > tiny * std::abs(J))
          entries[at(v.node)][{v.place, u.place}] += K;
      } else if (u.place != v.place || std::abs(u.node - v.node) != 1) return false;
      else if (u.node > v.node) mass[at(v.node)][at(v.place)] -= J;
    }
  }
  return true;
}

bool KickStepper::Parts::add_sources(const LatticeSystem& system, const StencilFamily& family, int anchor,
                                     const std::vector<Value>& values,
                                     std::map<std::pair<int, int>, std::size_t>& known) {
  const SourceTerms* const terms = family.sources();
  if (terms == nullptr) return false;
  const double hk = system.time_step() * system.lattice().space_step();
  for (int g = 0; g < static_cast<int>(terms->groups.size()); ++g) {
    const SourceTerms::Group& group = terms->groups[at(g)];
    // the inputs are the fields of one site at one node, as they are
    std::vector<Value> inputs;
    for (const auto& input : group.inputs) {
      if (input.size() != 1 || input[0].weight != 1) return false;
      const auto i = std::ranges::find_if(family.values(), [&](const VertexValue& value) {
        const Site& v = family.pattern().vertices[at(value.vertex)];
        return v.time == input[0].vertex.time && v.space == input[0].vertex.space && value.component == input[0].component;
      });
      inputs.push_back(values[static_cast<std::size_t>(i - family.values().begin())]);
    }
    for (int c = 0; c < terms->outputs_per_group; ++c)
      for (int i = 0; i < family.size(); ++i) {
        const double weight = terms->weight(g * terms->outputs_per_group + c, i);
        if (weight == 0) continue;
        const Value& v = values[at(i)];
        // N′ of component c kicks the same one, there
        if (v.node != inputs[at(c)].node || v.place != inputs[at(c)].place) return false;
        if (v.data) continue;
        std::vector<Source>& list = sources[at(v.node)];
        const auto [found, fresh] = known.try_emplace({v.node, g}, list.size());
        if (fresh) list.push_back({&family, g, Packs(at(fields * padded / lanes), Pack(0.0))});
        numbers(list[found->second].weights)[v.place] += hk * weight * family.own_number(group.own, anchor);
      }
  }
  return true;
}

KickStepper::Kick KickStepper::Parts::kick(int node) const {
  Kick kick;
  auto next = entries[at(node)].begin();
  for (int place = 0; place < fields * padded; ++place) {
    kick.first.push_back(static_cast<std::int32_t>(kick.column.size()));
    for (; next != entries[at(node)].end() && next->first.first == place; ++next)
      kick.column.push_back(next->first.second), kick.value.push_back(next->second);
  }
  kick.first.push_back(static_cast<std::int32_t>(kick.column.size()));
  kick.constant.resize(at(fields * padded / lanes));
  std::ranges::copy(constant[at(node)], numbers(kick.constant));
  kick.sources = sources[at(node)];
  return kick;
}

KickStepper::Kick KickStepper::sum(const Kick& a, const Kick& b) {
  Kick sum;
  const std::size_t rows = a.first.size() - 1;
  std::map<std::int32_t, double> row;
  for (std::size_t r = 0; r < rows; ++r) {
    row.clear();
    for (const Kick* kick : {&a, &b})
      for (auto e = kick->first[r]; e < kick->first[r + 1]; ++e) row[kick->column[at(e)]] += kick->value[at(e)];
    sum.first.push_back(static_cast<std::int32_t>(sum.column.size()));
    for (const auto& [column, value] : row) sum.column.push_back(column), sum.value.push_back(value);
  }
  sum.first.push_back(static_cast<std::int32_t>(sum.column.size()));
  sum.constant = a.constant;
  for (std::size_t p = 0; p < sum.constant.size(); ++p) sum.constant[p] += b.constant[p];
  sum.sources = a.sources;
  for (const Source& source : b.sources) {
    // The functions of a family are those of its density, whatever the group.
    const auto same = std::ranges::find(sum.sources, source.family, &Source::family);
    if (same == sum.sources.end()) sum.sources.push_back(source);
    else
      for (std::size_t p = 0; p < source.weights.size(); ++p) same->weights[p] += source.weights[p];
  }
  return sum;
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
    if (!family->is_variational() || family->is_placed()) return nullptr;
    std::map<std::pair<int, int>, std::size_t> known;
    std::vector<Parts::Value> values(at(family->size()));
    for (int anchor = 0; anchor < system.anchors(*family); ++anchor) {
      if (!system.has_stencil(*family, 0, anchor)) continue;
      for (int i = 0; i < family->size(); ++i) values[at(i)] = parts.value(system, *family, anchor, i);
      if (!parts.add(system, *family, anchor, values) ||
          !parts.add_sources(system, *family, anchor, values, known))
        return nullptr;
    }
  }
  for (const auto& mass : parts.mass)
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < d; ++a)
        if (!system.is_held(i, a) && !(std::abs(mass[at(parts.place(i, a))]) > 0)) return nullptr;
  return std::unique_ptr<StepMethod>(new KickStepper(system, plan, options, std::move(parts)));
}

KickStepper::KickStepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options, Parts parts)
    : system_(system),
      turn_(options.turn),
      fields_(parts.fields),
      nodes_(parts.nodes),
      padded_(parts.padded),
      behind_(slab_extent(system, plan).behind),
      low_rows_(rows_held, std::vector<double>(at(parts.sites * system.components()), 0.0)),
      rows_(rows_held, std::vector<double>(at(parts.sites * system.components()), 0.0)) {
  const std::size_t packs = at(fields_ * padded_ / lanes);
  alone_ = parts.kick(0);
  kicks_.push_back(sum(parts.kick(nodes_), alone_));
  for (int node = 1; node < nodes_; ++node) kicks_.push_back(parts.kick(node));
  for (int node = 0; node < nodes_; ++node) {
    inverse_.emplace_back(packs, Pack(0.0));
    for (int place = 0; place < fields_ * padded_; ++place)
      if (const double M = parts.mass[at(node)][at(place)]; M != 0) numbers(inverse_.back())[place] = 1 / M;
  }
  y_.assign(at(nodes_ + 1), Packs(packs, Pack(0.0)));
  low_ = y_;
  momentum_.assign(packs, Pack(0.0));
  inputs_.resize(at(fields_));
}

/// P ← P + K y + c + w N′(y),   y′ = y + M⁻¹ P, strip by strip.
void KickStepper::kick_and_drift(const Kick& kick, int node) {
  const double *const from = numbers(y_[at(node)]), *const from_low = numbers(low_[at(node)]),
                     *const constant = numbers(kick.constant), *const drift = numbers(inverse_[at(node)]);
  double *const P = numbers(momentum_), *const to = numbers(y_[at(node + 1)]), *const to_low = numbers(low_[at(node + 1)]);
  const ScratchRows slope(fields_, strip);
  const std::int32_t* const column = kick.column.data();
  const double* const value = kick.value.data();
  for (int first = 0; first < padded_; first += strip) {
    const int count = std::min(strip, padded_ - first);
    for (int a = 0; a < fields_; ++a) {
      const int begin = a * padded_ + first;
      for (int i = begin; i < begin + count; ++i) {
        double sum = constant[i];
        for (std::int32_t e = kick.first[at(i)]; e < kick.first[at(i) + 1]; ++e) sum += value[e] * from[column[e]];
        P[i] += sum;
      }
      inputs_[at(a)] = from + begin;
    }
    for (const Source& source : kick.sources) {
      source.family->evaluate_sources(source.group, {count, inputs_.data()}, slope.data());
      for (int a = 0; a < fields_; ++a) {
        const int begin = a * padded_ + first;
        const double* const weight = numbers(source.weights) + begin;
        for (int i = 0; i < count; i += lanes)
          (Pack::load(P + begin + i) + Pack::load(weight + i) * Pack::load(slope[a] + i)).store(P + begin + i);
      }
    }
    for (int a = 0; a < fields_; ++a) {
      const int begin = a * padded_ + first;
      for (int i = begin; i < begin + count; i += lanes) {
        Pack moved = Pack::load(from + i), low = Pack::load(from_low + i);
        add_exactly(moved, low, Pack::load(drift + i) * Pack::load(P + i));
        moved.store(to + i), low.store(to_low + i);
        largest_ = largest_magnitude(largest_, moved);
      }
    }
  }
}

void KickStepper::take_slab(const Kick& first) {
  const FlushDenormals guard;
  largest_ = Pack(0.0);
  for (int node = 0; node < nodes_; ++node)
    kick_and_drift(node == 0 ? first : kicks_[at(node)], node);
  if (overflowed(max_or_nan(largest_)))
    throw NotFinite(fmt::format("step {}, t = {:.6g}: the field is not finite; reduce lattice.time_step or lattice.courant",
                                newest_ + 1, system_.times()->time(newest_ + 1)));
  for (int node = 1; node < nodes_; ++node) keep(newest_, node);
  std::swap(y_.front(), y_.back()), std::swap(low_.front(), low_.back());
  keep(++newest_, 0);
}

void KickStepper::keep(std::int64_t row, int node) {
  const std::size_t C = at(system_.components()), slot = static_cast<std::size_t>(row) % rows_.size();
  for (const auto& [all, to] : {std::pair{&y_, &rows_[slot]}, {&low_, &low_rows_[slot]}})
    for (int a = 0; a < fields_; ++a) {
      const double* const from = numbers((*all)[at(node)]) + a * padded_;
      double* place = to->data() + node * fields_ + a;
      for (int i = 0; i < system_.lattice().sites(); ++i, place += C) *place = from[i];
    }
}

/// The fields of a row [i·C + c] as the values at a node. Packs are padded with copies of the last site, where the density has
/// a value: at 0 it need not have one.
void KickStepper::read(const std::vector<double>& row, Packs& y) const {
  const int C = system_.components(), last = system_.lattice().sites() - 1;
  for (int i = 0; i < padded_; ++i)
    for (int a = 0; a < fields_; ++a) numbers(y)[a * padded_ + i] = row[at(std::min(i, last) * C + a)];
}

void KickStepper::start(const std::vector<std::vector<double>>& rows) {
  if (nodes_ > 1)
    throw BadInput("initial.start", "initial.start = exact: sub-steps begin from a row and its momenta; use legendre");
  for (Packs& low : low_) std::fill(low.begin(), low.end(), Pack(0.0));
  for (auto& low : low_rows_) std::fill(low.begin(), low.end(), 0.0);
  for (std::size_t r = 0; r < rows.size(); ++r) ring(static_cast<std::int64_t>(r)) = rows[r];
  newest_ = static_cast<std::int64_t>(rows.size()) - 1;
  // P = M (y₁ − y₀)
  read(rows[rows.size() - 2], y_[1]), read(rows.back(), y_[0]);
  for (int n = 0; n < fields_ * padded_; ++n) {
    const double inverse = numbers(inverse_[0])[n];
    numbers(momentum_)[n] = inverse == 0 ? 0 : (numbers(y_[0])[n] - numbers(y_[1])[n]) / inverse;
  }
}

void KickStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  read(row0, y_[0]), read(momenta, momentum_);
  for (int i = 0; i < system_.lattice().sites(); ++i)
    for (int a = 0; a < fields_; ++a)
      if (system_.is_held(i, a)) numbers(momentum_)[a * padded_ + i] = 0;
  std::fill(low_[0].begin(), low_[0].end(), Pack(0.0));
  newest_ = 0;
  ring(0) = row0;
  std::fill(low_rows_[0].begin(), low_rows_[0].end(), 0.0);
  take_slab(alone_);
}

void KickStepper::step(bool /*looked_at*/) { take_slab(kicks_[0]); }

std::vector<double> KickStepper::row(int back) const {
  std::vector<double> result(ring(newest_).size());
  const std::size_t C = at(system_.components());
  for (std::size_t c = 0; c < C; ++c) {
    const std::vector<double>& from = ring(std::max<std::int64_t>(0, newest_ - back - behind_[c]));
    for (std::size_t n = c; n < result.size(); n += C) result[n] = from[n];
  }
  return result;
}

Window KickStepper::window(int rows) const {
  std::vector<std::vector<double>> newest_rows;
  const std::int64_t first = newest_ - rows + 1;
  for (std::int64_t r = first; r <= newest_; ++r) newest_rows.push_back(ring(std::max<std::int64_t>(r, 0)));
  Window window = system_.window(first, std::move(newest_rows), turn_);
  for (std::int64_t r = first; r <= newest_; ++r)
    window.low.push_back(low_rows_[static_cast<std::size_t>(std::max<std::int64_t>(r, 0)) % rows_.size()]);
  return window;
}

/// E = P below the row before the newest − P above it there, and at the nodes of the slab above ∂S/∂y_s.
double KickStepper::residual() const {
  if (newest_ < 2) return 0;  // of row 0 there are no equations
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
  std::size_t sum = 4 * (kick.first.size() + kick.column.size()) + 8 * kick.value.size() + sizeof(Pack) * kick.constant.size();
  for (const Source& source : kick.sources) sum += sizeof(Pack) * source.weights.size();
  return sum;
}

StepReport KickStepper::report(bool /*residual*/) const {
  const std::size_t packs = sizeof(Pack) * momentum_.size();
  std::size_t rows = 0, kicks = bytes_of(alone_);
  for (const auto& row : rows_) rows += 16 * row.size();
  for (const Kick& kick : kicks_) kicks += bytes_of(kick);
  const std::size_t work = packs * (2 * y_.size() + inverse_.size() + 1);
  return {.starting_rows = 2,
          .behind = behind_,
          .iterates = false,
          .solver = nodes_ > 1 ? "a sparse product and a division a sub-step" : "a sparse product and a division a row",
          .bytes = rows + kicks + work,
          .memory = fmt::format("rows of the section {} B, kicks {} B, work space {} B", rows, kicks,
                                work)};
}

void KickStepper::visit(SavedState& state) {
  state("newest", newest_);
  state("values", y_[0]), state("momentum", momentum_);
  state("low parts of values", low_[0]);
  for (auto* rows : {&rows_, &low_rows_})
    for (auto& row : *rows) state("row", row);
}

}  // namespace delf
