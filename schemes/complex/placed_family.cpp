// SPDX-License-Identifier: MIT
#include "schemes/complex/placed_family.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
double* strip(double* rows, int i) { return rows + static_cast<std::ptrdiff_t>(i) * PlacedFamily::most; }
const double* strip(const double* rows, int i) { return rows + static_cast<std::ptrdiff_t>(i) * PlacedFamily::most; }

std::vector<TablePoint::Entry> place_of(const TablePoint& point) {
  if (!point[JetSlot::phi].empty()) return point[JetSlot::phi];
  std::set<int> vertices;
  for (const auto& slot : point.slots)
    for (const auto& [vertex, weight] : slot) vertices.insert(vertex);
  std::vector<TablePoint::Entry> mean;
  for (const int vertex : vertices) mean.push_back({vertex, 1 / static_cast<double>(vertices.size())});
  return mean;
}

}  // namespace

/// The jets of a batch at one point after the other, and what weighs them.
struct PlacedFamily::Strip {
  Strip(const PlacedFamily& family_, const PlacedBatch& batch_)
      : family(family_),
        batch(batch_),
        padded((batch.count + lanes - 1) / lanes * lanes),
        jets(family.density_->variables(), padded),
        places(family.is_placed() ? 2 : 0, padded) {}

  /// j_q = M_q y; lanes beyond the batch repeat its last stencil.
  JetBatch at_point(const Point& point) {
    for (int v = 0; v < family.density_->variables(); ++v) std::fill_n(jets[v], padded, 0.0);
    for (const Entry& e : point.entries)
      for (int a = 0; a < family.d_; ++a) {
        const double* const y = strip(batch.y, e.vertex * family.d_ + a);
        double* const jet = jets[e.slot * family.d_ + a];
        for (int s = 0; s < batch.count; ++s) jet[s] += weight(e, s) * y[s];
      }
    for (int v = 0; v < family.density_->variables(); ++v)
      std::fill(jets[v] + batch.count, jets[v] + padded, jets[v][batch.count - 1]);
    if (!family.is_placed()) return {padded, jets.data(), 0, nullptr};
    for (const int c : {0, 1}) {
      std::fill_n(places[c], padded, 0.0);
      for (const auto& [vertex, share] : point.place)
        for (int s = 0; s < batch.count; ++s) places[c][s] += share * strip(c == 0 ? batch.t : batch.x, vertex)[s];
      std::fill(places[c] + batch.count, places[c] + padded, places[c][batch.count - 1]);
    }
    return {padded, jets.data(), places[0][0], places[1]};
  }
  /// Calls evaluate(jets, out) with the jets at a point. Those of a batch have one time, and so stencils at other times are
  /// evaluated by themselves, one in all lanes. `out` has so many rows.
  template <class Evaluate>
  void evaluate(const JetBatch& batch_at, double* const* out, int rows, const Evaluate& all) {
    all(batch_at, out);
    if (!family.reads_time_ || std::all_of(places[0], places[0] + padded, [&](double t) { return t == places[0][0]; }))
      return;
    const int variables = family.density_->variables();
    const ScratchRows jet(variables + 1, lanes), one(rows, lanes);
    for (int s = 0; s < batch.count; ++s) {
      for (int v = 0; v < variables; ++v) std::fill_n(jet[v], lanes, jets[v][s]);
      std::fill_n(jet[variables], lanes, places[1][s]);
      all({lanes, jet.data(), places[0][s], jet[variables]}, one.data());
      for (int r = 0; r < rows; ++r) out[r][s] = one[r][0];
    }
  }
  double number(int n, int s) const { return family.numbers_[at(batch.tables[s]) * at(family.stride_) + at(n)]; }
  double weight(const Entry& e, int s) const {
    double w = number(e.number, s);
    for (int p = 0; p < slot_powers[at(e.slot)].time; ++p) w /= batch.time_steps[s];
    return w;
  }
  double measure(const Point& point, int s) const { return batch.measures[s] * number(point.number, s); }

  const PlacedFamily& family;
  const PlacedBatch& batch;
  const int padded;
  ScratchRows jets, places;
};

PlacedFamily::PlacedFamily(std::shared_ptr<const BatchDensity> density, int vertices, std::vector<TablePoint> form)
    : density_(std::move(density)), vertices_(vertices), d_(density_->components()) {
  coupled_.assign(at(size() * size()), 0);
  varying_ = coupled_;
  std::set<int> powers;  // of the time step
  for (const TablePoint& p : form) {
    Point point{stride_++, {}};
    for (int slot = 0; slot < density_->slots(); ++slot)
      for (const TablePoint::Entry& e : p.slots[at(slot)]) {
        point.entries.push_back({slot, e.vertex, stride_++});
        powers.insert(slot_powers[at(slot)].time);
        for (int a = 0; a < d_ && is_placed(); ++a)
          reads_time_ = reads_time_ || !density_->is_zero(slot * d_ + a, density_->variables());
      }
    if (is_placed()) point.place = place_of(p);
    for (const Entry& u : point.entries)
      for (const Entry& v : point.entries)
        for (int a = 0; a < d_; ++a)
          for (int b = 0; b < d_; ++b) {
            const int i = u.slot * d_ + a, m = v.slot * d_ + b;
            if (density_->is_zero(i, m)) continue;
            const std::size_t entry = at((u.vertex * d_ + a) * size() + v.vertex * d_ + b);
            coupled_[entry] = 1;
            if (density_->is_constant(i, m)) continue;
            varying_[entry] = 1;
            linear_ = false;
          }
    points_.push_back(std::move(point));
  }
  linear_ = linear_ && !reads_time_;
  if (!powers.empty()) time_power_ = powers.size() == 1 ? std::optional(*powers.begin()) : std::nullopt;
}

ComplexShape PlacedFamily::shape(int values_of_site) const {
  const int sites = size() / values_of_site;
  ComplexShape shape{sites, std::vector<char>(at(sites * sites), 0)};
  for (int i = 0; i < size(); ++i)
    for (int m = 0; m < size(); ++m)
      if (coupled_[at(i * size() + m)] != 0) shape.couples[at(i / values_of_site * sites + m / values_of_site)] = 1;
  return shape;
}

int PlacedFamily::add_table(std::span<const TablePoint> points) {
  bool same = points.size() == points_.size();
  for (std::size_t q = 0; same && q < points.size(); ++q) {
    numbers_.push_back(points[q].weight);
    std::size_t n = 0;
    for (int slot = 0; slot < density_->slots(); ++slot)
      for (const TablePoint::Entry& e : points[q].slots[at(slot)]) {
        same = same && n < points_[q].entries.size() && points_[q].entries[n].slot == slot &&
               points_[q].entries[n].vertex == e.vertex;
        ++n;
        numbers_.push_back(e.weight);
      }
    same = same && n == points_[q].entries.size();
  }
  if (!same)
    throw BadInput("lattice.mesh", "a table of another form than the first of its family; make it one more family");
  return static_cast<int>(numbers_.size()) / stride_ - 1;
}

void PlacedFamily::lagrangian(const PlacedBatch& batch, double* L) const {
  Strip jets(*this, batch);
  const ScratchRows l(1, most);
  std::fill_n(L, batch.count, 0.0);
  for (const Point& p : points_) {
    jets.evaluate(jets.at_point(p), l.data(), 1,
                  [&](const JetBatch& where, double* const* out) { density_->value(where, out[0]); });
    for (int s = 0; s < batch.count; ++s) L[s] += jets.measure(p, s) * l[0][s];
  }
}

void PlacedFamily::energy(const PlacedBatch& batch, double* E) const {
  Strip jets(*this, batch);
  const int variables = density_->variables();
  const ScratchRows g(variables + 1, most);
  const double* const l = g[variables];
  std::fill_n(E, batch.count, 0.0);
  for (const Point& p : points_) {
    const JetBatch at_p = jets.at_point(p);
    jets.evaluate(at_p, g.data(), variables + 1,
                  [&](const JetBatch& where, double* const* out) { density_->gradient(where, out, out[variables]); });
    for (int s = 0; s < batch.count; ++s) {
      double sum = -l[s];
      for (int a = d_; a < 2 * d_; ++a) sum += at_p.slots[a][s] * g[a][s];
      E[s] += jets.measure(p, s) * sum;
    }
  }
}

void PlacedFamily::residual(const PlacedBatch& batch, double* r) const {
  Strip jets(*this, batch);
  const ScratchRows g(density_->variables(), most);
  for (int i = 0; i < size(); ++i) std::fill_n(strip(r, i), batch.count, 0.0);
  for (const Point& p : points_) {
    jets.evaluate(jets.at_point(p), g.data(), density_->variables(),
                  [&](const JetBatch& where, double* const* out) { density_->gradient(where, out); });
    // r += |Δ| w_q M_qᵀ ∂ℓ/∂j
    for (const Entry& e : p.entries)
      for (int a = 0; a < d_; ++a) {
        double* const to = strip(r, e.vertex * d_ + a);
        const double* const slope = g[e.slot * d_ + a];
        for (int s = 0; s < batch.count; ++s) to[s] += jets.measure(p, s) * jets.weight(e, s) * slope[s];
      }
  }
}

void PlacedFamily::jacobian(const PlacedBatch& batch, double* J) const {
  Strip jets(*this, batch);
  const int variables = density_->variables();
  const ScratchRows H(variables * variables, most);
  for (int i = 0; i < size() * size(); ++i) std::fill_n(strip(J, i), batch.count, 0.0);
  for (const Point& p : points_) {
    jets.evaluate(jets.at_point(p), H.data(), variables * variables,
                  [&](const JetBatch& where, double* const* out) { density_->hessian(where, out); });
    // J += |Δ| w_q M_qᵀ ∂²ℓ/∂j∂j M_q
    for (const Entry& u : p.entries)
      for (const Entry& v : p.entries)
        for (int a = 0; a < d_; ++a)
          for (int b = 0; b < d_; ++b) {
            const int i = u.slot * d_ + a, m = v.slot * d_ + b;
            if (density_->is_zero(i, m)) continue;
            double* const to = strip(J, (u.vertex * d_ + a) * size() + v.vertex * d_ + b);
            const double* const second = H[i * variables + m];
            for (int s = 0; s < batch.count; ++s)
              to[s] += jets.measure(p, s) * jets.weight(u, s) * jets.weight(v, s) * second[s];
          }
  }
}

}  // namespace delf
