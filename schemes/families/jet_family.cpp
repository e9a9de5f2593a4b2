// SPDX-License-Identifier: MIT
#include "schemes/families/jet_family.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "jets/simd/exact_sum.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/slot_places.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// h^−time k^−space of each slot.
std::array<double, jet_slots> slot_scales(const Cell& cell) {
  std::array<double, jet_slots> scales;
  const double per_h = 1 / cell.time_step, per_k = 1 / cell.space_step;
  for (int s = 0; s < jet_slots; ++s) {
    double& scale = scales[s] = 1;
    for (int power = slot_powers[at(s)].time; power > 0; --power) scale *= per_h;
    for (int power = slot_powers[at(s)].space; power > 0; --power) scale *= per_k;
  }
  return scales;
}

/// y += w x, `count` numbers.
void add(double* y, double w, const double* x, int count) {
  for (int i = 0; i < count; i += lanes) (Pack::load(y + i) + w * Pack::load(x + i)).store(y + i);
}
/// y += w a b c x, where a, b and c are numbers of the stencils' own, or null for 1.
void add(double* y, double w, std::array<const double*, 3> own, const double* x, int count) {
  std::ranges::partition(own, [](const double* numbers) { return numbers != nullptr; });
  if (own[0] == nullptr) return add(y, w, x, count);
  for (int i = 0; i < count; i += lanes) {
    Pack factor = w * Pack::load(own[0] + i);
    for (int n = 1; n < 3 && own[n] != nullptr; ++n) factor = factor * Pack::load(own[n] + i);
    (Pack::load(y + i) + factor * Pack::load(x + i)).store(y + i);
  }
}
void fill_zero(double* y, int count) { std::fill_n(y, count, 0.0); }

/// use(entries) for each run of entries with an equal key.
template <class Entry>
void for_each_equal(const std::vector<Entry>& entries, int Entry::*key, const auto& use) {
  for (auto first = entries.begin(), last = first; first != entries.end(); first = last) {
    last = std::find_if(first, entries.end(), [&](const Entry& e) { return e.*key != (*first).*key; });
    use(std::span<const Entry>(first, last));
  }
}

bool is_rate(int slot) { return slot_powers[at(slot)].time > 0; }

}  // namespace

/// The jets of some stencils at a point of the table: what a density is evaluated at.
struct JetFamily::Jets {
  static constexpr int most = 16 * lanes;  ///< stencils at once

  Jets(const JetFamily& family, const StencilBatch& batch)
      : d(family.d_),
        variables(family.of_.density->variables()),
        scales(slot_scales(batch.cell)),
        area(family.of_.table.measure * batch.cell.time_step * batch.cell.space_step),
        jets(variables, std::min(batch.count, most)),
        increments(batch.low != nullptr ? family.size() : 0, std::min(batch.count, most)),
        x(1, std::min(batch.count, most)),
        numbers(static_cast<int>(family.own_.numbers.size()), std::min(batch.count, most)),
        family_(family),
        batch_(batch) {}

  /// The stencils that at_point() is about to be asked of.
  void look_at(int first, int count) {
    if (const OwnWeights& own = family_.own_; own.stencils) {
      std::array<int, most> sets;
      for (int s = 0; s < count; ++s) sets[s] = own.set(batch_.numbers[first + s]);
      for (std::size_t n = 0; n < own.numbers.size(); ++n)
        for (int s = 0; s < count; ++s) numbers[static_cast<int>(n)][s] = own.numbers[n][sets[s]];
    }
    if (batch_.low == nullptr) return;
    for (int i = 0; i < family_.size(); ++i) {
      const int from = family_.first_[i / d] * d + i % d;
      if (from == i) {
        fill_zero(increments[i], count);
        continue;
      }
      const double *const y = value(i) + first, *const y0 = value(from) + first;
      const double *const low = y + (batch_.low - batch_.y), *const low0 = y0 + (batch_.low - batch_.y);
      for (int s = 0; s < count; s += lanes)
        ((Pack::load(y + s) - Pack::load(y0 + s)) + (Pack::load(low + s) - Pack::load(low0 + s)))
            .store(increments[i] + s);
    }
  }

  /// j_q = M_q y of the stencils first … first + count − 1.
  JetBatch at_point(const TablePoint& p, int first, int count) {
    for (int s = 0; s * d < variables; ++s)
      for (int a = 0; a < d; ++a) {
        double* const jet = jets[s * d + a];
        if (!p.own.slots[at(s)].empty()) {
          const auto& entries = p.slots[at(s)];
          fill_zero(jet, count);
          for (std::size_t e = 0; e < entries.size(); ++e) {
            const int value_number = entries[e].vertex * d + a;
            const double* const from =
                batch_.low != nullptr && is_rate(s) ? increments[value_number] : value(value_number) + first;
            add(jet, entries[e].weight * scales[s], {own(p.own.slots[at(s)][e])}, from, count);
          }
          continue;
        }
        for (int i = 0; i < count; i += lanes) {
          Pack sum(0.0);
          if (batch_.low != nullptr && is_rate(s))
            for (const auto& [vertex, weight] : p.slots[at(s)])
              sum += (weight * scales[s]) * Pack::load(increments[vertex * d + a] + i);
          else
            for (const auto& [vertex, weight] : p.slots[at(s)])
              sum += (weight * scales[s]) * Pack::load(value(vertex * d + a) + first + i);
          sum.store(jet + i);
        }
      }
    if (const double* const place = own(p.own.place)) std::copy_n(place, count, x[0]);
    else
      for (int i = 0; i < count; ++i) x[0][i] = batch_.x[first + i] + p.space * batch_.cell.space_step;
    const double* const time = own(p.own.time);
    return {count, jets.data(), batch_.cell.t + p.time * batch_.cell.time_step + (time ? *time : 0), x[0]};
  }
  /// A number of each stencil, from the first on; null for −1.
  const double* own(int number) { return number < 0 ? nullptr : numbers[number]; }
  const double* value(int i) const { return batch_.y + static_cast<std::ptrdiff_t>(i) * batch_.count; }

  const int d, variables;
  const std::array<double, jet_slots> scales;
  const double area;  ///< |Δ|

 private:
  ScratchRows jets, increments, x, numbers;
  const JetFamily& family_;
  const StencilBatch& batch_;
};

JetFamily::JetFamily(StencilTable table, std::shared_ptr<const BatchDensity> density, bool values_are_sources,
                     OwnWeights own)
    : StencilFamily(table.pattern, values_at_every_vertex(table.pattern, density->components()), table.tests.empty()),
      own_(std::move(own)),
      of_{own_.stencils ? std::move(table) : with_slot_places(std::move(table), *density), density},
      d_(of_.density->components()),
      has_sources_(of_.density->nonlinearity() == Nonlinearity::values ||
                   (values_are_sources && of_.density->nonlinearity() == Nonlinearity::none)) {
  placed_ = of_.density->is_placed();
  listed_ = own_.stencils;
  const auto by_vertex = [this](const TablePoint& p) {
    std::vector<std::vector<Weight>> weights(pattern_.size());
    for (int s = 0; s < of_.density->slots(); ++s)
      for (std::size_t e = 0; e < p.slots[at(s)].size(); ++e) {
        const auto& [vertex, weight] = p.slots[at(s)][e];
        const std::vector<int>& numbers = p.own.slots[at(s)];
        weights[vertex].push_back({s, weight, numbers.empty() ? -1 : numbers[e]});
      }
    return weights;
  };
  for (std::size_t q = 0; q < of_.table.points.size(); ++q) {
    Point point{by_vertex(of_.table.points[q]), by_vertex(of_.table.test(q)), {}};
    for (int i = 0; i < size(); ++i)
      if (!point.of_vertex[i / d_].empty() || !point.of_test[i / d_].empty()) point.values.push_back(i);
    points_.push_back(std::move(point));
  }
  find_columns();
  find_sources();
  find_lanes();
}

void JetFamily::find_columns() {
  std::vector<double> places;
  const auto place = [&](int l) {
    const Site& v = pattern_.vertices[l];
    return v.space + of_.table.nodes[v.node].space;
  };
  // Tables with tests have residuals whose rows alone add up to momenta.
  const auto adds_up = [&](int l) {
    return of_.table.tests.empty() || of_.table.nodes[pattern_.vertices[l].node].time == 0;
  };
  if (std::ranges::any_of(pattern_.vertices, [&](const Site& v) { return at(v.node) >= of_.table.nodes.size(); }))
    return;
  first_.resize(pattern_.size());
  for (int l = 0; l < pattern_.size(); ++l) {
    const std::size_t column = std::ranges::find(places, place(l)) - places.begin();
    if (column == places.size()) places.push_back(place(l)), columns_.emplace_back();
    columns_[column].push_back(l);
    first_[l] = l;
  }
  const auto none_left = [](const std::vector<std::vector<Weight>>& weights, const std::vector<int>& column, int slot) {
    double sum = 0, absolute = 0;
    for (const int l : column)
      for (const Weight& w : weights[l])
        if (w.slot == slot) sum += w.weight, absolute += std::abs(w.weight);
    return std::abs(sum) <= 1e-12 * absolute;
  };
  bool has_rates = false;
  for (const Point& point : points_)
    for (const auto& column : columns_)
      for (int s = 0; s < of_.density->slots(); ++s) {
        if (!is_rate(s)) continue;
        if (!none_left(point.of_vertex, column, s)) return columns_.clear();
        for (const int l : column)
          has_rates |= std::ranges::any_of(point.of_vertex[l], [&](const Weight& w) { return w.slot == s; });
      }
  if (!has_rates) return columns_.clear();
  reads_low_ = true;
  for (const auto& column : columns_) {
    const auto is_read = [&](int l) {
      return std::ranges::any_of(points_, [&](const Point& p) {
        return std::ranges::any_of(p.of_vertex[l], [](const Weight& w) { return is_rate(w.slot); });
      });
    };
    if (const auto first = std::ranges::find_if(column, is_read); first != column.end())
      for (const int l : column) first_[l] = *first;
  }
  const auto is_tested = [&](int l) {
    return std::ranges::any_of(points_, [l](const Point& p) { return !p.of_test[l].empty(); });
  };
  for (auto& column : columns_) std::erase_if(column, [&](int l) { return !adds_up(l) || !is_tested(l); });
  for (const Point& point : points_)
    for (const auto& column : columns_)
      for (int s = 0; s < of_.density->slots(); ++s)
        if (is_rate(s) && !none_left(point.of_test, column, s)) return columns_.clear();
  for (const auto& column : columns_)
    for (int a = 0; a < d_; ++a) {
      sums_.emplace_back();
      for (const int l : column) sums_.back().push_back(l * d_ + a);
    }
  for (Point& point : points_)
    for (const auto& column : columns_) {
      std::vector<Weight> all;
      for (int s = 0; s < of_.density->slots(); ++s) {
        Weight sum{s, 0, -1};
        for (const int l : column)
          for (const Weight& w : point.of_test[l])
            if (w.slot == s && !is_rate(s)) sum.weight += w.weight, sum.own = w.own;  // the same at all times
        if (sum.weight != 0) all.push_back(sum);
      }
      point.of_test.push_back(std::move(all));
    }
}

void JetFamily::find_lanes() {
  const int Q = static_cast<int>(points_.size());
  if (placed_ || Q < 2 || listed_) return;
  for (int first = 0; first < Q; first += lanes) {
    Lanes of;
    const auto entry = [](std::vector<Lanes::Entry>& list, int slot, int vertex) -> Pack& {
      for (Lanes::Entry& e : list)
        if (e.slot == slot && e.vertex == vertex) return e.weight;
      return list.emplace_back(Lanes::Entry{slot, vertex, Pack(0.0)}).weight;
    };
    for (int lane = 0; lane < lanes; ++lane) {
      const std::size_t q = at(std::min(first + lane, Q - 1));
      for (int l = 0; l < pattern_.size(); ++l)
        for (const Weight& w : points_[q].of_vertex[l]) entry(of.jets, w.slot, l).v[lane] = w.weight;
      if (first + lane >= Q) continue;
      for (std::size_t l = 0; l < points_[q].of_test.size(); ++l)
        for (const Weight& w : points_[q].of_test[l])
          entry(of.tests, w.slot, static_cast<int>(l)).v[lane] = of_.table.points[q].weight * w.weight;
    }
    // Rounded weights of a rate leave a rest that every step would add to the momentum: the smallest one takes it.
    for (const auto& column : columns_)
      for (int s = 0; s < of_.density->slots(); ++s)
        for (int lane = 0; is_rate(s) && lane < lanes; ++lane) {
          double rest = 0, low = 0, *smallest = nullptr;
          for (Lanes::Entry& e : of.tests)
            if (double& weight = reinterpret_cast<double*>(&e.weight)[lane];
                e.slot == s && weight != 0 && std::ranges::find(column, e.vertex) != column.end()) {
              add_exactly(rest, low, weight);
              if (!smallest || std::abs(weight) < std::abs(*smallest)) smallest = &weight;
            }
          if (smallest) *smallest -= rest + low;
        }
    std::ranges::sort(of.jets, {}, [](const Lanes::Entry& e) { return std::pair(e.slot, e.vertex); });
    std::ranges::sort(of.tests, {}, [](const Lanes::Entry& e) { return std::pair(e.vertex, e.slot); });
    across_points_.push_back(std::move(of));
  }
}

bool JetFamily::lagrangian(const StencilBatch& batch, double* L) const {
  if (!is_variational()) return false;
  Jets jets(*this, batch);
  const ScratchRows l(1, Jets::most);
  fill_zero(L, batch.count);
  for (int first = 0; first < batch.count; first += Jets::most) {
    const int count = std::min(Jets::most, batch.count - first);
    jets.look_at(first, count);
    for (const TablePoint& p : of_.table.points) {
      of_.density->value(jets.at_point(p, first, count), l[0]);
      add(L + first, jets.area * p.weight, {jets.own(p.own.weight)}, l[0], count);
    }
  }
  return true;
}

void JetFamily::energy(const StencilBatch& batch, double* E) const {
  Jets jets(*this, batch);
  const ScratchRows l(1, Jets::most), g(jets.variables, Jets::most), sum(1, Jets::most);
  fill_zero(E, batch.count);
  for (int first = 0; first < batch.count; first += Jets::most) {
    const int count = std::min(Jets::most, batch.count - first);
    jets.look_at(first, count);
    for (const TablePoint& p : of_.table.points) {
      const JetBatch jet = jets.at_point(p, first, count);
      of_.density->gradient(jet, g.data(), l[0]);
      for (int s = 0; s < count; ++s) {
        sum[0][s] = -l[0][s];
        for (int a = d_; a < 2 * d_; ++a) sum[0][s] += jet.slots[a][s] * g[a][s];
      }
      add(E + first, jets.area * p.weight, {jets.own(p.own.weight)}, sum[0], count);
    }
  }
}

bool JetFamily::adds_to(const Point& point, std::span<const int> equations) const {
  return std::ranges::any_of(equations, [&](int i) { return !point.of_test[i / d_].empty(); });
}

/// r of a batch that is one stencil in all lanes: mechanics, elements of few cells. Its points stand side by side in one
/// pack, and are evaluated at once: 0.6 of a step of Gauss's method of two stages (pendulum), 0.5 of four.
bool JetFamily::residual_of_one(const StencilBatch& batch, std::span<const int> equations, double* r) const {
  if (batch.count != lanes || across_points_.empty()) return false;
  Pack differences(0.0);
  for (const double* values : {batch.y, batch.low})
    for (int i = 0; values != nullptr && i < size(); ++i)
      differences += abs(Pack::load(values + i * lanes) - values[i * lanes]);
  if (detail::any_above(differences, 0)) return false;
  const auto increment = [&](int i) {
    const int from = first_[i / d_] * d_ + i % d_;
    return (batch.y[i * lanes] - batch.y[from * lanes]) + (batch.low[i * lanes] - batch.low[from * lanes]);
  };

  const int m = of_.density->variables();
  const ScratchRows jets(m, lanes), g(m, lanes);
  const auto scales = slot_scales(batch.cell);
  const double area = of_.table.measure * batch.cell.time_step * batch.cell.space_step;
  fill_zero(r, static_cast<int>(equations.size()) * lanes);
  thread_local std::vector<int> place;  // of a value, or a sum, among the equations
  place.assign(values_.size() + sums_.size(), -1);
  for (std::size_t e = 0; e < equations.size(); ++e) place[equations[e]] = static_cast<int>(e);
  for (const Lanes& points : across_points_) {
    fill_zero(jets[0], m * lanes);
    // A sum is stored when it is complete: each store and load of it waits for the one before.
    for_each_equal(points.jets, &Lanes::Entry::slot, [&](std::span<const Lanes::Entry> entries) {
      const int slot = entries[0].slot;
      const bool by_increments = batch.low != nullptr && is_rate(slot);
      for (int a = 0; a < d_; ++a) {
        Pack sum(0.0);
        for (const auto& [_, vertex, weight] : entries) {
          const int i = vertex * d_ + a;
          sum += (scales[at(slot)] * (by_increments ? increment(i) : batch.y[i * lanes])) * weight;
        }
        sum.store(jets[slot * d_ + a]);
      }
    });
    of_.density->gradient({lanes, jets.data(), batch.cell.t, batch.x}, g.data());
    for_each_equal(points.tests, &Lanes::Entry::vertex, [&](std::span<const Lanes::Entry> entries) {
      for (int a = 0; a < d_; ++a) {
        const int e = place[entries[0].vertex * d_ + a];
        if (e < 0) continue;
        double* const to = r + static_cast<std::ptrdiff_t>(e) * lanes;
        Pack sum = Pack::load(to);
        for (const auto& [slot, _, weight] : entries)
          sum += (area * scales[at(slot)]) * (weight * Pack::load(g[slot * d_ + a]));
        sum.store(to);
      }
    });
  }
  for (std::size_t e = 0; e < equations.size(); ++e) {
    double* const to = r + static_cast<std::ptrdiff_t>(e) * lanes;
    Pack(sum(Pack::load(to))).store(to);
  }
  return true;
}

void JetFamily::residual(const StencilBatch& batch, std::span<const int> equations, double* r) const {
  if (residual_of_one(batch, equations, r)) return;
  Jets jets(*this, batch);
  const ScratchRows g(jets.variables, std::min(batch.count, Jets::most));
  fill_zero(r, static_cast<int>(equations.size()) * batch.count);
  for (int first = 0; first < batch.count; first += Jets::most) {
    const int count = std::min(Jets::most, batch.count - first);
    jets.look_at(first, count);
    for (std::size_t q = 0; q < points_.size(); ++q) {
      if (!adds_to(points_[q], equations)) continue;
      const TablePoint& p = of_.table.points[q];
      of_.density->gradient(jets.at_point(p, first, count), g.data());
      // r += |Δ| w_q M_qᵀ ∂ℓ/∂j
      for (std::size_t e = 0; e < equations.size(); ++e)
        for (const auto& [slot, weight, own] : points_[q].of_test[equations[e] / d_])
          add(r + static_cast<std::ptrdiff_t>(e) * batch.count + first,
              jets.area * p.weight * jets.scales[at(slot)] * weight, {jets.own(p.own.weight), jets.own(own)},
              g[slot * d_ + equations[e] % d_], count);
    }
  }
}

void JetFamily::jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                         double* J) const {
  Jets jets(*this, batch);
  const int m = jets.variables;
  const ScratchRows H(m * m, std::min(batch.count, Jets::most));
  const auto columns = static_cast<std::ptrdiff_t>(unknowns.size());
  fill_zero(J, static_cast<int>(equations.size() * unknowns.size()) * batch.count);
  for (int first = 0; first < batch.count; first += Jets::most) {
    const int count = std::min(Jets::most, batch.count - first);
    jets.look_at(first, count);
    for (std::size_t q = 0; q < points_.size(); ++q) {
      if (!adds_to(points_[q], equations)) continue;
      const TablePoint& p = of_.table.points[q];
      of_.density->hessian(jets.at_point(p, first, count), H.data());
      // J += |Δ| w_q M_qᵀ ∂²ℓ/∂j∂j M_q
      for (std::size_t e = 0; e < equations.size(); ++e)
        for (std::size_t u = 0; u < unknowns.size(); ++u) {
          double* const to =
              J + (static_cast<std::ptrdiff_t>(e) * columns + static_cast<std::ptrdiff_t>(u)) * batch.count + first;
          const int a = equations[e] % d_, b = unknowns[u] % d_;
          for (const Weight& left : points_[q].of_test[equations[e] / d_])
            for (const Weight& right : points_[q].of_vertex[unknowns[u] / d_]) {
              const int row = left.slot * d_ + a, column = right.slot * d_ + b;
              if (of_.density->is_zero(row, column)) continue;
              add(to,
                  jets.area * p.weight * jets.scales[at(left.slot)] * left.weight * jets.scales[at(right.slot)] *
                      right.weight,
                  {jets.own(p.own.weight), jets.own(left.own), jets.own(right.own)}, H[row * m + column], count);
            }
        }
    }
  }
}

bool JetFamily::is_constant(int i, int m) const {
  for (const Point& point : points_)
    for (const Weight& left : point.of_test[i / d_])
      for (const Weight& right : point.of_vertex[m / d_]) {
        const int row = left.slot * d_ + i % d_, column = right.slot * d_ + m % d_;
        if (has_sources_ && row < d_ && column < d_ ? !of_.density->is_zero(row, column)
                                                    : !of_.density->is_constant(row, column))
          return false;
      }
  return true;
}

/// A varying ∂ℓ/∂φ is a source term as a whole, the constant entries of its Hessian with it.
std::optional<ConstantPart> JetFamily::constant_part(const Cell& cell) const {
  const int n = size(), m = of_.density->variables();
  const auto scales = slot_scales(cell);
  const double area = of_.table.measure * cell.time_step * cell.space_step;
  ConstantPart part{std::vector<double>(n * n, 0.0), std::vector<double>(n, 0.0),
                    of_.density->nonlinearity() == Nonlinearity::none && !has_sources_};
  const auto hessian = [&](int row, int column) {
    return has_sources_ && row < d_ && column < d_ ? 0.0 : of_.density->constant_hessian()[row * m + column];
  };
  const auto own = [&](int number) { return own_number(number, cell.stencil); };
  for (std::size_t q = 0; q < points_.size(); ++q) {
    const double w = area * of_.table.points[q].weight * own(of_.table.points[q].own.weight);
    for (const int i : points_[q].values)
      for (const Weight& left : points_[q].of_test[i / d_]) {
        const double to = w * scales[at(left.slot)] * left.weight * own(left.own);
        const int row = left.slot * d_ + i % d_;
        if (!(has_sources_ && row < d_)) part.r0[i] += to * of_.density->constant_gradient()[row];
        for (const int k : points_[q].values)
          for (const Weight& right : points_[q].of_vertex[k / d_])
            part.J[i * n + k] +=
                to * scales[at(right.slot)] * right.weight * own(right.own) * hessian(row, right.slot * d_ + k % d_);
      }
  }
  for (const auto* numbers : {&part.J, &part.r0})
    if (!std::ranges::all_of(*numbers, [](double x) { return std::isfinite(x); })) return std::nullopt;
  return part;
}

/// A density that is nonlinear in φ alone is evaluated once for all points with the same φ.
void JetFamily::find_sources() {
  if (!has_sources_) return;
  sources_.outputs_per_group = d_;
  std::vector<const TablePoint*> representatives;
  for (std::size_t q = 0; q < of_.table.points.size(); ++q) {
    const TablePoint& p = of_.table.points[q];
    if (listed_ && p[JetSlot::phi].empty()) continue;
    own_values_ = own_values_ || !p.own.slots[at(static_cast<int>(JetSlot::phi))].empty();
    const auto same = [&p](const TablePoint* other) {
      return p.own.weight == other->own.weight &&
             std::ranges::equal(p[JetSlot::phi], (*other)[JetSlot::phi], [](const auto& e, const auto& f) {
               return e.vertex == f.vertex && e.weight == f.weight;
             });
    };
    const std::size_t group = std::ranges::find_if(representatives, same) - representatives.begin();
    if (group == representatives.size()) {
      representatives.push_back(&p);
      SourceTerms::Group made{.inputs = {}, .time = p.time, .space = p.space, .own = p.own.weight};
      for (int a = 0; a < d_; ++a) {
        SourceTerms::QuadratureValue value;
        for (const auto& [vertex, weight] : p[JetSlot::phi])
          value.push_back({pattern_.vertices[vertex], pattern_.vertices[vertex].node * d_ + a, weight});
        made.inputs.push_back(std::move(value));
      }
      sources_.groups.push_back(std::move(made));
      sources_.weights.resize(sources_.groups.size() * at(d_ * size()), 0.0);
    }
    for (const auto& [vertex, weight] : of_.table.test(q)[JetSlot::phi])
      for (int a = 0; a < d_; ++a)
        sources_.weights[(group * at(d_) + at(a)) * at(size()) + at(vertex * d_ + a)] +=
            of_.table.measure * p.weight * weight;
  }
}

const SourceTerms* JetFamily::sources() const {
  return of_.density->nonlinearity() == Nonlinearity::all || own_values_ ? nullptr : &sources_;
}
void JetFamily::evaluate_sources(int, const JetBatch& inputs, double* const* g) const { of_.density->slope(inputs, g); }
void JetFamily::differentiate_sources(int, const JetBatch& inputs, double* const* d) const {
  of_.density->curvature(inputs, d);
}

}  // namespace delf
