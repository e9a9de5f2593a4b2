// SPDX-License-Identifier: MIT
#include "tools/diagnosis/evidence.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"

namespace delf {

void FailedEquations::add(std::int64_t row, const std::vector<double>& relative, int components, double tolerance) {
  of_site_.resize(relative.size() / at(components));
  bool any = false;
  for (std::size_t n = 0; n < relative.size(); ++n) {
    if (std::isnan(relative[n])) continue;
    ++tried_;
    if (relative[n] > worst_) worst_ = relative[n], worst_row_ = row;
    if (relative[n] <= tolerance) continue;
    ++failed_, ++of_site_[n / at(components)];
    any = true;
  }
  ++rows_tried_;
  if (any) rows_.push_back(row);
}

std::vector<int> FailedEquations::sites() const {
  std::vector<int> sites;
  for (std::size_t i = 0; i < of_site_.size(); ++i)
    if (of_site_[i] > 0) sites.push_back(static_cast<int>(i));
  return sites;
}

}  // namespace delf
