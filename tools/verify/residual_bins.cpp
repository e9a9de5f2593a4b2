// SPDX-License-Identifier: MIT
#include "tools/verify/residual_bins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/index.hpp"

namespace delf {

ResidualBins::ResidualBins(const Lattice& lattice, double time_step, std::int64_t first_row, std::int64_t rows)
    : lattice_(lattice),
      time_step_(time_step),
      first_(first_row),
      rows_(rows),
      row_bins_(std::min(rows, most)),
      site_bins_(static_cast<int>(std::min<std::int64_t>(lattice.sites(), most))),
      largest_(delf::at(row_bins_ * site_bins_), std::numeric_limits<double>::quiet_NaN()) {}

void ResidualBins::add(std::int64_t row, const std::vector<double>& residuals, int components) {
  const std::int64_t at = std::min(row_bins_ - 1, (row - first_) * row_bins_ / rows_);
  double* const bins = largest_.data() + at * site_bins_;
  const auto N = static_cast<std::int64_t>(lattice_.sites());
  for (std::size_t n = 0; n < residuals.size(); ++n) {
    const double value = residuals[n];
    double& bin = bins[static_cast<std::int64_t>(n) / components * site_bins_ / N];
    if (!std::isnan(value) && !(value <= bin)) bin = value;
  }
}

ResidualMap ResidualBins::map() const {
  ResidualMap map;
  for (std::int64_t j = 0; j < row_bins_; ++j)
    map.time.push_back((static_cast<double>(first_) +
                        (static_cast<double>(j) + 0.5) * static_cast<double>(rows_) / static_cast<double>(row_bins_) -
                        0.5) *
                       time_step_);
  for (int i = 0; i < site_bins_; ++i)
    map.space.push_back(lattice_.position(0) +
                        ((i + 0.5) * lattice_.sites() / site_bins_ - 0.5) * lattice_.space_step());
  for (const double value : largest_) map.log10.push_back(std::log10(value));
  return map;
}

}  // namespace delf
