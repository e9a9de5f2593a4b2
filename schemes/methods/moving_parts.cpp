// SPDX-License-Identifier: MIT
#include "schemes/methods/moving_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "jets/reparametrised.hpp"
#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/space_table.hpp"
#include "jets/tables/table_product.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/mapped_family.hpp"
#include "schemes/families/mesh_constraint.hpp"
#include "schemes/families/rate_family.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

/// Piecewise linear functions of space, with Gauss's rule.
StencilTable linear_elements(int points) { return element_space(lagrange_basis({0, 1}), gauss_rule(points)); }

/// The density's parts, each with its quadrature: two points are exact for the quadratic one, on linear functions.
struct DensityPart {
  std::shared_ptr<const BatchDensity> density;
  StencilTable space;
};
std::vector<DensityPart> density_parts(const FieldTheory& theory, int points) {
  using Part = Reparametrised::Part;
  const auto of = [&](Part part) { return std::make_shared<const Reparametrised>(theory.shared_density(), part); };
  if (!Reparametrised::has_parts(theory.density())) return {{of(Part::whole), linear_elements(points)}};
  return {{of(Part::quadratic), linear_elements(2)}, {of(Part::potential), linear_elements(points)}};
}

/// One point of time on its own: node 0 is the value there, node 1 is h times the rate.
StencilTable stage_table(const TablePoint& point, const StencilTable& space) {
  StencilTable time{.pattern = {}, .points = {}, .nodes = {{}, {}}};
  time.pattern.vertices = {{.time = 0, .space = 0, .node = 0}, {.time = 0, .space = 0, .node = 1}};
  TablePoint stage{.weight = point.weight, .time = point.time, .slots = {}};
  stage.set(JetSlot::phi, {1.0, 0.0}), stage.set(JetSlot::phi_t, {0.0, 1.0});
  time.points.push_back(std::move(stage));
  return product(time, space);
}

/// Where the values of a scheme stand among its components, and the maps from them to the points of time.
class Layout {
 public:
  Layout(const FieldTheory& theory, const MovingScheme& scheme)
      : d_(theory.components()), time_(scheme.time), by_element_(scheme.varied || scheme.rows_alone) {
    components = theory.fields();
    components.push_back({"X", scheme.varied ? Role::field : Role::slaved, {}, true, d_});
    first_node_ = d_ + 1;
    width_ = scheme.varied ? d_ + 1 : d_;
    for (std::size_t node = 1; node < time_.nodes.size(); ++node)
      for (int a = 0; a < width_; ++a) {
        const Component& field = components[a];
        components.push_back({fmt::format("{} at {:.4g}", field.name, time_.nodes[node].time), Role::inner,
                              time_.nodes[node], false, a});
      }
    for (std::size_t i = 0; i < time_.points.size(); ++i) {
      if (by_element_) continue;
      const NodePosition here{time_.points[i].time, 0};
      Stage stage{-1, -1};
      if (!is_row(here.time))
        stage.position = add(fmt::format("X beside its chord at {:.4g}", here.time), Role::slaved, here);
      stage.rate = add(fmt::format("h X_t at {:.4g}", here.time), Role::slaved, here);
      stages_.push_back(stage);
    }
  }

  int add(std::string name, Role role, NodePosition where) {
    components.push_back({std::move(name), role, where});
    return static_cast<int>(components.size()) - 1;
  }
  static bool is_row(double time) { return time == 0 || time == 1; }
  bool by_element() const { return by_element_; }
  int position(int point) const { return stages_[point].position; }
  int rate(int point) const { return stages_[point].rate; }

  /// Field c, or X for c = d, at a point of time and an offset in space: the value, or h times the rate.
  MappedFamily::Sum value(int point, int c, int space, bool rate) const {
    if (c == d_ && !by_element_) return slaved(point, space, rate);
    return by_table(time_.points[point], c, space, rate);
  }
  /// What residuals of that value are tested by.
  MappedFamily::Sum test(int point, int c, int space, bool rate) const {
    if (c == d_) return {};
    return by_table(time_.test(at(point)), c, space, rate);
  }

  std::vector<Component> components;

 private:
  struct Stage {
    int position, rate;  ///< −1: X of a row
  };
  MappedFamily::Sum by_table(const TablePoint& point, int c, int space, bool rate) const {
    MappedFamily::Sum sum;
    for (const auto& [vertex, weight] : point[rate ? JetSlot::phi_t : JetSlot::phi]) {
      const Site& v = time_.pattern.vertices[vertex];
      sum.push_back({{v.time, space}, v.node == 0 ? c : first_node_ + (v.node - 1) * width_ + c, weight});
    }
    return sum;
  }
  MappedFamily::Sum slaved(int point, int space, bool rate) const {
    if (rate) return {{{0, space}, stages_[point].rate, 1}};
    // Between rows X is its chord and what lies beside that: so the plan has X of the new row in the same slab.
    const double c = time_.points[point].time;
    if (const int beside = stages_[point].position; beside >= 0)
      return {{{0, space}, d_, 1 - c}, {{1, space}, d_, c}, {{0, space}, beside, 1}};
    return {{{static_cast<int>(time_.points[point].time), space}, d_, 1}};
  }

  int d_;
  const StencilTable& time_;
  bool by_element_;
  int first_node_ = 0, width_ = 0;
  std::vector<Stage> stages_;
};

/// A family on the fields and X as they are; where X is slaved it is read, and not varied.
std::shared_ptr<const StencilFamily> read_as_it_is(std::shared_ptr<const StencilFamily> family, int d, bool varied) {
  if (varied) return family;
  MappedFamily::Map map;
  for (int i = 0; i < family->size(); ++i) {
    const int c = family->values()[i].component;
    map.reads.push_back({{family->site(i), c, 1}});
    map.tests.push_back(c == d ? MappedFamily::Sum{} : map.reads.back());
  }
  return std::make_shared<const MappedFamily>(std::move(family), map);
}

/// Σ over the points of time of the density there.
void add_action(SchemeParts& parts, const FieldTheory& theory, const MovingScheme& scheme, const Layout& layout) {
  const int d = theory.components(), D = d + 1;
  if (scheme.action) {
    parts.families.push_back(read_as_it_is(scheme.action, d, scheme.varied));
    return;
  }
  const bool variational = scheme.varied && scheme.time.tests.empty();
  std::vector<DensityPart> density(1);
  if (!scheme.stage) density = density_parts(theory, scheme.points);
  for (const DensityPart& part : density)
    for (std::size_t i = 0; i < scheme.time.points.size(); ++i) {
      const int point = static_cast<int>(i);
      MappedFamily::Map map;
      for (const bool rate : {false, true})
        for (int space = 0; space < 2; ++space)
          for (int c = 0; c < D; ++c) {
            map.reads.push_back(layout.value(point, c, space, rate));
            if (!variational) map.tests.push_back(layout.test(point, c, space, rate));
          }
      map.cell = {d, D + d}, map.time = scheme.time.points[i].time;
      std::shared_ptr<const StencilFamily> stage;
      if (scheme.stage) stage = scheme.stage(scheme.time.points[i].weight);
      else stage = std::make_shared<const JetFamily>(stage_table(scheme.time.points[i], part.space), part.density);
      parts.families.push_back(std::make_shared<const MappedFamily>(std::move(stage), map));
    }
}

/// G of the three sites around each: of rows for point = −1, or else at a point of time. Its multiplier is `multiplier`; or
/// it determines the component `slaved`, one of the two.
void add_constraint(SchemeParts& parts, const std::shared_ptr<const MeshConstraint>& mesh, const Layout& layout,
                    int point, std::optional<int> multiplier, std::optional<int> slaved) {
  const int d = mesh->d;
  MappedFamily::Map map;
  if (point < 0) map.mesh = mesh;
  for (int space = -1; space <= 1; ++space) {
    for (int c = 0; c <= d; ++c)
      map.reads.push_back(point < 0 ? MappedFamily::Sum{{{0, space}, c, 1}} : layout.value(point, c, space, false));
    if (space != 0) continue;
    map.reads.emplace_back();
    if (multiplier) map.reads.back() = {{{0, 0}, *multiplier, 1}};
  }
  if (slaved) {
    map.tests.resize(map.reads.size());
    map.tests[2 * (d + 1)] = {{{0, 0}, *slaved, 1}};
  }
  parts.families.push_back(std::make_shared<const MappedFamily>(
      std::make_shared<const LagrangianFamily<Equidistribution>>(Equidistribution{d, mesh->monitor}), map));
}

/// τ X_t = G of a step, which determines X of its upper row.
void add_delayed(SchemeParts& parts, const std::shared_ptr<const MeshConstraint>& mesh, const MovingScheme& scheme) {
  const int d = mesh->d;
  MappedFamily::Map map;
  map.mesh = mesh;
  for (int row = 0; row < 2; ++row)
    for (int space = -1; space <= 1; ++space)
      for (int c = 0; c <= d; ++c) map.reads.push_back({{{row, space}, c, 1}});
  map.reads.emplace_back();
  map.tests.resize(map.reads.size());
  map.tests.back() = {{{1, 0}, d, 1}};
  parts.families.push_back(std::make_shared<const MappedFamily>(
      std::make_shared<const LagrangianFamily<DelayedEquidistribution>>(
          DelayedEquidistribution{d, mesh->monitor, mesh->delay, scheme.time.points.size() == 1}),
      map));
}

/// c of the waves φ_tt = c² φ_xx that a density has where it is quadratic in its derivatives: the fastest of its fields.
double wave_speed(const BatchDensity& density) {
  const auto H = density.constant_hessian();
  const int d = density.components(), m = density.variables();
  double fastest = 0;
  for (int a = 0; a < d; ++a) {
    const double inertia = H[(d + a) * m + d + a], stiffness = -H[(2 * d + a) * m + 2 * d + a];
    if (inertia > 0 && stiffness > 0) fastest = std::max(fastest, std::sqrt(stiffness / inertia));
  }
  return fastest;
}

/// Linear elements of width δ have waves up to ω = c√12/δ: h/δ where an element of time that is stable up to ωh meets them.
double stable_step(const FieldTheory& theory, const MovingScheme& scheme) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  if (scheme.most_phase == 0 || !Reparametrised::has_parts(theory.density())) return unlimited;
  const double speed = wave_speed(theory.density());
  return speed > 0 ? scheme.most_phase / (std::sqrt(12.) * speed) : unlimited;
}

/// Dg(q)·h q̇ at a point of time, with a component and its weight: its multiplier; or, if it is slaved, what Dg(q)·h q̇ = 0
/// determines.
void add_rate(SchemeParts& parts, int d, const MeshMonitor& monitor, const Layout& layout, int point,
              std::pair<int, double> component, bool slaved) {
  const MappedFamily::Sum own{{{0, 0}, component.first, component.second}};
  MappedFamily::Map map;
  for (const bool rate : {false, true})
    for (int space = -1; space <= 1; ++space) {
      for (int c = 0; c <= d; ++c) map.reads.push_back(layout.value(point, c, space, rate));
      if (space == 0) map.reads.push_back(slaved || rate ? MappedFamily::Sum{} : own);
    }
  if (slaved) map.tests.resize(map.reads.size()), map.tests[2 * (d + 1)] = own;
  parts.families.push_back(std::make_shared<const MappedFamily>(
      std::make_shared<const RateFamily<Equidistribution>>(Equidistribution{d, monitor}), map));
}

/// The node whose function is zero at every point of time, so that its slopes alone are felt: a bubble.
std::optional<int> bubble_of(const StencilTable& time) {
  for (int v = 0; v < time.pattern.size(); ++v)
    if (std::ranges::none_of(time.points, [&](const TablePoint& point) {
          return std::ranges::any_of(point[JetSlot::phi], [&](const auto& entry) { return entry.vertex == v; });
        }))
      return v;
  return std::nullopt;
}

/// Tyranowski–Desbrun (96): ṙᵀ Dg(q) q̇ beside the action, for a slack field r that is zero at the points of time. What it
/// is free to do is a bubble w, ṙ = ν_i w/h at point i with ν the bubble's slopes: Σ b_i ν_i Dg(Q_i)·Q̇_i = 0 determines
/// the bubble of X, which the kinetic term hardly feels where slopes of neighbouring cells are alike.
void add_slack(SchemeParts& parts, int d, const MovingScheme& scheme, Layout& layout) {
  const auto bubble = bubble_of(scheme.time);
  if (!bubble) return;
  const StencilTable& time = scheme.time;
  const int slack = layout.add("slack", Role::multiplier, time.nodes[time.pattern.vertices[*bubble].node]);
  for (std::size_t i = 0; i < time.points.size(); ++i) {
    double slope = 0;
    for (const auto& [vertex, weight] : time.points[i][JetSlot::phi_t])
      if (vertex == *bubble) slope = weight;
    add_rate(parts, d, scheme.monitor, layout, static_cast<int>(i), {slack, time.points[i].weight * slope}, false);
  }
}

/// The density on a row of the moving cells.
std::shared_ptr<const StencilFamily> family_of_row(const FieldTheory& theory) {
  StencilTable table = linear_elements(10);
  table.lower_side = table.points;
  return std::make_shared<const JetFamily>(
      table, std::make_shared<const Reparametrised>(theory.shared_density(), Reparametrised::Part::whole));
}

}  // namespace

SchemeParts moving_parts(const FieldTheory& theory, const MovingScheme& scheme) {
  const int d = theory.components(), points = static_cast<int>(scheme.time.points.size());
  Layout layout(theory, scheme);
  SchemeParts parts;
  const auto mesh = std::make_shared<const MeshConstraint>(
      MeshConstraint{d, scheme.monitor, stable_step(theory, scheme), scheme.delay, family_of_row(theory)});
  if (scheme.varied) {
    const int lambda = layout.add("lambda", Role::multiplier, {});
    add_constraint(parts, mesh, layout, -1, lambda, {});
  } else if (scheme.delay > 0) {
    add_delayed(parts, mesh, scheme);
  } else {
    add_constraint(parts, mesh, layout, -1, {}, d);
  }
  add_action(parts, theory, scheme, layout);
  for (int i = 0; i < points; ++i) {
    const NodePosition here{scheme.time.points[i].time, 0};
    if (scheme.varied) {
      if (Layout::is_row(here.time) || points == 1) continue;
      const int lambda = layout.add(fmt::format("lambda at {:.4g}", here.time), Role::multiplier, here);
      add_constraint(parts, mesh, layout, i, lambda, {});
    } else if (!layout.by_element()) {
      if (layout.position(i) >= 0) add_constraint(parts, mesh, layout, i, {}, layout.position(i));
      add_rate(parts, d, scheme.monitor, layout, i, {layout.rate(i), 1}, true);
    }
  }
  if (scheme.varied) add_slack(parts, d, scheme, layout);
  parts.components = layout.components;
  parts.remarks.push_back(
      scheme.action || scheme.stage
          ? "space: linear functions of the moving cells; the action is their exact integral, in closed form"
      : Reparametrised::has_parts(theory.density())
          ? fmt::format("space: linear functions of the moving cells; the quadratic part of the density is integrated "
                        "exactly, its potential by Gauss's rule of {} points{}",
                        scheme.points, scheme.points >= 10 ? ": exact to rounding for a sine over a cell" : "")
          : fmt::format("space: linear functions of the moving cells; the density is integrated by Gauss's rule of {} "
                        "points",
                        scheme.points));
  if (std::isfinite(mesh->stable_step))
    parts.remarks.push_back(
        fmt::format("limit: by linear theory h must stay below {:.3g} of the narrowest cell", mesh->stable_step));
  return parts;
}

}  // namespace delf
