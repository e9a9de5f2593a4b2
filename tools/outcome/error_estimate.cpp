// SPDX-License-Identifier: MIT
#include "tools/outcome/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/system/lattice_system.hpp"
#include "tools/compare/field_error.hpp"
#include "tools/compare/refined_scene.hpp"
#include "tools/outcome/outcome.hpp"

namespace delf {

Richardson richardson(double first, double second, double size) {
  constexpr double rounding = 1e-13;
  if (!std::isfinite(first) || !std::isfinite(second)) return {};
  if (std::max(first, second) <= rounding * size) return {std::max(first, second), Richardson{}.order, true};
  Richardson r;
  r.order = std::log2(first / second);
  // Differences that fall by less than √2 say nothing of the error.
  constexpr double least_order = 0.5;
  r.converging = r.order >= least_order;
  if (r.converging) r.error = std::isinf(r.order) ? first : first / (1 - std::exp2(-r.order));
  return r;
}

namespace {

double largest_of(const std::vector<double>& row) {
  double largest = 0;
  for (const double y : row) largest = std::max(largest, std::abs(y));
  return largest;
}

std::string in_words(const std::string& what, const Richardson& r) {
  if (!r.converging)
    return std::isfinite(r.order) ? fmt::format("{}: not converging (order {:.2g} from three runs)", what, r.order)
                                  : fmt::format("{}: not known", what);
  return fmt::format("{}: error {:.3g}{}", what, r.error,
                     std::isfinite(r.order) ? fmt::format(", order {:.3g}", r.order) : "");
}

}  // namespace

std::vector<std::string> in_words(const ErrorEstimate& e) {
  if (!e.failure.empty()) return {"none: " + e.failure};
  std::vector<std::string> lines{in_words("last row", e.row)};
  for (const auto& [name, r] : e.measures) lines.push_back(in_words(name, r));
  return lines;
}

void require_estimable(const Scene& scene, const LatticeSystem& system) {
  const auto refuse = [&](const char* why) { throw scene.settings.error("output.estimate", why); };
  if (scene.problem.step_control) refuse("reversible steps end at times of their own; use delf convergence");
  if (system.moves()) refuse("sites move, and those of other runs lie elsewhere; use delf convergence");
  if (scene.from_file()) refuse("rows of a file are those of one lattice and step; leave it out");
}

ErrorEstimate estimate_error(const Scene& scene, const Outcome& outcome, const std::vector<double>& last_row) {
  ErrorEstimate estimate;
  const auto interrupted = [&] {
    estimate.interrupted = true;
    estimate.failure = "interrupted";
    return estimate;
  };
  if (outcome.status == "interrupted") return interrupted();
  try {
    if (outcome.status != "done") throw BadInput("", "the run did not end well");
    const QuietEnd half = run_quietly(refined(scene, 2));
    if (!half.finished) return interrupted();
    const QuietEnd quarter = run_quietly(refined(scene, 4));
    if (!quarter.finished) return interrupted();
    const std::vector<double> of_half = at_sites_of(scene, half.row, 2),
                              of_quarter = at_sites_of(scene, quarter.row, 4);
    const double k = scene.problem.lattice.space_step();
    estimate.row = richardson(field_error(last_row, of_half, k).linf, field_error(of_half, of_quarter, k).linf,
                              largest_of(last_row));
    for (std::size_t m = 0; m < outcome.measures.size(); ++m) {
      const double a = outcome.measures[m].value, b = half.measures[m].value, c = quarter.measures[m].value;
      estimate.measures.emplace_back(outcome.measures[m].name,
                                     richardson(std::abs(a - b), std::abs(b - c), std::abs(a)));
    }
  } catch (const Error& error) {
    estimate.failure = error.what();
  }
  return estimate;
}

}  // namespace delf
