// SPDX-License-Identifier: MIT
#include "jets/tables/slot_places.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "jets/one_jet.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

/// xⁿ/n!
double monomial(double x, int n) {
  double value = 1;
  for (int i = 1; i <= n; ++i) value *= x / i;
  return value;
}

/// The couplings of a density, slot by slot.
struct Coupling {
  const BatchDensity& density;

  bool between(int s, int r) const {
    const int d = density.components();
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b)
        if (!density.is_zero(s * d + a, r * d + b)) return true;
    return false;
  }
  /// ∂ℓ/∂(slot s) is not proved to be the same at all t and x, which are variables behind those of the jet.
  bool reads_place(int s) const {
    const int d = density.components(), t = density.variables(), x = t + 1;
    for (int a = 0; a < d; ++a)
      if (!density.is_zero(s * d + a, t) || !density.is_zero(s * d + a, x)) return true;
    return false;
  }
  /// Derivatives in sets: those of two sets are not coupled.
  std::vector<std::vector<int>> sets() const {
    std::vector<int> set(density.slots());
    for (int s = 1; s < density.slots(); ++s) {
      set[s] = s;
      for (int r = 1; r < s; ++r)
        if (const int joined = set[r], own = set[s]; joined != own && between(s, r))
          std::ranges::replace(set, own, joined);
    }
    std::vector<std::vector<int>> sets;
    for (int s = 1; s < density.slots(); ++s) {
      sets.emplace_back();
      for (int r = 1; r < density.slots(); ++r)
        if (set[r] == s) sets.back().push_back(r);
    }
    std::erase_if(sets, [](const auto& members) { return members.empty(); });
    return sets;
  }
};

/// The density has a value where all derivatives of a set are 0: beside a quotient by one of them it has not.
bool has_value_without(const BatchDensity& density, const std::vector<int>& set) {
  constexpr double usual = 0.7;
  std::vector<double> jet;
  for (int v = 0; v < density.variables(); ++v)
    jet.push_back(std::ranges::count(set, v / density.components()) > 0 ? 0 : usual);
  return std::ranges::all_of(gradient_at(density, jet, usual, usual), [](double g) { return std::isfinite(g); });
}

/// Σ_q w_q (p − c_s) over the points that have the slot is not zero.
bool lies_apart(const StencilTable& table, int s) {
  constexpr double round_off = 1e-9;
  double in_time = 0, in_space = 0;
  for (const TablePoint& p : table.points) {
    if (p.slots[at(s)].empty()) continue;
    const NodePosition c = place_of(table, p, static_cast<JetSlot>(s));
    in_time += p.weight * (p.time - c.time), in_space += p.weight * (p.space - c.space);
  }
  return std::abs(in_time) > round_off || std::abs(in_space) > round_off;
}

/// The mean of the vertices that some slots of a point read, by the sizes of their weights: φ where these derivatives are.
std::vector<TablePoint::Entry> mean_of_vertices(const TablePoint& point, const std::vector<int>& slots) {
  std::map<int, double> sizes;
  double total = 0;
  for (const int s : slots)
    for (const auto& [vertex, weight] : point.slots[at(s)])
      sizes[vertex] += std::abs(weight), total += std::abs(weight);
  std::vector<TablePoint::Entry> mean;
  for (const auto& [vertex, size] : sizes) mean.push_back({vertex, size / total});
  return mean;
}

}  // namespace

NodePosition place_of(const StencilTable& table, const TablePoint& point, JetSlot slot) {
  const auto [a, b] = slot_powers[at(slot)];
  NodePosition place;
  for (const auto& [vertex, weight] : point[slot]) {
    const Site& v = table.pattern.vertices[vertex];
    const NodePosition& node = table.nodes[v.node];
    const double t = v.time + node.time, x = v.space + node.space;
    place.time += weight * monomial(t, a + 1) * monomial(x, b);
    place.space += weight * monomial(t, a) * monomial(x, b + 1);
  }
  return place;
}

StencilTable with_slot_places(StencilTable table, const BatchDensity& density) {
  // Elements have all slots at their quadrature points, and at walls of wide stencils weights are those of mirror images.
  const auto [first, last] = std::ranges::minmax(table.pattern.vertices, {}, &Site::space);
  const bool mirrored = table.pattern.is_of_wall() && first.space != last.space;
  if (!density.is_placed() || !table.tests.empty() || table.nodes.size() > 1 || mirrored) return table;

  const Coupling coupling{density};
  std::vector<std::vector<int>> apart;
  for (const std::vector<int>& set : coupling.sets())
    if (std::ranges::any_of(set, [&](int s) { return coupling.reads_place(s) && lies_apart(table, s); }) &&
        has_value_without(density, set))
      apart.push_back(set);
  if (apart.empty()) return table;

  std::vector<TablePoint> points;
  for (const TablePoint& whole : table.points) {
    TablePoint rest = whole;
    std::vector<TablePoint> parts;
    for (const std::vector<int>& set : apart) {
      TablePoint part{.weight = whole.weight, .slots = {}};
      double members = 0;
      for (const int s : set) {
        if (whole.slots[at(s)].empty()) continue;
        const NodePosition c = place_of(table, whole, static_cast<JetSlot>(s));
        part.time += c.time, part.space += c.space, ++members;
        std::swap(part.slots[at(s)], rest.slots[at(s)]);
      }
      if (members == 0) continue;
      part.time /= members, part.space /= members;
      const bool with_phi = std::ranges::any_of(set, [&](int s) { return coupling.between(0, s); });
      part.slots[0] = with_phi ? mean_of_vertices(part, set) : whole.slots[0];
      TablePoint less = part;
      less.weight = -part.weight;
      for (const int s : set) less.slots[at(s)].clear();
      parts.push_back(std::move(part)), parts.push_back(std::move(less));
    }
    points.push_back(std::move(rest));
    std::ranges::move(parts, std::back_inserter(points));
  }
  table.points = std::move(points);
  return table;
}

}  // namespace delf
