// SPDX-License-Identifier: MIT
#include "tools/verify/energy_history.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace delf {

Measured measured_energy(const std::string& name, const std::vector<double>& E, double time_step,
                         const std::string& remark) {
  const auto n = static_cast<double>(E.size());
  double most = 0, mean = 0, slope = 0, square = 0;
  std::size_t worst = 0;
  for (std::size_t j = 0; j < E.size(); ++j) {
    if (const double off = std::abs(E[j] - E[0]); !(off <= most)) most = off, worst = j;
    mean += E[j] / n;
  }
  // the straight line of least squares
  for (std::size_t j = 0; j < E.size(); ++j) {
    const double t = (static_cast<double>(j) - (n - 1) / 2) * time_step;
    slope += t * (E[j] - mean), square += t * t;
  }
  return {.name = name,
          .region = fmt::format("row {}; {:.8g} first, {:.8g} last, trend {:.2g} a unit of time", worst, E.front(),
                                E.back(), square > 0 ? slope / square : 0),
          .value = E[0] == 0 ? most : most / std::abs(E[0]),
          .normaliser = E[0] == 0 ? 1 : std::abs(E[0]),
          .count = static_cast<std::int64_t>(E.size()),
          .remark = remark};
}

EnergyChange::EnergyChange(double first, std::int64_t first_row) : first_(first), first_row_(first_row) {
  measured_.name = "change of the energy", measured_.normaliser = std::abs(first);
}

void EnergyChange::add(double energy, std::int64_t row) {
  const double change = first_ == 0 ? 0 : std::abs(energy - first_) / std::abs(first_);
  if (++measured_.count > 1 && !worse(change, measured_.value)) return;
  measured_.value = change, measured_.region = fmt::format("row {}, relative to row {}", row, first_row_);
}

}  // namespace delf
