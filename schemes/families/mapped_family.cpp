// SPDX-License-Identifier: MIT
#include "schemes/families/mapped_family.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "jets/simd/scratch_rows.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// y += w x, `count` numbers.
void add(double* y, double w, const double* x, int count) {
  for (int i = 0; i < count; i += lanes) (Pack::load(y + i) + w * Pack::load(x + i)).store(y + i);
}

/// Every site that a map names, in order, and the values there.
std::pair<StencilPattern, std::vector<VertexValue>> list_values(const MappedFamily::Map& map) {
  std::vector<std::tuple<int, int, int>> all;  // time, space, component
  for (const auto* sums : {&map.reads, &map.tests})
    for (const MappedFamily::Sum& sum : *sums)
      for (const MappedFamily::Part& p : sum) all.emplace_back(p.site.time, p.site.space, p.component);
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  StencilPattern pattern;
  std::vector<VertexValue> values;
  for (const auto& [time, space, component] : all) {
    const Site site{time, space};
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
      tests_(values_.size()) {
  placed_ = family_->is_placed();
  const auto fill = [&](const std::vector<Sum>& sums, std::vector<std::vector<Entry>>& entries) {
    for (std::size_t value = 0; value < sums.size(); ++value)
      for (const Part& p : sums[value])
        if (p.weight != 0) entries[at(number_of(p))].push_back({static_cast<int>(value), p.weight});
  };
  fill(map.reads, reads_);
  fill(map.tests.empty() ? map.reads : map.tests, tests_);
  for (const auto& entries : tests_) varied_.push_back(!entries.empty());
  if (!map.cell) return;
  cell_time_ = map.time;
  for (int i = 0; i < size(); ++i) {
    double weight = 0;
    for (const Entry& entry : reads_[at(i)])
      weight += entry.value == map.cell->second ? entry.weight : entry.value == map.cell->first ? -entry.weight : 0.0;
    if (weight != 0) cell_.push_back({i, weight});
  }
}

int MappedFamily::number_of(const Part& p) const {
  for (int i = 0; i < size(); ++i)
    if (site(i) == p.site && values_[at(i)].component == p.component) return i;
  return -1;
}

/// The family's values of a batch, and the numbers of its values that some own ones meet.
struct MappedFamily::Mapped {
  Mapped(const MappedFamily& of, const StencilBatch& batch) : y(of.family_->size(), batch.count) {
    for (int b = 0; b < of.family_->size(); ++b) std::fill_n(y[b], batch.count, 0.0);
    for (int i = 0; i < of.size(); ++i)
      for (const auto& [value, weight] : of.reads_[at(i)])
        add(y[value], weight, batch.y + static_cast<std::ptrdiff_t>(i) * batch.count, batch.count);
    inner = {batch.cell, batch.count, batch.x, y[0]};
  }
  /// The numbers met, ascending; `place` is where each stands among them.
  static void meet(const std::vector<std::vector<Entry>>& entries, std::span<const int> own, std::vector<int>& numbers,
                   std::vector<int>& place, int size) {
    place.assign(at(size), -1);
    numbers.clear();
    for (const int i : own)
      for (const Entry& entry : entries[at(i)]) place[at(entry.value)] = 0;
    for (int b = 0; b < size; ++b)
      if (place[at(b)] == 0) place[at(b)] = static_cast<int>(numbers.size()), numbers.push_back(b);
  }

  ScratchRows y;
  StencilBatch inner{};
};

void MappedFamily::residual(const StencilBatch& batch, std::span<const int> equations, double* r) const {
  thread_local std::vector<int> rows, place;
  const Mapped mapped(*this, batch);
  Mapped::meet(tests_, equations, rows, place, family_->size());
  std::fill_n(r, equations.size() * at(batch.count), 0.0);
  if (rows.empty()) return;
  const ScratchRows inner(static_cast<int>(rows.size()), batch.count);
  family_->residual(mapped.inner, rows, inner[0]);
  for (std::size_t e = 0; e < equations.size(); ++e)
    for (const auto& [value, weight] : tests_[at(equations[e])])
      add(r + e * at(batch.count), weight, inner[place[at(value)]], batch.count);
}

void MappedFamily::jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                            double* J) const {
  thread_local std::vector<int> rows, columns, row_place, column_place;
  const Mapped mapped(*this, batch);
  Mapped::meet(tests_, equations, rows, row_place, family_->size());
  Mapped::meet(reads_, unknowns, columns, column_place, family_->size());
  std::fill_n(J, equations.size() * unknowns.size() * at(batch.count), 0.0);
  if (rows.empty() || columns.empty()) return;
  const int width = static_cast<int>(columns.size());
  const ScratchRows inner(static_cast<int>(rows.size()) * width, batch.count);
  family_->jacobian(mapped.inner, rows, columns, inner[0]);
  for (std::size_t e = 0; e < equations.size(); ++e)
    for (std::size_t u = 0; u < unknowns.size(); ++u)
      for (const auto& [row, left] : tests_[at(equations[e])])
        for (const auto& [column, right] : reads_[at(unknowns[u])])
          add(J + (e * unknowns.size() + u) * at(batch.count), left * right,
              inner[row_place[at(row)] * width + column_place[at(column)]], batch.count);
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
  ConstantPart part{std::vector<double>(at(n * n)), std::vector<double>(at(n)), inner->is_all};
  for (int i = 0; i < n; ++i)
    for (const auto& [row, left] : tests_[at(i)]) {
      part.r0[at(i)] += left * inner->r0[at(row)];
      for (int k = 0; k < n; ++k)
        for (const auto& [column, right] : reads_[at(k)])
          part.J[at(i * n + k)] += left * right * inner->J[at(row * m + column)];
    }
  return part;
}

bool MappedFamily::momentum(const Cell& cell, std::span<const double> phi, std::span<const double> phi_t,
                            std::span<double> p) const {
  return family_->momentum(cell, phi, phi_t, p);
}

}  // namespace delf
