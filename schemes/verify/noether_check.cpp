// SPDX-License-Identifier: MIT
#include "schemes/verify/noether_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "lattice/index.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/verify/drawn_region.hpp"

namespace delf {

NoetherCheck::NoetherCheck(const LatticeSystem& system, std::vector<LinearSymmetry> symmetries, double tolerance,
                           bool forced, std::uint64_t seed)
    : symmetries_(std::move(symmetries)), forced_(forced) {
  std::mt19937_64 random(seed);
  const bool repeats = system.lattice().space() != Space::mesh;
  for (const LinearSymmetry& symmetry : symmetries_) {
    invariant_.push_back(invariance(system, symmetry, random));
    invariant_.back().tolerance = tolerance;
    up_to_divergence_.push_back(false);
    if (!invariant_.back().passed() && repeats) {
      Check cancels = divergence(system, symmetry, random);
      cancels.tolerance = tolerance;
      up_to_divergence_.back() = cancels.passed();
      if (cancels.passed()) invariant_.back() = cancels;
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
/// 1 − φ_t² + φ_x²), it may be around 1, or where derivatives are small; weights of listed stencils' own may have h in them.
void draw(const StencilFamily& family, const Cell& cell, std::mt19937_64& random, std::vector<double>& y,
          std::vector<double>& r) {
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<double> unit(y.size());
  for (double& value : unit) value = uniform(random);
  const double small = 0.1 * std::min(cell.time_step, cell.space_step);
  for (const auto& [centre, size] : {std::pair{0.0, 1.0}, {1.0, 0.1}, {0.0, small}, {1.0, small}, {1.0, 0.001}}) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = centre + size * unit[i];
    family.residual(cell, y, r);
    if (std::ranges::all_of(r, [](double x) { return std::isfinite(x); })) return;
  }
}

}  // namespace

Check NoetherCheck::invariance(const LatticeSystem& system, const LinearSymmetry& symmetry, std::mt19937_64& random) {
  constexpr int jets = 20;
  Check check{.name = "symmetry of L, " + symmetry.name, .region = {}, .value = 0};
  std::vector<double> y, r, xi;
  for (const auto& family : system.families())
    for (int n = 0; n < jets; ++n) {
      y.resize(family->size());
      r.resize(y.size());
      const int anchor = static_cast<int>(random() % static_cast<std::uint64_t>(system.anchors(*family)));
      const double x = family->listed() ? 0 : system.lattice().position(anchor);
      const Cell cell{system.time_step(), system.lattice().space_step(), 0, x, anchor};
      draw(*family, cell, random, y, r);
      generator(system, *family, symmetry, y, xi);
      Balance balance;
      for (std::size_t i = 0; i < r.size(); ++i) balance.add(r[i] * xi[i]);
      check.take(balance, fmt::format("{} random jets of each stencil family", jets));
    }
  return check;
}

/// δL is a divergence if its own field equations hold for every field,
///
///     Σ_Δ ∂δL_Δ/∂yᵐ = Σ_Δ Σ_i ∂rⁱ/∂yᵐ ξⁱ + rⁱ ∂ξⁱ/∂yᵐ = 0,
///
/// over the stencils that meet at a site in the middle of the lattice, on brick walls one of either parity.
Check NoetherCheck::divergence(const LatticeSystem& system, const LinearSymmetry& symmetry, std::mt19937_64& random) {
  constexpr int fields = 5;
  Check check{.name = "symmetry of L up to a divergence, " + symmetry.name, .region = {}, .value = 0};
  for (int sample = 0; sample < fields; ++sample)
    for (const double centre : {0.0, 1.0}) {  // where a density is not defined around 0, it may be around 1
      bool finite = true;
      for (int c = 0; c < system.components(); ++c)
        for (int row = 0; row < 2; ++row) {
          const Balance balance =
              change_at(system, {row, system.lattice().sites() / 2, 0}, c, symmetry, centre, random);
          finite = finite && std::isfinite(balance.absolute);
          if (finite) check.take(balance, "random fields");
        }
      if (finite) break;
    }
  return check;
}

Balance NoetherCheck::change_at(const LatticeSystem& system, Site site, int component, const LinearSymmetry& symmetry,
                                double centre, std::mt19937_64& random) {
  const Lattice& lattice = system.lattice();
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double size = centre == 0 ? 1 : 0.1 * std::min(system.time_step(), lattice.space_step());
  std::map<std::tuple<int, int, int>, double> field;
  Balance balance;
  for (const auto& family : system.families())
    for (int m = 0; m < family->size(); ++m) {
      if (family->values()[m].component != component) continue;
      const Site vertex = family->site(m), anchor{site.time - vertex.time, lattice.home(site.space - vertex.space), 0};
      if (!system.has_stencil(*family, anchor.time, anchor.space)) continue;
      const std::size_t n = family->size(), at = delf::at(m);
      std::vector<double> y(n), r(n), J(n * n), xi(n), moved(n);
      for (std::size_t i = 0; i < n; ++i) {
        const Site v = family->site(static_cast<int>(i));
        const auto [value, fresh] = field.try_emplace(
            {anchor.time + v.time, lattice.home(anchor.space + v.space), family->values()[i].component});
        if (fresh) value->second = centre + size * uniform(random);
        y[i] = value->second;
      }
      const Cell cell{system.time_step(), lattice.space_step(), 0, lattice.position(anchor.space)};
      family->residual(cell, y, r);
      family->jacobian(cell, y, J);
      generator(system, *family, symmetry, y, xi);
      y[at] += 1;
      generator(system, *family, symmetry, y, moved);
      for (std::size_t i = 0; i < n; ++i) balance.add(J[i * n + at] * xi[i]), balance.add(r[i] * (moved[i] - xi[i]));
    }
  return balance;
}

void NoetherCheck::at(const RegionSystem& region, const RegionSystem::Values& y, const std::string& where) {
  for (std::size_t n = 0; n < symmetries_.size(); ++n) {
    if (!invariant_[n].passed() && !forced_) continue;
    Check& check = sums_[n];
    Balance balance = region.noether(y, symmetries_[n], up_to_divergence_[n]);
    // The rounding of given values is allowed for: |sum| ≤ tolerance · absolute + rounding.
    if (balance.relative() > check.tolerance) balance.absolute += region.rounding(y, symmetries_[n]) / check.tolerance;
    if (!check.take(balance, where)) continue;
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
      const RegionSystem here(drawer.system(), *region, rows.first_row, rows.monodromy);
      at(here, here.restricted(rows), in_words(*region, here.origin(), here.stencils()));
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
