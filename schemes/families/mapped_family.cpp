// SPDX-License-Identifier: MIT
#include "schemes/families/mapped_family.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// y = Σ w x, `count` numbers; x = row(value).
template <class Row>
void sum(std::span<const MappedFamily::Entry> terms, const Row& row, int count, double* y) {
  // Some packs at once: sums do not wait for each other, and terms are looked up less often.
  const auto packs = [&]<int at_once>(int i) {
    Pack all[at_once];
    for (Pack& a : all) a = Pack(0.0);
    for (const auto& [value, weight] : terms) {
      const double* const x = row(value) + i;
      for (int p = 0; p < at_once; ++p) all[p] += weight * Pack::load(x + p * lanes);
    }
    for (int p = 0; p < at_once; ++p) all[p].store(y + i + p * lanes);
  };
  int i = 0;
  for (; i + 4 * lanes <= count; i += 4 * lanes) packs.template operator()<4>(i);
  for (; i < count; i += lanes) packs.template operator()<1>(i);
}

/// Every site that a map names, in order, and the values there.
std::pair<StencilPattern, std::vector<VertexValue>> list_values(const MappedFamily::Map& map) {
  std::vector<std::pair<Site, int>> all;  // and the component
  for (const auto* sums : {&map.reads, &map.tests})
    for (const MappedFamily::Sum& sum : *sums)
      for (const MappedFamily::Part& p : sum) all.emplace_back(p.site, p.component);
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  StencilPattern pattern;
  std::vector<VertexValue> values;
  for (const auto& [site, component] : all) {
    if (pattern.vertices.empty() || pattern.vertices.back() != site) pattern.vertices.push_back(site);
    values.push_back({pattern.size() - 1, component});
  }
  return {std::move(pattern), std::move(values)};
}

}  // namespace

MappedFamily::MappedFamily(std::shared_ptr<const StencilFamily> family, const Map& map)
    : MappedFamily(std::move(family), map, list_values(map)) {}

MappedFamily::MappedFamily(std::shared_ptr<const StencilFamily> family, const Map& map,
                           std::pair<StencilPattern, std::vector<VertexValue>> own)
    : StencilFamily(std::move(own.first), std::move(own.second), family->is_variational() && map.tests.empty()),
      family_(std::move(family)),
      reads_(values_.size()),
      tests_(values_.size()),
      mesh_(map.mesh) {
  placed_ = family_->is_placed();
  const auto fill = [&](const std::vector<Sum>& sums, std::vector<std::vector<Entry>>& entries) {
    for (std::size_t value = 0; value < sums.size(); ++value)
      for (const Part& p : sums[value])
        if (p.weight != 0) entries[number_of(p)].push_back({static_cast<int>(value), p.weight});
  };
  fill(map.reads, reads_);
  fill(map.tests.empty() ? map.reads : map.tests, tests_);
  map_.resize(family_->size());
  for (int i = 0; i < size(); ++i)
    for (const auto& [value, weight] : reads_[i]) map_[value].push_back({i, weight});
  for (const auto& entries : tests_) varied_.push_back(!entries.empty());
  find_rates();
  if (!map.cell) return;
  cell_.time = map.time;
  for (int i = 0; i < size(); ++i) {
    double weight = 0;
    for (const Entry& entry : reads_[i])
      weight += entry.value == map.cell->second ? entry.weight : entry.value == map.cell->first ? -entry.weight : 0.0;
    if (weight != 0) cell_.width.push_back({i, weight});
  }
}

/// Values that rates are differences of are those of one field at one place: what is added to all of them leaves rates as
/// they are.
void MappedFamily::find_rates() {
  constexpr double rounding = 1e-12;
  std::vector<int> column(values_.size(), -1);
  int columns = 0;
  for (const auto& row : map_) {
    double sum = 0, absolute = 0;
    for (const Entry& entry : row) sum += entry.weight, absolute += std::abs(entry.weight);
    is_rate_.push_back(row.size() > 1 && std::abs(sum) <= rounding * absolute);
    if (!is_rate_.back()) continue;
    reads_low_ = true;
    int own = columns;
    for (const Entry& entry : row)
      if (column[entry.value] >= 0) own = column[entry.value];
    for (const Entry& entry : row) column[entry.value] = own;
    columns = std::max(columns, own + 1);
  }
  for (int c = 0; c < columns; ++c) {
    std::vector<int> members;
    std::vector<double> sum(map_.size(), 0.0), absolute = sum;
    for (int i = 0; i < size(); ++i) {
      if (column[i] != c) continue;
      members.push_back(i);
      for (const Entry& entry : tests_[i])
        sum[entry.value] += entry.weight, absolute[entry.value] += std::abs(entry.weight);
    }
    sums_.push_back(std::move(members)), tests_.emplace_back();
    for (std::size_t value = 0; value < sum.size(); ++value)
      if (std::abs(sum[value]) > rounding * absolute[value])
        tests_.back().push_back({static_cast<int>(value), sum[value]});
  }
}

int MappedFamily::number_of(const Part& p) const {
  for (int i = 0; i < size(); ++i)
    if (site(i) == p.site && values_[i].component == p.component) return i;
  return -1;
}

/// The family's values of a batch, and the numbers of its values that some own ones meet.
struct MappedFamily::Mapped {
  Mapped(const MappedFamily& of, const StencilBatch& batch) : y(of.family_->size(), batch.count) {
    const auto own = [&](int i) { return batch.y + static_cast<std::ptrdiff_t>(i) * batch.count; };
    for (int b = 0; b < of.family_->size(); ++b)
      if (batch.low != nullptr && of.is_rate_[b] != 0) add_increments(of.map_[b], batch, y[b]);
      else sum(of.map_[b], own, batch.count, y[b]);
    inner = {batch.cell, batch.count, batch.x, y[0]};
  }
  /// Σ w (y − y₀), y₀ the first of them.
  static void add_increments(std::span<const Entry> terms, const StencilBatch& batch, double* to) {
    const auto load = [&](const double* from, const Entry& entry, int s) {
      return Pack::load(from + static_cast<std::ptrdiff_t>(entry.value) * batch.count + s);
    };
    for (int s = 0; s < batch.count; s += lanes) {
      Pack all(0.0);
      for (const Entry& entry : terms.subspan(1))
        all += entry.weight * ((load(batch.y, entry, s) - load(batch.y, terms[0], s)) +
                               (load(batch.low, entry, s) - load(batch.low, terms[0], s)));
      all.store(to + s);
    }
  }
  /// The numbers met, ascending; `place` is where each stands among them.
  static void meet(const std::vector<std::vector<Entry>>& entries, std::span<const int> own, std::vector<int>& numbers,
                   std::vector<int>& place, int size) {
    place.assign(size, -1);
    numbers.clear();
    for (const int i : own)
      for (const Entry& entry : entries[i]) place[entry.value] = 0;
    for (int b = 0; b < size; ++b)
      if (place[b] == 0) place[b] = static_cast<int>(numbers.size()), numbers.push_back(b);
  }

  ScratchRows y;
  StencilBatch inner{};
};

void MappedFamily::residual(const StencilBatch& batch, std::span<const int> equations, double* r) const {
  thread_local std::vector<int> rows, place;
  const Mapped mapped(*this, batch);
  Mapped::meet(tests_, equations, rows, place, family_->size());
  const ScratchRows inner(static_cast<int>(rows.size()), batch.count);
  if (!rows.empty()) family_->residual(mapped.inner, rows, inner[0]);
  for (std::size_t e = 0; e < equations.size(); ++e)
    sum(
        tests_[equations[e]], [&](int value) { return inner[place[value]]; }, batch.count, r + e * at(batch.count));
}

void MappedFamily::jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                            double* J) const {
  thread_local std::vector<int> rows, columns, row_place, column_place;
  const Mapped mapped(*this, batch);
  Mapped::meet(tests_, equations, rows, row_place, family_->size());
  Mapped::meet(reads_, unknowns, columns, column_place, family_->size());
  const int R = static_cast<int>(rows.size()), C = static_cast<int>(columns.size());
  const int U = static_cast<int>(unknowns.size());
  const ScratchRows inner(R * C, batch.count), by_own(R * U, batch.count);
  if (R > 0 && C > 0) family_->jacobian(mapped.inner, rows, columns, inner[0]);
  for (int r = 0; r < R; ++r)
    for (int u = 0; u < U; ++u)
      sum(
          reads_[unknowns[u]], [&](int value) { return inner[r * C + column_place[value]]; }, batch.count,
          by_own[r * U + u]);
  for (std::size_t e = 0; e < equations.size(); ++e)
    for (int u = 0; u < U; ++u)
      sum(
          tests_[equations[e]], [&](int value) { return by_own[row_place[value] * U + u]; }, batch.count,
          J + (e * unknowns.size() + at(u)) * at(batch.count));
}

bool MappedFamily::lagrangian(const StencilBatch& batch, double* L) const {
  if (!is_variational()) return false;
  const Mapped mapped(*this, batch);
  return family_->lagrangian(mapped.inner, L);
}

std::optional<ConstantPart> MappedFamily::constant_part(const Cell& cell) const {
  const auto inner = family_->constant_part(cell);
  if (!inner) return std::nullopt;
  const int n = size(), m = family_->size();
  ConstantPart part{std::vector<double>(n * n), std::vector<double>(n), inner->is_all};
  for (int i = 0; i < n; ++i)
    for (const auto& [row, left] : tests_[i]) {
      part.r0[i] += left * inner->r0[row];
      for (int k = 0; k < n; ++k)
        for (const auto& [column, right] : reads_[k]) part.J[i * n + k] += left * right * inner->J[row * m + column];
    }
  return part;
}

}  // namespace delf
