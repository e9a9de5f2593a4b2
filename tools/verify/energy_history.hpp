// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "schemes/verify/check.hpp"

namespace delf {

/// The history of an energy at every row, a step of time apart: the largest change beside the first value, where it
/// begins, ends and goes. A map that keeps dq^dp swings about a modified energy; one that does not has a trend.
Measured measured_energy(const std::string& name, const std::vector<double>& values, double time_step,
                         const std::string& remark);

/// The largest change of an energy since a first row, relative to its value there: what there is to be kept where steps
/// differ.
class EnergyChange {
 public:
  EnergyChange(double first, std::int64_t first_row);
  void add(double energy, std::int64_t row);
  const Measured& measured() const { return measured_; }

 private:
  double first_;
  std::int64_t first_row_;
  Measured measured_;
};

/// The reason for which forms of steps that the field chooses are not those of the map of rows.
inline constexpr auto not_symplectic =
    "symplecticity: the forms here are of steps as given; with steps chosen by the field the map of rows is "
    "reversible, not symplectic, and its energy is what is measured";

}  // namespace delf
