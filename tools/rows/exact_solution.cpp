// SPDX-License-Identifier: MIT
#include "tools/rows/exact_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/smooth_state.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

namespace {

struct PointOfTime {
  double t, x;
};

/// Random points of spacetime, the same ones each time.
std::vector<PointOfTime> random_points(const Scene& scene) {
  constexpr int count = 256;
  std::mt19937_64 random(1);
  const Lattice& lattice = scene.problem.lattice;
  const double length = lattice.space() == Space::point ? 0 : lattice.length(), end = scene.end();
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<PointOfTime> points;
  for (int n = 0; n < count; ++n) {
    const double t = end * part(random), x = length * part(random);
    points.push_back({t, x});
  }
  return points;
}

bool is_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

}  // namespace

void require_solved(const std::vector<TriedPoint>& points, const std::vector<std::string>& fields) {
  // Approximations whose errors are as small as tails are solutions; in tails all terms may be rounding.
  constexpr double smallest_error = 1e-6, rounding = 1e4 * std::numeric_limits<double>::epsilon();
  std::vector<double> scale;  // of each equation, where its terms are largest
  for (const TriedPoint& point : points) {
    scale.resize(point.values.size());
    for (std::size_t a = 0; a < scale.size(); ++a)
      if (std::isfinite(point.values[a].absolute)) scale[a] = std::max(scale[a], point.values[a].absolute);
  }
  double worst = 0;
  const TriedPoint* where = nullptr;
  std::size_t which = 0;
  for (const TriedPoint& point : points)
    for (std::size_t a = 0; a < scale.size(); ++a) {
      const auto& [sum, absolute] = point.values[a];
      if (!std::isfinite(absolute) || !(std::abs(sum) > smallest_error * scale[a])) continue;
      if (!(std::abs(sum) / scale[a] > worst) || !(std::abs(sum) > point.floor(rounding)[a])) continue;
      worst = std::abs(sum) / scale[a], where = &point, which = a;
    }
  if (!where) return;
  const bool of_constraint = which >= fields.size();
  const std::string& field = fields[of_constraint ? 0 : which];
  const auto& [sum, absolute] = where->values[which];
  throw BadInput(
      "exact." + field,
      fmt::format("{} at {}, where {:.3g} is left of terms of {:.3g}; correct it or the theory, or give a start "
                  "that is no solution as initial.{}",
                  of_constraint ? "breaks the constraint" : "does not solve the field equation of " + field,
                  where->place, sum, absolute, field));
}

void require_solution(const Scene& scene, const State& exact) {
  const auto* smooth = dynamic_cast<const SmoothState*>(&exact);
  const MethodEntry& method = find_method(scene.problem.method);
  // a method that declares neither an order nor an energy may have another equation: friction
  if (!smooth || (!method.order && !method.energy)) return;
  const auto theory = make_theory(find_theory(scene.problem.theory), scene.problem.parameters);
  const auto equations = FieldEquations::of(theory->density());
  if (!equations || (theory->constraint() && !theory->density().formula())) return;
  std::vector<TriedPoint> points;
  for (const auto& [t, x] : random_points(scene)) {
    const auto jet = smooth->jet(t, x, equations->order());
    if (!jet) return;
    if (!is_finite(*jet)) continue;
    points.push_back(
        {fmt::format("t = {:.6g}, x = {:.6g}", t, x), (*equations)(*jet, t, x),
         [&equations, jet = *jet, t, x](double rounding) { return equations->rounding(jet, t, x, rounding); }});
  }
  std::vector<std::string> fields;
  for (const Component& field : theory->fields()) fields.push_back(field.name);
  require_solved(points, fields);
}

std::string without_value(const Scene& scene, const State& exact) {
  std::vector<FieldPoint> values(exact.components());
  for (const PointOfTime& at : random_points(scene)) {
    exact.at(at.t, at.x, values);
    for (std::size_t a = 0; a < values.size(); ++a)
      if (!std::isfinite(values[a].phi))
        return fmt::format("{} has no value at t = {:.4g}, x = {:.4g}", scene.initial.fields[a], at.t, at.x);
  }
  return {};
}

}  // namespace delf
