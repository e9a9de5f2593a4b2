// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/section_rows.hpp"

namespace delf {

SectionRows::SectionRows(const LatticeSystem& system, int halo, int rows, int increments, double turn)
    : lattice_(&system.lattice()),
      d_(system.components()),
      turn_(turn),
      layout_(system.lattice(), halo, system.placement() == Placement::brick_wall ? 2 : 1),
      y_(layout_, rows * d_),
      v_(layout_, increments * d_),
      y_slots_(rows),
      v_slots_(increments) {}

void SectionRows::find_increment(std::int64_t row) {
  for (int a = 0; a < d_; ++a) {
    double* increment = v(row, a);
    const double *above = y(row, a), *below = y(row - 1, a);
    for (std::size_t s = 0; s < layout_.doubles(); ++s) increment[s] = above[s] - below[s];
  }
}

void SectionRows::set_row(std::int64_t row, const std::vector<double>& values) {
  std::vector<double> one(static_cast<std::size_t>(sites()));
  for (int a = 0; a < d_; ++a) {
    for (std::size_t i = 0; i < one.size(); ++i)
      one[i] = values[i * static_cast<std::size_t>(d_) + static_cast<std::size_t>(a)];
    layout_.scatter(one, y(row, a), turn_);
  }
}

std::vector<double> SectionRows::row(std::int64_t row) {
  std::vector<double> values(static_cast<std::size_t>(sites() * d_)), one(static_cast<std::size_t>(sites()));
  for (int a = 0; a < d_; ++a) {
    layout_.gather(y(row, a), one);
    for (std::size_t i = 0; i < one.size(); ++i)
      values[i * static_cast<std::size_t>(d_) + static_cast<std::size_t>(a)] = one[i];
  }
  return values;
}

Window SectionRows::window(std::int64_t first, std::int64_t last) {
  Window result{lattice_, d_, turn_, first, {}};
  for (std::int64_t r = first; r <= last; ++r) result.rows.push_back(row(r));
  return result;
}

}  // namespace delf
