// SPDX-License-Identifier: MIT
#include "tools/rows/nearby_rows.hpp"

#include <algorithm>
#include <utility>

#include "lattice/index.hpp"

namespace delf {

NearbyRows::NearbyRows(const std::filesystem::path& path, const LatticeSystem& system, const std::vector<int>& behind,
                       double time_step, double monodromy, int held, std::optional<EquationCheck> equations)
    : system_(system),
      name_(path.filename().string()),
      section_(path, system, behind, time_step, "--nearby"),
      held_(system.window(0, {}, monodromy)),
      most_(at(held)),
      equations_(std::move(equations)) {}

void NearbyRows::take(std::int64_t j) {
  held_.rows.push_back(section_.row(j));
  if (held_.rows.size() > most_) {
    held_.rows.erase(held_.rows.begin());
    ++held_.first_row;
  }
  if (equations_ && j >= 2 * equations_->reach()) equations_->at(held_, j - equations_->reach());
}

Window NearbyRows::difference(const Window& window) const {
  std::vector<std::vector<double>> rows(held_.rows.end() - static_cast<std::ptrdiff_t>(window.rows.size()),
                                        held_.rows.end());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t n = 0; n < rows[r].size(); ++n) rows[r][n] -= window.rows[r][n];
  return system_.window(window.first_row, std::move(rows), 0);
}

std::vector<Check> NearbyRows::checks() const {
  std::vector<Check> checks = equations_ ? equations_->checks() : std::vector<Check>{};
  for (Check& check : checks) check.name += " of " + name_;
  return checks;
}

}  // namespace delf
