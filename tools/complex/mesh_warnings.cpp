// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/system/constraint_slopes.hpp"

namespace delf {
namespace {

double largest(std::span<const double> values) {
  double most = 0;
  for (const double y : values)
    if (!(std::abs(y) <= most)) most = std::abs(y);
  return most;
}

/// The largest range of a field of the solution until `end`.
double range_of_solution(const ComplexScene& c, double end) {
  const std::size_t d = c.fields.size();
  const int times = std::clamp(2048 / c.sites(), 2, 64);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> least(d, infinity), most(d, -infinity);
  for (int n = 0; n < times; ++n) {
    const std::vector<double> row = c.solution(end * n / (times - 1));
    for (std::size_t i = 0; i < row.size(); ++i) {
      least[i % d] = std::min(least[i % d], row[i]);
      most[i % d] = std::max(most[i % d], row[i]);
    }
  }
  double range = 0;
  for (std::size_t a = 0; a < d; ++a) range = std::max(range, most[a] - least[a]);
  return range;
}

}  // namespace

std::vector<std::string> warnings_of_rows(const ComplexScene& c, const Outcome& o, double energy_of_start,
                                          const Trace& energy_errors, std::span<const double> last_row) {
  // A row's energy is that of the half step above or below it, and waves of a coarse mesh are as long as a few cells.
  constexpr double ten_percent = 0.1;
  const std::string remedy =
      c.scene.settings.find("lattice.courant") ? "reduce lattice.courant" : "reduce lattice.time_step";
  std::vector<Found> found;
  // A boundary that does work brings energy and fields that the start does not have; the work of a density that reads t is
  // not known.
  if (!c.boundary_works())
    found.push_back(energy_off_start(o, std::isnan(energy_of_start) ? o.energy_initial : energy_of_start, ten_percent,
                                     remedy + ", or refine the mesh"));
  if (!c.boundary_works() || !c.theory->is_placed())
    found.push_back(energy_off_band(energy_errors, remedy + ", or run less far"));
  if (c.has_solution())
    found.push_back(error_beyond_range(o, range_of_solution(c, o.time), remedy + ", or refine the mesh"));
  else if (!c.boundary_works())
    found.push_back(field_beyond_data(largest(last_row), std::max(largest(c.values()), o.time * largest(c.rates())),
                                      "the steps are too long, or the theory has no bounds; " + remedy));
  if (c.theory->constraint() && c.space && !c.space->driven.empty()) {
    double most = 0;
    const std::size_t d = c.fields.size();
    c.space->each_constraint(last_row, [&](std::size_t i, double, std::span<const double> slopes) {
      most = std::max(most, constraint_terms(slopes, last_row.subspan(i * d, d)));
    });
    found.push_back(off_constraint(o.constraint_max, most, c.scene.problem.tolerance));
  }
  std::vector<std::string> all;
  for (Found& one : found)
    if (one) all.push_back(std::move(*one));
  return all;
}

}  // namespace delf
