// SPDX-License-Identifier: MIT
#include "tools/warnings/normal_part.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/system/constraint_slopes.hpp"
#include "schemes/system/legendre.hpp"

namespace delf {
namespace {

using Numbers = std::vector<double>;

double product_of(const Numbers& a, const Numbers& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }
void add_times(double factor, const Numbers& more, Numbers& to) {
  for (std::size_t a = 0; a < to.size(); ++a) to[a] += factor * more[a];
}
/// Rounding of what is no part of the numbers that are given.
Numbers rounded(Numbers numbers) {
  double largest = 0;
  for (const double x : numbers) largest = std::max(largest, std::abs(x));
  for (double& x : numbers)
    if (std::abs(x) < 1e-12 * largest) x = 0;
  return numbers;
}

}  // namespace

std::string normal_part(const Scene& scene, const InitialRows& initial, const FieldTheory& theory) {
  const auto constraint = theory.constraint();
  if (!constraint || !initial.state() || scene.problem.lattice.space() != Space::point) return {};
  const std::size_t d = at(theory.components());
  ConstraintSlopes G(*constraint, d);
  std::vector<FieldPoint> start(d);
  initial.state()->at(0, 0, start);
  Numbers q, v;
  for (const FieldPoint& field : start) q.push_back(field.phi), v.push_back(field.phi_t);
  const auto at_rest = velocity_of(theory.density(), q, Numbers(d, 0.0));
  if (!at_rest) return {};
  std::vector<Numbers> units, velocities;
  Numbers lost_p(d, 0.0), lost_v(d, 0.0);
  for (std::size_t m = 0; m < G.constraints(); ++m) {
    G.at(m, q);
    Numbers unit(G.slopes().begin(), G.slopes().end());
    for (std::size_t e = 0; e < units.size(); ++e) add_times(-product_of(unit, velocities[e]), units[e], unit);
    auto velocity = velocity_of(theory.density(), q, unit);
    if (!velocity) return {};
    add_times(-1, *at_rest, *velocity);
    const double square = product_of(unit, *velocity);
    if (!(square > 0)) return {};
    for (double& x : unit) x /= std::sqrt(square);
    for (double& x : *velocity) x /= std::sqrt(square);
    const double part = product_of(v, unit);
    add_times(part, unit, lost_p), add_times(part, *velocity, lost_v);
    units.push_back(unit), velocities.push_back(*velocity);
  }
  constexpr double little = 1e-3;  // numbers of a scene may have few digits
  if (!(product_of(lost_v, lost_v) > little * little * product_of(v, v))) return {};
  const auto momenta = scene.initial.values.maybe<std::string>("initial.p"),
             rates = scene.initial.values.maybe<std::string>("initial.v");
  return fmt::format(
      "{}: the part ({:.4g}) is normal to the constraint, and is left out of the start; give one along its surface",
      momenta ? "initial.p = " + *momenta
      : rates ? "initial.v = " + *rates
              : fmt::format("the rates of the start, {:.4g}", fmt::join(v, ", ")),
      fmt::join(rounded(momenta ? lost_p : lost_v), ", "));
}

}  // namespace delf
