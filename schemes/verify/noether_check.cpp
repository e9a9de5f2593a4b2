// SPDX-License-Identifier: MIT
#include "schemes/verify/noether_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "schemes/system/conserved.hpp"
#include "schemes/verify/drawn_region.hpp"

namespace delf {

NoetherCheck::NoetherCheck(const LatticeSystem& system, std::vector<LinearSymmetry> symmetries, double tolerance,
                           bool forced, std::uint64_t seed)
    : system_(system), symmetries_(std::move(symmetries)), forced_(forced) {
  std::mt19937_64 random(seed);
  for (const LinearSymmetry& symmetry : symmetries_) {
    invariant_.push_back(invariance(symmetry, random));
    invariant_.back().tolerance = tolerance;
    sums_.push_back({.name = "Noether, " + symmetry.name, .region = {}, .tolerance = tolerance});
    Check& check = invariant_.back();
    if (!check.passed())
      check.failure = fmt::format(
          "{} is not a symmetry: along it the Lagrangian changes by {:.2g} of its terms. Noether's theorem owes "
          "nothing "
          "for it{}.",
          symmetry.name, check.value, forced ? ", and the sums below were asked for all the same" : "");
  }
}

Check NoetherCheck::invariance(const LinearSymmetry& symmetry, std::mt19937_64& random) const {
  constexpr int jets = 20;
  Check check{.name = "symmetry of L, " + symmetry.name, .region = {}, .value = 0};
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<double> y, r, xi;
  for (const auto& family : system_.families())
    for (int n = 0; n < jets; ++n) {
      y.resize(static_cast<std::size_t>(family->size()));
      r.resize(y.size());
      for (double& value : y) value = uniform(random);
      const int site = static_cast<int>(random() % static_cast<std::uint64_t>(system_.lattice().sites()));
      const Cell cell{system_.time_step(), system_.lattice().space_step(), 0, system_.lattice().position(site)};
      family->residual(cell, y, r);
      // Where a density is not defined around 0 (a logarithm), it may be around 1.
      if (!std::ranges::all_of(r, [](double x) { return std::isfinite(x); })) {
        for (double& value : y) value = 1 + 0.1 * value;
        family->residual(cell, y, r);
      }
      generator(system_, *family, symmetry, y, xi);
      Balance balance;
      for (std::size_t i = 0; i < r.size(); ++i) balance.add(r[i] * xi[i]);
      check.take(balance, fmt::format("{} random jets of each stencil family", jets));
    }
  return check;
}

void NoetherCheck::at(const RegionSystem& region, const RegionSystem::Values& y) {
  for (std::size_t n = 0; n < symmetries_.size(); ++n) {
    if (!invariant_[n].passed() && !forced_) continue;
    Check& check = sums_[n];
    if (!check.take(region.noether(y, symmetries_[n]), in_words(region.region(), region.origin(), region.stencils())))
      continue;
    check.failure = fmt::format("What flows into {} is not what flows out: {:.2g} of the momenta of {} is left. {}",
                                check.region, check.value, symmetries_[n].name,
                                invariant_[n].passed()
                                    ? "The Lagrangian has this symmetry, so the field equations do not hold there."
                                    : "The Lagrangian does not have this symmetry.");
  }
}

void NoetherCheck::at(const Window& rows, const RegionDrawer& drawer, const std::vector<RegionRequest>& regions,
                      std::mt19937_64& random) {
  for (const RegionRequest& request : regions)
    if (const auto region = drawer.draw(request, random)) {
      const RegionSystem here(system_, *region, rows.first_row, rows.turn);
      at(here, here.restricted(rows));
    }
}

std::vector<Check> NoetherCheck::checks() const {
  std::vector<Check> result;
  for (std::size_t n = 0; n < symmetries_.size(); ++n) {
    result.push_back(invariant_[n]);
    if (sums_[n].samples > 0) result.push_back(sums_[n]);
  }
  return result;
}

}  // namespace delf
