// SPDX-License-Identifier: MIT
#include "schemes/verify/force_share.hpp"

#include <algorithm>
#include <cmath>

#include "schemes/verify/drawn_region.hpp"

namespace delf {

ForceShare::ForceShare(const LatticeSystem& system)
    : system_(&system), at_(static_cast<std::size_t>(system.lattice().sites() * system.components())) {}

void ForceShare::at(const Window& window, std::int64_t row, const std::vector<LatticeSystem::Value>& E,
                    const std::vector<double>& relative, double tolerance) {
  const auto reach = static_cast<std::int64_t>(std::max(1, system_->height()));
  Window still = window;
  still.first_row = row - reach;
  const std::vector<double> here = window.rows[static_cast<std::size_t>(row - window.first_row)];
  still.rows.assign(static_cast<std::size_t>(2 * reach + 1), here);
  system_->equations(still, row, forces_);
  for (std::size_t n = 0; n < at_.size(); ++n) {
    const int component = static_cast<int>(n) % system_->components();
    if (std::isnan(relative[n]) || system_->component(component).role != Role::field) continue;
    ++equations_;
    Largest& largest = at_[n];
    const double error = std::abs(E[n].sum), force = std::abs(forces_[n].sum);
    if (error > largest.error) largest.error = error, largest.row = row;
    if (relative[n] > tolerance) largest.failed = std::max(largest.failed, error);
    // what is left of terms that cancel is no force
    if (force > 1e-14 * forces_[n].absolute) largest.force = std::max(largest.force, force);
  }
}

std::vector<Measured> ForceShare::measured() const {
  double force = 0;
  for (const Largest& largest : at_) force = std::max(force, largest.force);
  if (force == 0) return {};
  const auto where = [&](std::size_t n) {
    const auto C = static_cast<std::size_t>(system_->components());
    return in_words(*system_, Node{{0, static_cast<int>(n / C)}, static_cast<int>(n % C)}, at_[n].row);
  };
  const auto worst = static_cast<std::size_t>(std::ranges::max_element(at_, {}, &Largest::error) - at_.begin());
  std::vector<Measured> result{{.name = "equations: |E| beside the largest force",
                                .region = where(worst),
                                .value = at_[worst].error / force,
                                .normaliser = force,
                                .count = equations_,
                                .remark = "verdicts are relative to the terms"}};
  const auto share = [](const Largest& site) { return site.force > 0 ? site.failed / site.force : 0; };
  const auto site = static_cast<std::size_t>(std::ranges::max_element(at_, {}, share) - at_.begin());
  if (share(at_[site]) > 0)
    result.push_back({.name = "equations: |E| of a site beside its force",
                      .region = where(site),
                      .value = share(at_[site]),
                      .normaliser = at_[site].force,
                      .count = equations_,
                      .remark = "of equations that fail"});
  return result;
}

}  // namespace delf
