// SPDX-License-Identifier: MIT
#include "schemes/system/row_times.hpp"

#include <algorithm>

#include "lattice/index.hpp"

namespace delf {
namespace {

/// More than any equation or predictor reads.
constexpr std::size_t remembered = 64;

}  // namespace

const RowTimes::Row& RowTimes::at(std::int64_t row) const {
  const auto last = static_cast<std::int64_t>(rows_.size()) - 1;
  return rows_[delf::at(std::clamp<std::int64_t>(row - first_, 0, last))];
}

double RowTimes::own_time(std::int64_t row) const {
  const std::int64_t known = std::clamp(row, first_, first_ + static_cast<std::int64_t>(rows_.size()) - 1);
  return at(row).time + static_cast<double>(row - known) * at(row).step;
}

void RowTimes::begin(double step) {
  first_ = 0;
  rows_.assign(1, {0, step});
}

void RowTimes::add(double step) {
  const Row& newest = rows_.back();
  rows_.push_back({newest.time + newest.step, step});
  if (all_ || rows_.size() < 2 * remembered) return;
  const auto forgotten = static_cast<std::ptrdiff_t>(rows_.size() - remembered);
  rows_.erase(rows_.begin(), rows_.begin() + forgotten);
  first_ += forgotten;
}

void RowTimes::set(const std::vector<double>& times) {
  first_ = 0;
  rows_.clear();
  for (std::size_t row = 0; row + 1 < times.size(); ++row) rows_.push_back({times[row], times[row + 1] - times[row]});
}

}  // namespace delf
