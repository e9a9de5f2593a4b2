// SPDX-License-Identifier: MIT
#include "schemes/complex/stencil_list.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/container_hash/hash.hpp>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "jets/tables/named_tables.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/space_tables.hpp"
#include "schemes/verify/check.hpp"

namespace delf {
namespace {

constexpr double rounding = 1e-12;

/// The parts of T + V, whose share must be given.
struct Part {
  const char* name;
  int least, most;
};
constexpr std::array<Part, 3> parts{{{"motion", 2, 2}, {"site", 1, 1}, {"gradient", 2, 4}}};

/// The sum of some terms, or 0 if that is what rounding has left of them.
double value_of(const Balance& terms) { return terms.relative() <= rounding ? 0 : terms.sum; }
double sum_of(double a, double b) {
  Balance terms;
  terms.add(a), terms.add(b);
  return value_of(terms);
}

/// A jet slot of a coordinate, its weights applied to the coordinates of the sites.
double applied(const std::vector<TablePoint::Entry>& weights, std::span<const Complex::Position> sites, std::size_t c) {
  Balance terms;
  for (const auto& e : weights) terms.add(e.weight * sites[e.vertex][c]);
  return value_of(terms);
}

std::vector<double> dense(const std::vector<TablePoint::Entry>& entries, std::size_t sites) {
  std::vector<double> weights(sites, 0.0);
  for (const auto& e : entries) weights[e.vertex] = e.weight;
  return weights;
}

constexpr std::array<JetSlot, 3> second_order{JetSlot::phi_tt, JetSlot::phi_tx, JetSlot::phi_xx};

/// The second derivatives of a point whose first ones are by_t and by_x: see placed_points().
void set_second_derivatives(TablePoint& point, const TablePoint& q, std::span<const Complex::Position> sites,
                            const std::vector<double>& by_t, const std::vector<double>& by_x) {
  constexpr double determined = 1e-9;
  const std::size_t n = sites.size();
  std::vector<JetSlot> there;
  std::vector<std::vector<double>> rests;  // q_r
  for (const JetSlot r : second_order) {
    if (q[r].empty()) continue;
    const double t_r = applied(q[r], sites, 0), x_r = applied(q[r], sites, 1);
    std::vector<double> rest = dense(q[r], n);
    for (std::size_t l = 0; l < n; ++l) {
      Balance terms;
      terms.add(rest[l]), terms.add(-t_r * by_t[l]), terms.add(-x_r * by_x[l]);
      rest[l] = value_of(terms);
    }
    there.push_back(r), rests.push_back(std::move(rest));
  }
  if (there.empty()) return;
  const auto count = static_cast<Eigen::Index>(there.size());
  Eigen::MatrixXd B(count, count);
  for (Eigen::Index r = 0; r < count; ++r) {
    Eigen::Index column = 0;
    for (const JetSlot s : second_order) {
      Balance terms;
      for (std::size_t l = 0; l < n; ++l) {
        const double t = sites[l][0] - sites[0][0], x = sites[l][1] - sites[0][1];
        const double monomial = s == JetSlot::phi_tt ? 0.5 * t * t : s == JetSlot::phi_tx ? t * x : 0.5 * x * x;
        terms.add(rests[static_cast<int>(r)][l] * monomial);
      }
      if (std::ranges::find(there, s) != there.end()) B(r, column++) = value_of(terms);
      else if (terms.relative() > determined) return;
    }
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(B);
  if (!lu.isInvertible()) return;
  const Eigen::MatrixXd inverse = lu.inverse();
  for (Eigen::Index s = 0; s < count; ++s) {
    std::vector<double> weights(n);
    for (std::size_t l = 0; l < n; ++l) {
      Balance terms;
      for (Eigen::Index r = 0; r < count; ++r) terms.add(inverse(s, r) * rests[static_cast<int>(r)][l]);
      weights[l] = value_of(terms);
    }
    point.set(there[static_cast<int>(s)], weights);
  }
}

/// A number that stencils of one shape and one set of sites share if they are the same function of the values there.
double fingerprint(const std::vector<TablePoint>& points, const std::vector<int>& sites) {
  double sum = 0;
  for (const TablePoint& p : points) {
    const auto slot = [&](JetSlot s) {
      double value = 0;
      for (const auto& e : p[s]) value += e.weight * std::sin(1.0 + 0.7 * sites[e.vertex]);
      return value;
    };
    sum += p.weight * std::sin(0.3 + slot(JetSlot::phi) + 1.1 * slot(JetSlot::phi_t) + 1.3 * slot(JetSlot::phi_x));
  }
  return sum;
}

class Faults {
 public:
  explicit Faults(const StencilList& list) : list_(list) {}

  std::optional<MeshFault> find() {
    if (list_.stencils.empty()) return MeshFault{0, "there is no stencil; write lines like stencil triangle 0 1 2"};
    std::vector<std::size_t> order(list_.sites.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const double L = list_.circumference;
    const auto place = [&](std::size_t s) {  // x from −½L to ½L, which are one place of a circle
      Complex::Position p = list_.sites[s].position;
      if (L > 0) p[1] = std::remainder(p[1], L);
      if (L > 0 && std::abs(std::abs(p[1]) - L / 2) <= rounding * L) p[1] = L / 2;
      if (L > 0 && std::abs(p[1]) <= rounding * L) p[1] = 0;
      return p;
    };
    std::ranges::stable_sort(order, {}, place);
    for (std::size_t n = 1; n < order.size(); ++n)
      if (const std::size_t s = order[n], first = order[n - 1]; place(s) == place(first))
        return MeshFault{list_.sites[s].line, "site " + std::to_string(s) + " lies where site " +
                                                  std::to_string(first) + " does" + (L > 0 ? " on the circle" : "") +
                                                  "; remove one"};
    std::vector<char> used(list_.sites.size(), 0);
    for (std::size_t n = 0; n < list_.stencils.size(); ++n) {
      if (auto fault = of_stencil(n)) return fault;
      for (const int s : list_.stencils[n].sites) used[s] = 1;
    }
    const auto unused = std::ranges::find(used, 0);
    if (unused == used.end()) return std::nullopt;
    const std::size_t s = unused - used.begin();
    return MeshFault{list_.sites[s].line, "site " + std::to_string(s) + " is in no stencil; remove it"};
  }

 private:
  std::optional<MeshFault> of_stencil(std::size_t n) {
    const StencilList::Entry& e = list_.stencils[n];
    const auto fault = [&](const std::string& what) {
      return MeshFault{e.line, "stencil " + std::to_string(n) + " (" + e.shape + ") " + what};
    };
    const auto kind = stencil_shape(e.shape);
    if (!kind) return fault("has an unknown shape");
    const auto size = static_cast<int>(e.sites.size());
    if (size < kind->least || size > kind->most)
      return fault("has " + std::to_string(size) + " sites and needs " + std::to_string(kind->least) +
                   (kind->most > kind->least ? " to " + std::to_string(kind->most) : "") + "; correct the list");
    std::vector<int> sorted = e.sites;
    std::ranges::sort(sorted);
    if (sorted.front() < 0 || sorted.back() >= static_cast<int>(list_.sites.size()))
      return fault("names site " + std::to_string(sorted.front() < 0 ? sorted.front() : sorted.back()) +
                   ", and there are sites 0 to " + std::to_string(list_.sites.size() - 1) + "; correct it");
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end())
      return fault("names site " + std::to_string(*twice) + " twice; name it once");
    if (!kind->table && !e.share) return fault("needs its share; end the line with share NUMBER");
    if (e.share && !(*e.share > 0 && std::isfinite(*e.share)))
      return fault("has a share that is not above 0; correct it");

    const std::vector<Complex::Position> positions = list_.positions(e);
    double mark = 0;
    if (kind->table) {
      for (const auto& p : positions)
        if (p[2] != 0 || p[3] != 0)
          return fault("is of t and x alone; where there are y and z use motion, site and gradient");
      const std::vector<TablePoint> points = placed_points(*kind->table, positions);
      for (const TablePoint& p : points) {
        if (!std::isfinite(p.weight) || p.weight == 0) return fault("spans no area of t and x; move its sites");
        if (p.weight < 0)
          return fault(
              "is listed the wrong way round, or folds over itself; list its sites as the lattice's shape does");
      }
      mark = fingerprint(points, e.sites);
    } else if (e.shape == parts[0].name && !(positions[0][0] < positions[1][0])) {
      return fault("goes back in time; list the earlier site first");
    } else if (e.shape == parts[2].name) {
      for (const auto& p : positions)
        if (p[0] != positions[0][0]) return fault("has sites at several times, and is of space; correct it");
      Mesh cell{.points = {}, .vertices = {}};
      std::vector<std::int32_t> corners;
      for (const auto& p : positions) {
        corners.push_back(static_cast<std::int32_t>(cell.points.size()));
        cell.points.push_back({p[1], p[2], p[3]});
      }
      cell.add_cell(corners);
      for (const double share : corner_shares(cell, 0))
        if (!(share > 0)) return fault("spans no length or area of space; move its sites");
    }
    std::size_t hash = std::hash<std::string>()(e.shape);
    for (const int site : sorted) boost::hash_combine(hash, site);
    const auto [begin, end] = seen_.equal_range(hash);
    for (auto other = begin; other != end; ++other) {
      const auto& [first, its_mark] = other->second;
      const StencilList::Entry& known = list_.stencils[first];
      if (known.shape == e.shape && std::ranges::is_permutation(known.sites, e.sites) &&
          std::abs(its_mark - mark) <= 1e-9 * std::abs(mark))
        return fault("is stencil " + std::to_string(first) + " again" +
                     (known.line > 0 ? " (line " + std::to_string(known.line) + ")" : "") + "; remove one");
    }
    seen_.emplace(hash, std::pair(n, mark));
    return std::nullopt;
  }

  const StencilList& list_;
  /// By shape and set of sites: the stencil, and what tells its function.
  std::unordered_multimap<std::size_t, std::pair<std::size_t, double>> seen_;
};

}  // namespace

int StencilList::coordinates() const {
  int most = 2;
  for (const Site& s : sites)
    for (int c = most; c < 4; ++c)
      if (s.position[c] != 0) most = c + 1;
  return most;
}

std::vector<Complex::Position> StencilList::positions(const Entry& e) const {
  std::vector<Complex::Position> all;
  for (const int s : e.sites) {
    all.push_back(sites[s].position);
    if (circumference > 0) {
      const double apart = all.back()[1] - all.front()[1];
      if (std::abs(apart) > circumference / 2) all.back()[1] = all.front()[1] + std::remainder(apart, circumference);
    }
  }
  return all;
}

std::vector<int> StencilList::outline(const Entry& e) const {
  const auto x_of = [&](int s) { return sites[s].position[1]; };
  const auto [least, most] = std::ranges::minmax(e.sites, {}, x_of);
  if (circumference > 0 && x_of(most) - x_of(least) > circumference / 2) return {};
  const StencilTable* const table = stencil_shape(e.shape)->table;
  if (!table) return e.sites;
  const std::vector<delf::Site>& shape = table->pattern.vertices;
  double t = 0, x = 0;
  for (const delf::Site& v : shape)
    t += v.time / static_cast<double>(shape.size()), x += v.space / static_cast<double>(shape.size());
  std::vector<std::pair<double, int>> around;  // by angle
  for (std::size_t l = 0; l < shape.size(); ++l)
    if (const double up = shape[l].time - t, along = shape[l].space - x; std::hypot(up, along) > rounding)
      around.emplace_back(std::atan2(up, along), e.sites[l]);
  std::ranges::sort(around);
  std::vector<int> outline;
  for (const auto& [angle, site] : around) outline.push_back(site);
  return outline;
}

std::optional<StencilShapeKind> stencil_shape(std::string_view name) {
  for (const Part& part : parts)
    if (name == part.name) return StencilShapeKind{nullptr, part.least, part.most};
  for (const NamedTable& named : named_tables())
    if (named.name == name && !named.is_for_point())
      return StencilShapeKind{&named.table, named.table.pattern.size(), named.table.pattern.size()};
  return std::nullopt;
}

std::vector<std::string> stencil_shape_names() {
  std::vector<std::string> names;
  for (const NamedTable& named : named_tables())
    if (!named.is_for_point()) names.push_back(named.name);
  for (const Part& part : parts) names.emplace_back(part.name);
  return names;
}

std::vector<TablePoint> placed_points(const StencilTable& table, std::span<const Complex::Position> sites) {
  std::vector<TablePoint> points;
  for (const TablePoint& q : table.points) {
    const double t_tau = applied(q[JetSlot::phi_t], sites, 0), x_tau = applied(q[JetSlot::phi_t], sites, 1);
    const double t_xi = applied(q[JetSlot::phi_x], sites, 0), x_xi = applied(q[JetSlot::phi_x], sites, 1);
    const double D = sum_of(t_tau * x_xi, -x_tau * t_xi);
    TablePoint point{.weight = q.weight * D, .slots = {}};
    point.slots[at(static_cast<int>(JetSlot::phi))] = q[JetSlot::phi];
    // φ_t = (x_ξ φ_τ − x_τ φ_ξ)/D,    φ_x = (t_τ φ_ξ − t_ξ φ_τ)/D
    const std::vector<double> tau = dense(q[JetSlot::phi_t], sites.size()), xi = dense(q[JetSlot::phi_x], sites.size());
    std::vector<double> by_t(sites.size()), by_x(sites.size());
    for (std::size_t l = 0; l < sites.size(); ++l) {
      by_t[l] = sum_of(x_xi * tau[l], -x_tau * xi[l]) / D;
      by_x[l] = sum_of(t_tau * xi[l], -t_xi * tau[l]) / D;
    }
    point.set(JetSlot::phi_t, by_t);
    point.set(JetSlot::phi_x, by_x);
    set_second_derivatives(point, q, sites, by_t, by_x);
    points.push_back(std::move(point));
  }
  return points;
}

std::optional<MeshFault> find_fault(const StencilList& list) { return Faults(list).find(); }

std::optional<MeshFault> find_fault(const StencilList& list, const BatchDensity& density) {
  std::vector<JetSlot> read;
  for (const JetSlot slot : second_order)
    for (int a = 0; a < density.components() && density.slots() > 3; ++a)
      if (density.depends_on(static_cast<int>(slot) * density.components() + a)) {
        read.push_back(slot);
        break;
      }
  if (read.empty()) return std::nullopt;
  for (std::size_t n = 0; n < list.stencils.size(); ++n) {
    const StencilList::Entry& e = list.stencils[n];
    const StencilTable* const table = stencil_shape(e.shape)->table;
    if (!table) continue;  // SpaceTables refuse the density
    const std::vector<TablePoint> points = placed_points(*table, list.positions(e));
    for (const JetSlot slot : read) {
      const auto lacks = [&](const TablePoint& p) { return p[slot].empty(); };
      if (std::ranges::none_of(points, lacks)) continue;
      const std::string what = "stencil " + std::to_string(n) + " (" + e.shape + ") ",
                        name = slot_names[static_cast<int>(slot)];
      if (std::ranges::any_of(table->points, lacks))
        return MeshFault{e.line, what + "has no " + name + ", which the density reads; use a " +
                                     (slot == JetSlot::phi_tt ? "" : "six-tuple or a ") + "nine-tuple"};
      return MeshFault{e.line, what + "does not determine " + name +
                                   (e.shape == "six-tuple" ? ": each of its rows must lie at one time; move its sites, "
                                                             "or use a nine-tuple"
                                                           : " from where its sites lie; move them")};
    }
  }
  return std::nullopt;
}

}  // namespace delf
