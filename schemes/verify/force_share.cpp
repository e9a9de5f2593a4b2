// SPDX-License-Identifier: MIT
#include "schemes/verify/force_share.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/verify/drawn_region.hpp"

namespace delf {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

ForceShare::ForceShare(const LatticeSystem& system, std::int64_t rows, double solver)
    : system_(&system),
      row_(system),
      stride_(std::clamp<std::int64_t>(rows / 64, 1, 8)),
      solver_(solver),
      at_(static_cast<std::size_t>(system.lattice().sites() * system.components())) {
  // Σ_a |∂E/∂y_a|, in the midst of space: what an error of the values makes of E
  const int middle = system.lattice().sites() / 2;
  for (int c = 0; c < system.components(); ++c) {
    if (system.component(c).role != Role::field) continue;
    double sum = 0;
    for (const Coefficient& one : system.linearised({0, middle}, c)) sum += std::abs(one.value);
    coefficients_ = std::max(coefficients_, sum);
  }
}

void ForceShare::at(const Window& window, std::int64_t row, const std::vector<LatticeSystem::Value>& E,
                    const std::vector<double>& relative, double tolerance) {
  const std::vector<double>& here = window.rows[static_cast<std::size_t>(row - window.first_row)];
  const bool evaluated = seen_++ % stride_ == 0;
  if (evaluated) {
    const auto reach = static_cast<std::int64_t>(std::max(1, system_->height()));
    Window still = window;
    still.first_row = row - reach;
    still.rows.assign(static_cast<std::size_t>(2 * reach + 1), here), still.low.clear();
    row_.equations(still, row, forces_);
  }
  errors_.assign(at_.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t n = 0; n < at_.size(); ++n) {
    const int component = static_cast<int>(n) % system_->components();
    if (std::isnan(relative[n]) || system_->component(component).role != Role::field) continue;
    ++equations_;
    Largest& largest = at_[n];
    largest.seen = true;
    const double error = errors_[n] = std::abs(E[n].sum);
    if (error > largest.error) largest.error = error, largest.row = row;
    largest.failed = largest.failed || relative[n] > tolerance;
    if (const double y = std::abs(here[n]); y > largest.value)
      largest.value = y, largest_value_ = std::max(largest_value_, y);
    if (!evaluated) continue;
    // what is left of terms that cancel is no force
    const double force = std::abs(forces_[n].sum);
    if (force > 1e-14 * forces_[n].absolute) largest.force = std::max(largest.force, force);
  }
}

SiteSeverity ForceShare::severity(std::size_t n) const {
  const auto C = static_cast<std::size_t>(system_->components());
  const int site = static_cast<int>(n / C), c = static_cast<int>(n % C);
  double value = at_[n].value;
  for (const int side : {-1, 1})
    if (const int beside = system_->lattice().home(site + side); beside >= 0 && beside < system_->lattice().sites())
      value = std::max(value, at_[static_cast<std::size_t>(beside) * C + n % C].value);
  return {.site = site,
          .field = system_->component(c).name,
          .row = at_[n].row,
          .error = at_[n].error,
          .force = at_[n].force,
          .rounding = coefficients_ * (8 * epsilon * value + solver_ * largest_value_)};
}

std::vector<SiteSeverity> ForceShare::sites() const {
  std::vector<SiteSeverity> all;
  for (std::size_t n = 0; n < at_.size(); ++n)
    if (at_[n].seen) all.push_back(severity(n));
  return all;
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
  std::size_t site = 0;
  double most = 0;
  for (std::size_t n = 0; n < at_.size(); ++n)
    if (const double share = at_[n].seen ? severity(n).share() : 0; share > most) most = share, site = n;
  if (most > 0)
    result.push_back({.name = "equations: |E| of a site beside its force",
                      .region = where(site),
                      .value = most,
                      .normaliser = at_[site].force,
                      .count = equations_,
                      .remark = at_[site].failed ? "of equations that fail"
                                                 : "more than rounding, and below the tolerance of the checks"});
  return result;
}

}  // namespace delf
