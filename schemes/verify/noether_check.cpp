// SPDX-License-Identifier: MIT
#include "schemes/verify/noether_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

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
    const auto cancels = invariant_.back().passed() ? std::nullopt : divergence(symmetry, random);
    up_to_divergence_.push_back(cancels && cancels->value <= tolerance);
    if (up_to_divergence_.back()) {
      invariant_.back() = *cancels;
      invariant_.back().tolerance = tolerance;
    }
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

namespace {

/// Random values on a stencil, and the residual there. Where a density is not defined (a logarithm of φ, a root of
/// 1 − φ_t² + φ_x²), it may be around 1, or where derivatives are small.
void draw(const StencilFamily& family, const Cell& cell, std::mt19937_64& random, std::vector<double>& y,
          std::vector<double>& r) {
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<double> unit(y.size());
  for (double& value : unit) value = uniform(random);
  const double small = 0.1 * std::min(cell.time_step, cell.space_step);
  for (const auto& [centre, size] : {std::pair{0.0, 1.0}, {1.0, 0.1}, {0.0, small}, {1.0, small}}) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = centre + size * unit[i];
    family.residual(cell, y, r);
    if (std::ranges::all_of(r, [](double x) { return std::isfinite(x); })) return;
  }
}

}  // namespace

Check NoetherCheck::invariance(const LinearSymmetry& symmetry, std::mt19937_64& random) const {
  constexpr int jets = 20;
  Check check{.name = "symmetry of L, " + symmetry.name, .region = {}, .value = 0};
  std::vector<double> y, r, xi;
  for (const auto& family : system_.families())
    for (int n = 0; n < jets; ++n) {
      y.resize(static_cast<std::size_t>(family->size()));
      r.resize(y.size());
      const int site = static_cast<int>(random() % static_cast<std::uint64_t>(system_.lattice().sites()));
      const Cell cell{system_.time_step(), system_.lattice().space_step(), 0, system_.lattice().position(site)};
      draw(*family, cell, random, y, r);
      generator(system_, *family, symmetry, y, xi);
      Balance balance;
      for (std::size_t i = 0; i < r.size(); ++i) balance.add(r[i] * xi[i]);
      check.take(balance, fmt::format("{} random jets of each stencil family", jets));
    }
  return check;
}

std::optional<Check> NoetherCheck::divergence(const LinearSymmetry& symmetry, std::mt19937_64& random) const {
  constexpr int jets = 5;
  // ∂δL/∂y summed over the stencils that meet at a site: by component, and on brick walls by the parity of the site
  std::map<std::pair<int, int>, Balance> at_site;
  for (const auto& family : system_.families()) {
    const auto n = static_cast<std::size_t>(family->size());
    std::vector<double> y(n), r(n), J(n * n), xi(n), moved(n), first, size(n);
    for (int sample = 0; sample < jets; ++sample) {
      const int site = static_cast<int>(random() % static_cast<std::uint64_t>(system_.lattice().sites()));
      const Cell cell{system_.time_step(), system_.lattice().space_step(), 0, system_.lattice().position(site)};
      draw(*family, cell, random, y, r);
      family->jacobian(cell, y, J);
      generator(system_, *family, symmetry, y, xi);
      // ∂δL/∂yᵐ = Σ_i ∂rⁱ/∂yᵐ ξⁱ + rⁱ ∂ξⁱ/∂yᵐ
      std::vector<double> slope(n);
      for (std::size_t m = 0; m < n; ++m) {
        std::vector<double> there = y;
        there[m] += 1;
        generator(system_, *family, symmetry, there, moved);
        size[m] = 0;
        for (std::size_t i = 0; i < n; ++i)
          for (const double term : {J[i * n + m] * xi[i], r[i] * (moved[i] - xi[i])})
            slope[m] += term, size[m] += std::abs(term);
      }
      if (first.empty()) first = slope;
      for (std::size_t m = 0; m < n; ++m)
        if (!(std::abs(slope[m] - first[m]) <= 1e-12 * size[m])) return std::nullopt;
    }
    const bool brick = family->pattern().placement == Placement::brick_wall;
    if (family->pattern().is_of_wall()) continue;  // its sites are boundary of every region
    for (std::size_t m = 0; m < n; ++m) {
      const Site v = family->site(static_cast<int>(m));
      for (int parity = 0; parity < 2; ++parity)
        if (!brick || (v.time + v.space + parity) % 2 == 0)
          at_site[{family->values()[m].component, parity}].add(first[m]);
    }
  }
  Check check{.name = "symmetry of L up to a divergence, " + symmetry.name, .region = {}, .value = 0};
  for (const auto& [place, balance] : at_site) check.take(balance, "sites between stencils");
  return check;
}

void NoetherCheck::at(const RegionSystem& region, const RegionSystem::Values& y) {
  for (std::size_t n = 0; n < symmetries_.size(); ++n) {
    if (!invariant_[n].passed() && !forced_) continue;
    Check& check = sums_[n];
    Balance balance = region.noether(y, symmetries_[n], up_to_divergence_[n]);
    // The rounding of given values is allowed for: |sum| ≤ tolerance · absolute + rounding.
    if (balance.relative() > check.tolerance) balance.absolute += region.rounding(y, symmetries_[n]) / check.tolerance;
    if (!check.take(balance, in_words(region.region(), region.origin(), region.stencils()))) continue;
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
