// SPDX-License-Identifier: MIT
#include "tools/warnings/energy_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace delf {

Found energy_off_start(const Outcome& outcome, double energy_of_start, double allowed, const std::string& remedy,
                       const KnownWork& known) {
  if (energy_of_start == 0 || !std::isfinite(energy_of_start)) return {};
  const char* const last =
      known.work == 0 ? "the last row" : "the last row, less the work of the density, which reads t,";
  for (const auto& [which, energy] :
       {std::pair{"row 0", outcome.energy_initial}, {last, outcome.energy_final - known.work}})
    if (!(std::abs(energy - energy_of_start) <= allowed * std::abs(energy_of_start) + known.uncertainty))
      return fmt::format("the energy of {} is {:.6g}, and that of the initial state {:.6g}; {}", which, energy,
                         energy_of_start, remedy);
  return {};
}

Found energy_off_band(const Trace& energy_errors, const std::string& remedy) {
  constexpr double one_percent = 0.01;
  const auto& intervals = energy_errors.intervals();
  if (intervals.empty()) return {};
  const double early = intervals.back().end / 10, late = intervals.back().end - early;
  double least = std::numeric_limits<double>::infinity(), most = -least, least_late = least, most_late = most;
  int seen = 0;
  for (const auto& interval : intervals) {
    if (interval.end <= early) least = std::min(least, interval.least), most = std::max(most, interval.most), ++seen;
    if (interval.end >= late)
      least_late = std::min(least_late, interval.least), most_late = std::max(most_late, interval.most);
  }
  // One row has no band.
  const double middle = (least + most) / 2, width = most - least;
  const double allowed = std::max(std::clamp(5 * width, one_percent, 2.5 * one_percent), 2 * width);
  for (const auto& interval : intervals)
    if (seen >= 2 && !(std::max(interval.most - middle, middle - interval.least) <= allowed))
      return fmt::format("the energy leaves its early band, {:.2g} of itself, by more than {:.2g} at t = {:.6g}; {}",
                         width, allowed - width / 2, interval.begin, remedy);
  // Whatever its band is, an energy that is kept comes back to where it was.
  if (const double gone = std::max(least_late, -most_late); !(gone <= 20 * one_percent))
    return fmt::format("the energy {} {:.2g} of itself, and does not come back; {}",
                       gone == least_late ? "gains" : "loses", gone, remedy);
  return {};
}

Found error_beyond_range(const Outcome& outcome, double range, const std::string& remedy) {
  if (!(outcome.error_linf > 0) || !(outcome.error_linf > range)) return {};
  return fmt::format("the error of the last row, {:.3g}, is larger than the range of the solution, {:.3g}; {}",
                     outcome.error_linf, range, remedy);
}

Found off_constraint(double found, double terms, double tolerance) {
  constexpr double rounding = 1e-8;
  if (!(found > std::max(rounding, 1e3 * tolerance) * std::max(1.0, terms))) return {};
  return fmt::format(
      "the boundary moves off the constraint, which is {:.3g} there and not 0: the run is none of this theory; give "
      "formulas that keep it at all times",
      found);
}

Found field_beyond_data(double found, double data, const std::string& reason) {
  constexpr double much = 100;
  if (found <= much * data) return {};
  return fmt::format("the field grows to {:.3g}, from data of {:.3g}: {}", found, data, reason);
}

}  // namespace delf
