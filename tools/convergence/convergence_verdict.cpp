// SPDX-License-Identifier: MIT
#include "tools/convergence/convergence_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/state.hpp"
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

EndChange off_at_ends(const Scene& scene) {
  if (scene.from_file()) return {};
  return at_the_ends(scene, *make_state(scene.initial, scene.problem.lattice)).larger();
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
  if (const EndChange ends = off_at_ends(*scene); ends.change > 0.1 * last_error(table))
    return {Kind::not_measured, order,
            fmt::format("{}{}, by {:.2g}, and the last {} is {:.2g}: it is that of the ends, and not the scheme's; keep "
                        "the field away from both ends of lattice.length",
                        subject, ends.words, ends.change, table.exact ? "error" : "difference", last_error(table))};
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
