// SPDX-License-Identifier: MIT
#include "tools/measure/measurement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

double MeasuredField::at(std::span<const double> row, int i) const {
  const int home = lattice.home(i), times = lattice.is_circle() ? (i - home) / lattice.sites() : 0;
  return row[home * fields] + monodromy * times;
}

double MeasuredField::at(std::span<const double> row, double x) const {
  if (lattice.space() == Space::point) return at(row, 0);
  const double place = (x - lattice.position(0)) / lattice.space_step();
  int first = static_cast<int>(std::floor(place)) - 1;
  const int count = std::min(4, lattice.sites());
  if (!lattice.is_circle()) first = std::clamp(first, 0, lattice.sites() - count);
  double sum = 0;
  for (int m = 0; m < count; ++m) {
    double weight = 1;
    for (int n = 0; n < count; ++n)
      if (n != m) weight *= (place - (first + n)) / (m - n);
    sum += weight * at(row, first + m);
  }
  return sum;
}

double MeasuredField::place(double x) const {
  const double L = lattice.length(), rounding = 1e-12 * L;
  if (lattice.space() == Space::interval && !(x >= -rounding && x <= L + rounding))
    throw BadInput("", fmt::format("x = {:.6g} is not in space; give a place from 0 to {:.6g}", x, L));
  // Round a circle any number of times, but an index of a site must be an int.
  constexpr double most_turns = 100;
  if (lattice.is_circle() && !(std::abs(x) <= most_turns * L))
    throw BadInput("", fmt::format("x = {:.6g} is far from the circle; give a place from 0 to {:.6g}", x, L));
  return x;
}

std::span<const MeasurementEntry> measurements() {
  static const MeasurementEntry all[] = {value_measurement,
                                         minimum_measurement,
                                         maximum_measurement,
                                         minimum_time_measurement,
                                         maximum_time_measurement,
                                         crossings_measurement,
                                         frequency_measurement,
                                         kinks_measurement,
                                         charge_measurement,
                                         position_measurement,
                                         speed_measurement,
                                         energy_left_measurement,
                                         wavenumber_measurement,
                                         mode_measurement,
                                         mode_rate_measurement,
                                         mode_return_measurement,
                                         mode_return_time_measurement,
                                         mean_measurement,
                                         pulse_width_measurement,
                                         peak_measurement,
                                         peak_position_measurement,
                                         crossing_time_measurement,
                                         section_value_measurement,
                                         line_measurement,
                                         energy_minimum_measurement,
                                         energy_maximum_measurement,
                                         energy_error_time_measurement};
  return all;
}

}  // namespace delf
