// SPDX-License-Identifier: MIT
#include "tools/convergence/convergence_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/turn.hpp"
#include "tools/compare/refined_scene.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/warnings/linear_limit.hpp"

namespace delf {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Each step adds an error of the last digits, or of the tolerance that it was solved to.
double rounding_of(const ConvergenceTable& table, const ConvergenceLevel& level, double tolerance) {
  return 16 * (epsilon + tolerance) * table.size * static_cast<double>(level.steps);
}

/// The last two orders are the same, as those of rounding are not.
bool falls_regularly(const ConvergenceTable& table) {
  std::vector<double> orders;
  for (const ConvergenceLevel& level : table.levels)
    if (std::isfinite(level.order)) orders.push_back(level.order);
  const std::size_t n = orders.size();
  return n >= 2 && orders[n - 1] > 0.5 && std::abs(orders[n - 1] - orders[n - 2]) < 0.15;
}

/// The order of the last line whose error, and that of the line before it, are above rounding.
double order_above_rounding(const ConvergenceTable& table, double tolerance) {
  for (std::size_t i = table.levels.size(); i-- > 1;) {
    const ConvergenceLevel &coarse = table.levels[i - 1], &fine = table.levels[i];
    if (std::isfinite(coarse.order) && fine.*table.norm > rounding_of(table, fine, tolerance)) return coarse.order;
  }
  return ConvergenceLevel::unknown;
}

/// log₂ of the ratio of the last two differences between lines.
double order_of_differences(const ConvergenceTable& table) {
  const std::size_t n = table.levels.size();
  if (n < 3) return ConvergenceLevel::unknown;
  return std::log2(table.levels[n - 3].apart / table.levels[n - 2].apart);
}

double last_error(const ConvergenceTable& table) {
  for (auto level = table.levels.rbegin(); level != table.levels.rend(); ++level)
    if (std::isfinite((*level).*table.norm)) return (*level).*table.norm;
  return ConvergenceLevel::unknown;
}

std::optional<std::string> unstable_in_words(const Scene& scene, const ConvergenceTable& table) {
  const ConvergenceLevel &first = table.levels.front(), &last = table.levels.back();
  const Scene fine = refined(scene, 1 << (table.levels.size() - 1));
  try {
    const InitialRows initial(fine);
    if (auto words = beyond_linear_limit(fine, build(fine, initial.winding()), fine.steps)) return words;
  } catch (const Error&) {  // without such a theory
  }
  if (last.size > 100 * first.size && first.size > 0)
    return fmt::format("the last row grows from {:.2g} to {:.2g} as steps are halved: use smaller lattice.{}",
                       first.size, last.size, scene.problem.lattice.space() == Space::point ? "time_step" : "courant");
  return {};
}

/// Walls where the scheme takes a cell, or a half of one, by itself.
bool has_walls_of_its_own(const Lattice& lattice) {
  const auto own = [](Wall wall) { return wall != Wall::fixed; };
  return lattice.space() == Space::interval && (own(lattice.left()) || own(lattice.right()));
}

}  // namespace

bool OrderRequest::met(double measured) const {
  if (order) return std::abs(measured - *order) <= agreement;
  return !of_scheme || !std::isfinite(measured) || measured >= *of_scheme - agreement;
}

const char* to_string(ConvergenceVerdict::Kind kind) {
  switch (kind) {
    case ConvergenceVerdict::passed:
      return "passed";
    case ConvergenceVerdict::missed:
      return "missed";
    case ConvergenceVerdict::not_measured:
      return "not measured";
    case ConvergenceVerdict::unstable:
      return "unstable";
  }
  return "";
}

EndsOfLattice off_at_ends(const Scene& scene) {
  const Lattice& lattice = scene.problem.lattice;
  if (lattice.space() == Space::point || scene.from_file()) return {};
  const auto state = make_state(scene.initial, lattice);
  const double L = lattice.length(), end = scene.end(), acts = std::min(end, L),
               turn = 2 * std::numbers::pi * state->winding() + gain_of(scene.problem.parameters);
  const int times = state->exact() ? 9 : 1, points = lattice.is_circle() ? 2048 : 2;
  const auto d = static_cast<std::size_t>(state->components());
  EndsOfLattice result;
  const auto take = [&](double off, const char* words) {
    if (off > result.off) result = {off, fmt::format("{} by {:.2g}", words, off)};
  };
  using Points = std::vector<FieldPoint>;
  std::vector<Points> first, row(static_cast<std::size_t>(points), Points(d));
  const auto at = [&](double t, double x) {
    Points values(d);
    state->at(t, std::fmod(x, L), values);
    for (FieldPoint& value : values) value.phi += x >= L ? turn : 0;
    return values;
  };
  for (int n = 0; n < times; ++n) {
    const double t = n == 0 ? 0 : end * n / (times - 1);
    for (int i = 0; i < points; ++i)
      state->at(t, lattice.is_circle() ? L * i / points : L * i, row[static_cast<std::size_t>(i)]);
    if (n == 0) first = row;
    for (std::size_t a = 0; a < d; ++a) {
      if (lattice.is_circle()) {
        // A pulse may have its seam anywhere. What stays of a difference where an interval is halved again and again:
        const auto jump = [&](const auto& difference) {
          double most = 0, from = 0, to = 0;
          for (std::size_t i = 0; i < row.size(); ++i) {
            FieldPoint next = row[(i + 1) % row.size()][a];
            if (i + 1 == row.size()) next.phi += turn;
            if (const double by = difference(row[i][a], next, L / points); by > most)
              most = by, from = L * static_cast<double>(i) / points, to = from + L / points;
          }
          for (int halved = 0; halved < 30 && most > 0; ++halved) {
            const double middle = (from + to) / 2;
            const FieldPoint left = at(t, from)[a], here = at(t, middle)[a], right = at(t, to)[a];
            const double below = difference(left, here, middle - from), above = difference(here, right, to - middle);
            most = std::max(below, above);
            (below > above ? to : from) = middle;
          }
          return most;
        };
        take(jump([](const FieldPoint& l, const FieldPoint& r, double apart) {
               return std::abs(r.phi - l.phi - apart * (l.phi_x + r.phi_x) / 2);
             }),
             "jumps where the circle closes,");
        take(acts * jump([](const FieldPoint& l, const FieldPoint& r, double) { return std::abs(r.phi_x - l.phi_x); }),
             "has a corner where the circle closes, which moves it");
        continue;
      }
      const auto at_wall = [&](Wall wall, const FieldPoint& now, const FieldPoint& before) {
        if (wall == Wall::natural)
          return take(std::abs(now.phi_x) * acts, "has a slope at a natural wall, which moves it");
        take(std::abs(now.phi - before.phi), "moves at a fixed wall,");
        if (times == 1) take(std::abs(now.phi_t) * acts, "has a rate at a fixed wall, which would move it");
      };
      at_wall(lattice.left(), row[0][a], first[0][a]);
      at_wall(lattice.right(), row[1][a], first[1][a]);
    }
  }
  return result;
}

ConvergenceVerdict judge(const ConvergenceTable& table, const OrderRequest& request, const Scene* scene) {
  using Kind = ConvergenceVerdict::Kind;
  const double order = table.order(), tolerance = scene ? scene->problem.tolerance : 0;
  if (table.levels.size() < 2 || request.met(order))
    return {request.met(order) ? Kind::passed : Kind::missed, order, ""};
  if (scene)
    if (auto words = unstable_in_words(*scene, table)) return {Kind::unstable, order, *words};
  if (!falls_regularly(table)) {
    const double above = order_above_rounding(table, tolerance);
    if (!std::isfinite(above))
      return {Kind::not_measured, order,
              fmt::format("errors near {:.1g} are those of rounding, after {} steps: begin with larger steps",
                          last_error(table), table.levels.back().steps)};
    if (above != order && request.met(above))
      return {Kind::passed, above,
              "of the lines above rounding; the errors of the last ones are the rounding of their steps"};
  }
  if (!scene) return {Kind::missed, order, ""};
  const std::string subject = table.exact ? "the exact solution " : "the initial state ";
  if (const EndsOfLattice ends = off_at_ends(*scene); ends.off > 0.1 * last_error(table))
    return {Kind::not_measured, order,
            fmt::format("{}{}, and the last {} is {:.2g}: it is that of the ends, and not the scheme's; keep the field "
                        "away from both ends of lattice.length",
                        subject, ends.words, table.exact ? "error" : "difference", last_error(table))};
  const double own = order_of_differences(table), lines = table.levels[table.levels.size() - 2].apart;
  if (table.exact && own > 0.5 && last_error(table) > 4 * lines)
    return {
        Kind::not_measured, order,
        fmt::format("the rows of the lines approach each other, the last two to {:.2g}, and not the exact solution, "
                    "which stays {:.2g} away: it does not solve these equations with this start and these walls",
                    lines, last_error(table))};
  if (has_walls_of_its_own(scene->problem.lattice) && !request.order && std::abs(order - 1) <= request.agreement)
    return {
        Kind::not_measured, order,
        "this is the order of the walls, where the scheme is of first order; on a circle, or between fixed walls, it "
        "is that of the scheme"};
  return {Kind::missed, order, ""};
}

}  // namespace delf
