// SPDX-License-Identifier: MIT
#include "tools/compare/estimate_error.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "tools/compare/field_error.hpp"
#include "tools/compare/refined_scene.hpp"

namespace delf {

namespace {

double largest_of(const std::vector<double>& row) {
  double largest = 0;
  for (const double y : row) largest = std::max(largest, std::abs(y));
  return largest;
}

}  // namespace

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
