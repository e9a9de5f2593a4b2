// SPDX-License-Identifier: MIT
#include "tools/rows/section_source.hpp"

#include <algorithm>

#include "schemes/stepping/evolution.hpp"

namespace delf {

std::vector<double> fields_of(const LatticeSystem& system, const std::vector<double>& row) {
  std::vector<double> fields;
  for (std::size_t n = 0; n < row.size(); ++n)
    if (system.component(static_cast<int>(n) % system.components()).role == Role::field) fields.push_back(row[n]);
  return fields;
}

ComputedRows::ComputedRows(Simulation& simulation, std::int64_t rows)
    : simulation_(simulation), rows_(rows), behind_(std::ranges::max(simulation.evolution().stepper().behind())) {}

std::optional<std::vector<double>> ComputedRows::next() {
  if (next_ == rows_) return std::nullopt;
  while (simulation_.newest() - behind_ < next_) simulation_.step();
  const auto held = static_cast<int>(simulation_.newest() - next_) + 1;
  ++next_;
  return simulation_.evolution().stepper().window(held).rows.front();
}

}  // namespace delf
