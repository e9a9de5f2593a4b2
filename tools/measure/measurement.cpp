// SPDX-License-Identifier: MIT
#include "tools/measure/measurement.hpp"

#include <algorithm>
#include <cmath>

#include "tools/measure/entries.hpp"

namespace delf {

double MeasuredField::at(std::span<const double> row, int i) const {
  const int home = lattice.home(i), times = lattice.is_circle() ? (i - home) / lattice.sites() : 0;
  return row[static_cast<std::size_t>(home * fields)] + turn * times;
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

std::span<const MeasurementEntry> measurements() {
  static const MeasurementEntry all[] = {value_measurement,        minimum_measurement,      maximum_measurement,
                                         minimum_time_measurement, maximum_time_measurement, crossings_measurement,
                                         frequency_measurement,    kinks_measurement,        charge_measurement,
                                         position_measurement,     speed_measurement,        energy_left_measurement,
                                         wavenumber_measurement};
  return all;
}

}  // namespace delf
