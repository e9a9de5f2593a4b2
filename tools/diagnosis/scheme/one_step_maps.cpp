// SPDX-License-Identifier: MIT
#include "tools/diagnosis/scheme/one_step_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "jets/tables/named_splittings.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/scheme/acceleration.hpp"
#include "tools/diagnosis/scheme/runge_kutta.hpp"

namespace delf {
namespace {

using Force = std::shared_ptr<const Acceleration>;

void add(std::vector<double>& to, double factor, const std::vector<double>& what) {
  for (std::size_t n = 0; n < to.size(); ++n) to[n] += factor * what[n];
}

/// The scheme that the acceleration is taken of: pairs of sites of an order in space, or of order 2 the five-point stencil.
Problem explicit_scheme(Problem p, int space_order) {
  if (p.lattice.space() == Space::point) p.method = "multisymplectic", p.stencil = "vertex";
  else if (space_order == 2) p.method = "multisymplectic", p.stencil = "triangle-vertex";
  else {
    p.method = "composition";
    p.parameters["scheme.order"] = 2;
    p.parameters["lattice.space_order"] = space_order;
  }
  return p;
}

std::optional<Acceleration> acceleration(const Problem& p, int space_order) {
  return Acceleration::of(explicit_scheme(p, space_order));
}

// The map that does v += b h a(q) and q += a h v by turns.
std::function<bool(PhasePoint&)> kicks_and_drifts(Force a, double h, std::vector<double> kicks,
                                                  std::vector<double> drifts) {
  return [=](PhasePoint& z) {
    for (std::size_t s = 0; s < kicks.size(); ++s) {
      if (kicks[s] != 0) add(z.v, h * kicks[s], (*a)(z.q));
      if (s < drifts.size() && drifts[s] != 0) add(z.q, h * drifts[s], z.v);
    }
    return true;
  };
}

// Implicit stages by fixed points, from the stages at rest.
std::function<bool(PhasePoint&)> runge_kutta(Force a, double h, const RungeKutta& method) {
  return [=](PhasePoint& z) {
    const std::size_t S = method.b.size();
    std::vector<PhasePoint> slopes(S, {z.v, (*a)(z.q)});
    constexpr int most = 200;
    double change = 0;
    for (int n = 0; n < (method.is_explicit() ? 1 : most); ++n) {
      change = 0;
      double size = 0;
      for (std::size_t i = 0; i < S; ++i) {
        PhasePoint stage = z;
        for (std::size_t j = 0; j < S; ++j)
          if (method.a[i][j] != 0)
            add(stage.q, h * method.a[i][j], slopes[j].q), add(stage.v, h * method.a[i][j], slopes[j].v);
        std::vector<double> force = (*a)(stage.q);
        for (std::size_t m = 0; m < force.size(); ++m) {
          change = std::max(change, std::abs(force[m] - slopes[i].v[m]) + std::abs(stage.v[m] - slopes[i].q[m]));
          size = std::max(size, std::abs(force[m]) + std::abs(stage.v[m]));
        }
        slopes[i] = {std::move(stage.v), std::move(force)};
      }
      if (!(change < 1e300)) return false;
      if (change <= 2e-16 * size) break;
      if (n + 1 == most && change > 1e-13 * size) return false;
    }
    for (std::size_t i = 0; i < S; ++i) add(z.q, h * method.b[i], slopes[i].q), add(z.v, h * method.b[i], slopes[i].v);
    return true;
  };
}

std::function<bool(PhasePoint&)> repeated(std::function<bool(PhasePoint&)> step, int times) {
  return [=](PhasePoint& z) {
    for (int n = 0; n < times; ++n)
      if (!step(z)) return false;
    return true;
  };
}

std::string with_space(const std::string& name, int space_order) {
  return space_order == 2 ? name : fmt::format("{}, with D² of order {}", name, space_order);
}

void add_splittings(std::vector<OneStepMap>& maps, const Problem& p, const Force& a, int space_order) {
  const double h = p.time_step;
  const bool circle = p.lattice.is_circle();
  const auto keys = [&](const std::string& splitting) {
    return circle ? fmt::format("scheme.method = composition, scheme.splitting = {}, lattice.space_order = {}",
                                splitting, space_order)
                  : std::string();
  };
  const auto take = [&](const std::string& name, const std::string& with, std::vector<double> kicks,
                        std::vector<double> drifts) {
    maps.push_back(
        {with_space(name, space_order), with, true, kicks_and_drifts(a, h, std::move(kicks), std::move(drifts))});
  };
  const bool point = p.lattice.space() == Space::point;
  take("kick-drift-kick Störmer-Verlet (velocity Verlet)",
       point              ? "scheme.method = cgvi, scheme.tableau = stormer-verlet"
       : space_order == 2 ? "lattice.stencil = leapfrog"
                          : keys("leapfrog"),
       {0.5, 0.5}, {1});
  take("drift-kick-drift Störmer-Verlet (position Verlet)", "", {0, 1, 0}, {0.5, 0.5});
  // Frames of which others were left out, and steps in parts.
  for (const int m : {2, 3, 4, 5, 10})
    for (const bool whole : {true, false}) {
      const double step = whole ? h : h / m;
      maps.push_back(
          {with_space(fmt::format("{} steps of {:.7g} by kick-drift-kick Störmer-Verlet", m, step), space_order),
           whole ? fmt::format("lattice.time_step = {:.10g}, and record every row", h)
                 : fmt::format("lattice.time_step = {:.10g} is the step; record every row", step),
           true, repeated(kicks_and_drifts(a, step, {0.5, 0.5}, {1}), m), whole ? m : 1});
    }
  take("symplectic Euler, the kick first", "", {1, 0}, {1});
  take("symplectic Euler, the drift first", "", {0, 1}, {1});
  // H. Yoshida, Phys. Lett. A 150 (1990) 262: three steps of Störmer–Verlet
  const double outer = 1 / (2 - std::cbrt(2.0)), inner = 1 - 2 * outer;
  take("Yoshida's (Forest and Ruth's) method of order 4, kicks first", "",
       {outer / 2, (outer + inner) / 2, (outer + inner) / 2, outer / 2}, {outer, inner, outer});
  take("Yoshida's (Forest and Ruth's) method of order 4, drifts first", "", {0, outer, inner, outer, 0},
       {outer / 2, (outer + inner) / 2, (outer + inner) / 2, outer / 2});
  // M. Suzuki, Phys. Lett. A 146 (1990) 319: five of them
  const double s = 1 / (4 - std::cbrt(4.0)), t = 1 - 4 * s;
  take("Suzuki's method of order 4, kicks first", "", {s / 2, s, (s + t) / 2, (s + t) / 2, s, s / 2}, {s, s, t, s, s});
  take("Suzuki's method of order 4, drifts first", "", {0, s, s, t, s, s, 0},
       {s / 2, s, (s + t) / 2, (s + t) / 2, s, s / 2});
  for (const NamedSplitting& named : named_splittings()) {
    if (named.name == "leapfrog") continue;
    const Splitting splitting = named.make();
    take("the splitting " + named.name, keys(named.name), splitting.kicks, splitting.drifts);
    // The weights serve once more with the roles of kicks and drifts exchanged.
    std::vector<double> kicks{0};
    kicks.insert(kicks.end(), splitting.drifts.begin(), splitting.drifts.end());
    kicks.push_back(0);
    if (splitting.kicks.front() != 0)
      take("the splitting " + named.name + ", drifts and kicks exchanged", "", std::move(kicks), splitting.kicks);
  }
}

/// Started at the fields and their momenta M φ_t; one step is the row that this finds.
struct ElementStep {
  std::shared_ptr<Simulation> simulation;
  std::vector<double> masses;

  bool operator()(PhasePoint& z) const {
    const auto& components = simulation->components();
    const std::size_t C = components.size(), d = delf::at(simulation->count(Role::field));
    std::vector<double> row(z.q.size() / d * C), p(row.size());
    for (std::size_t at = 0; at < row.size(); ++at) {
      const Component& c = components[at % C];
      const std::size_t n = at / C * d + delf::at(c.field);
      if (c.role != Role::multiplier) row[at] = z.q[n];  // nodes inside start from the field of their site
      if (c.role == Role::field) p[at] = masses[n] * z.v[n];
    }
    try {
      simulation->start_momenta(row, p);
      simulation->copy_row(0, z.q);
      const std::vector<double> after = simulation->momenta();
      for (std::size_t at = 0; at < row.size(); ++at)
        if (const Component& c = components[at % C]; c.role == Role::field) {
          const std::size_t n = at / C * d + delf::at(c.field);
          z.v[n] = after[at] / masses[n];
        }
    } catch (const NumericalFailure&) {
      return false;
    }
    return true;
  }
};

std::optional<OneStepMap> element_step(const Problem& p, const std::vector<double>& masses) {
  // Only from momenta; those that start from two rows are tried on the rows.
  const auto& starts = find_method(p.method).starts;
  if (starts.size() != 1 || starts[0] != StartRule::legendre || masses.empty()) return std::nullopt;
  try {
    const auto simulation = std::make_shared<Simulation>(p);
    if (simulation->is_processed() || !is_variational(simulation->evolution().system()) ||
        simulation->count(Role::field) != simulation->theory().components())
      return std::nullopt;
    return OneStepMap{scheme_label(p), "", true, ElementStep{simulation, masses}};
  } catch (const BadInput&) {  // not for this theory or space
    return std::nullopt;
  }
}

}  // namespace

Problem explicit_scheme(const Problem& p) { return explicit_scheme(p, 2); }

std::vector<double> masses_of(const Problem& p) {
  const auto a = acceleration(p, 2);
  return a ? a->masses() : std::vector<double>{};
}

std::vector<OneStepMap> steps_by_force(const Problem& p) {
  std::vector<OneStepMap> maps;
  for (int space_order = 2; space_order <= (p.lattice.is_circle() ? 12 : 2); space_order += 2) {
    auto found = acceleration(p, space_order);
    if (!found) continue;
    const auto a = std::make_shared<const Acceleration>(std::move(*found));
    add_splittings(maps, p, a, space_order);
    for (const RungeKutta& method : runge_kutta_methods())
      maps.push_back({with_space(method.name, space_order), "", false, runge_kutta(a, p.time_step, method)});
  }
  return maps;
}

std::optional<OneStepMap> step_of(const Problem& p) { return element_step(p, masses_of(p)); }

std::vector<OneStepMap> steps_of_elements(const Problem& base) {
  std::vector<OneStepMap> maps;
  const std::vector<double> masses = masses_of(base);
  for (const NamedScheme& scheme : named_schemes(base))
    if (scheme.nodes == 1)
      if (auto map = element_step(scheme.problem, masses)) {
        map->name = scheme.name, map->keys = keys_of(scheme.problem, base);
        maps.push_back(std::move(*map));
      }
  return maps;
}

}  // namespace delf
