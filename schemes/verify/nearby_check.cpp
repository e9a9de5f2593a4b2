// SPDX-License-Identifier: MIT
#include "schemes/verify/nearby_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/verify/drawn_region.hpp"

namespace delf {
namespace {

double largest_entry(const RegionSystem::Values& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// The value at 0 of the polynomial through (x_n, q_n): q(0) = Σ_n q_n Π_{m≠n} x_m/(x_m − x_n)
double extrapolated(const std::vector<double>& x, const std::vector<double>& q) {
  double sum = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    double weight = 1;
    for (std::size_t m = 0; m < x.size(); ++m)
      if (m != n) weight *= x[m] / (x[m] - x[n]);
    sum += weight * q[n];
  }
  return sum;
}

}  // namespace

void NearbyCheck::at(const std::string& kind, const RegionSystem& region, const RegionSystem::Values& F,
                     const std::vector<RegionSystem::Pair>& differences) {
  std::vector<double> sizes, q;
  double normaliser = 0;
  std::int64_t count = 0;
  const auto balances = region.form_formula(F, differences);
  for (std::size_t p = 0; p < differences.size(); ++p) {
    if (balances[p].absolute == 0) return;  // the differences have not come to this region yet
    // ε, relative to a field of order one: what is curved is the potential, on that scale.
    sizes.push_back(std::max(largest_entry(differences[p].V), largest_entry(differences[p].W)));
    q.push_back(balances[p].sum / balances[p].absolute);
    normaliser = balances[p].absolute, count = balances[p].count;
  }
  // The rest is the next power, and rounding: the values whose differences these are were rounded when they were
  // made.
  const double delta = 8 * std::numeric_limits<double>::epsilon() * largest_entry(F);
  double next_power = 10, rounding = 0;
  for (std::size_t p = 0; p < differences.size(); ++p) {
    next_power *= sizes[p];
    rounding = std::max(rounding, region.form_error(F, differences[p], delta) / balances[p].absolute);
  }
  const double tolerance = std::max(tolerance_, next_power + rounding);
  const double value = std::abs(extrapolated(sizes, q));

  // The differences tell nothing where these explain a tenth of the sum.
  if (!(tolerance < 0.1)) {
    ++too_far_;
    return;
  }
  const std::string name = "form formula by differences, " + kind;
  auto found = std::ranges::find(worst_, name, &Check::name);
  if (found == worst_.end()) found = worst_.insert(worst_.end(), Check{.name = name, .region = {}, .tolerance = 1});
  Check& check = *found;
  // Tolerances differ from region to region: the worst is what passes least.
  if (check.samples++ > 0 && !worse(value / tolerance, check.value / check.tolerance)) return;
  check.value = value;
  check.tolerance = tolerance;
  check.normaliser = normaliser;
  check.count = count;
  check.region =
      fmt::format("{}, differences of {:.1e}{}", in_words(region.region(), region.origin(), region.stencils()),
                  *std::ranges::max_element(sizes),
                  sizes.size() > 1 ? fmt::format(" and {} smaller, extrapolated", sizes.size() - 1) : "");
  check.failure = fmt::format(
      "The differences to the nearby solutions do not keep the form formula on {}: {:.1e} of its terms is left, and "
      "their size explains no more than {:.1e}. The program that made these rows does not conserve this scheme's "
      "multisymplectic form.",
      check.region, value, tolerance);
}

std::vector<Check> NearbyCheck::checks() const { return worst_; }

std::vector<std::string> NearbyCheck::left_out() const {
  if (too_far_ == 0) return {};
  return {
      fmt::format("form formula by differences on {} region{}: the differences there are too large, or too small to "
                  "be more than rounding, to stand for first variations",
                  too_far_, too_far_ == 1 ? "" : "s")};
}

}  // namespace delf
