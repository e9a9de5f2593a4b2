// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_noether.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/index.hpp"

namespace delf {
namespace {

/// use(its values and its r or its J, ξ) for some stencils.
template <class Use>
ComplexSystem::Visit with_generator(const ComplexSystem& system, const LinearSymmetry& symmetry, const Use& use) {
  return [&system, &symmetry, use, xi = std::vector<double>()](int stencil, const Assembly::Local& here) mutable {
    generator(system.family_of(stencil), symmetry, here.y, xi);
    use(here, xi);
  };
}

}  // namespace

void generator(const ComplexSystem::Family& family, const LinearSymmetry& symmetry, std::span<const double> y,
               std::vector<double>& xi) {
  const std::size_t d = symmetry.shift.size(), of_vertex = at(family.size() / family.vertices());
  xi.assign(y.size(), 0.0);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const std::size_t a = i % of_vertex;
    if (a < d) xi[i] = generator_at(symmetry, a, y.data() + i - a);  // and 0 of a multiplier
  }
}

ComplexNoether::ComplexNoether(std::vector<LinearSymmetry> symmetries, double tolerance, bool forced, bool wrong_sign)
    : symmetries_(std::move(symmetries)), tolerance_(tolerance), forced_(forced), wrong_sign_(wrong_sign) {
  for (const LinearSymmetry& symmetry : symmetries_) {
    invariant_.push_back({.name = "symmetry of L, " + symmetry.name, .region = {}, .tolerance = tolerance});
    sums_.push_back({.name = "Noether, " + symmetry.name, .region = {}, .tolerance = tolerance});
  }
}

/// ∂L/∂yⁱ, or with the planted fault.
double ComplexNoether::r_of(const Assembly::Local& here, std::size_t i) const {
  return wrong_sign_ && here.derivatives.size() > 1 && i == 0 ? -here.derivatives[0] : here.derivatives[i];
}

/// Σ_l ∂L/∂yˡ · ξ(yˡ) of a stencil at random values, the worst of some. Where a density is not defined around 0 (a
/// logarithm of φ), it may be around 1.
Balance ComplexNoether::invariance(const ComplexSystem& system, const LinearSymmetry& symmetry, int family,
                                   std::mt19937_64& random) const {
  constexpr std::size_t samples = 20;
  std::vector<std::int32_t> all, stencils;
  for (int s = 0; s < system.complex().stencils(); ++s)
    if (system.complex().shape_number(s) == family) all.push_back(s);
  for (std::size_t n = 0; n < samples && !all.empty(); ++n) stencils.push_back(all[random() % all.size()]);
  std::sort(stencils.begin(), stencils.end());
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<double> y(system.nodes());
  Balance worst;
  for (const auto& [centre, size] : {std::pair{0.0, 1.0}, {1.0, 0.1}, {1.0, 0.001}}) {
    for (double& value : y) value = centre + size * uniform(random);
    worst = {};
    bool finite = true;
    system.each_residual(
        stencils, y, with_generator(system, symmetry, [&](const Assembly::Local& here, const std::vector<double>& xi) {
          Balance balance;
          for (std::size_t i = 0; i < xi.size(); ++i) balance.add(r_of(here, i) * xi[i]);
          finite = finite && std::isfinite(balance.absolute);
          if (worst.count == 0 || worse(balance.relative(), worst.relative())) worst = balance;
        }));
    if (finite) break;
  }
  return worst;
}

Balance ComplexNoether::sum(const ComplexSystem& system, const ComplexRegion& region, std::span<const double> y,
                            const LinearSymmetry& symmetry) const {
  Balance balance;
  const int d = system.components();
  system.each_residual(
      region.stencils(), y,
      with_generator(system, symmetry, [&](const Assembly::Local& here, const std::vector<double>& xi) {
        for (std::size_t i = 0; i < xi.size(); ++i)
          if (std::ranges::binary_search(region.boundary(), here.places[i] / d)) balance.add(r_of(here, i) * xi[i]);
      }));
  return balance;
}

/// ε Σ |∂²L/∂yˡ∂yᵐ yᵐ ξˡ|: what is left of differences of given values.
double ComplexNoether::rounding(const ComplexSystem& system, const ComplexRegion& region, std::span<const double> y,
                                const LinearSymmetry& symmetry) const {
  double products = 0;
  const int d = system.components();
  system.each_jacobian(
      region.stencils(), y,
      with_generator(system, symmetry, [&](const Assembly::Local& here, const std::vector<double>& xi) {
        for (std::size_t i = 0; i < xi.size(); ++i)
          for (std::size_t m = 0; m < xi.size(); ++m)
            if (std::ranges::binary_search(region.boundary(), here.places[i] / d))
              products += std::abs(here.derivatives[i * xi.size() + m] * here.y[m] * xi[i]);
      }));
  return std::numeric_limits<double>::epsilon() * products;
}

void ComplexNoether::look_at(const ComplexSystem& system, const ComplexRegion& region, std::span<const double> y,
                             const std::string& where, std::mt19937_64& random) {
  for (std::size_t n = 0; n < symmetries_.size(); ++n) {
    Check& invariant = invariant_[n];
    if (invariant.samples == 0) {
      for (int family = 0; family < system.families(); ++family)
        invariant.take(invariance(system, symmetries_[n], family, random), "random values of each kind of stencil");
      if (!invariant.passed())
        invariant.failure = fmt::format(
            "{} is not a symmetry: along it the Lagrangian changes by {:.2g} of its terms. Noether's theorem owes "
            "nothing for it{}.",
            symmetries_[n].name, invariant.value, forced_ ? ", and the sums below were asked for all the same" : "");
    }
    if (!invariant.passed() && !forced_) continue;
    Balance balance = sum(system, region, y, symmetries_[n]);
    // The rounding of given values is allowed for: |sum| ≤ tolerance · absolute + rounding.
    if (balance.relative() > tolerance_) balance.absolute += rounding(system, region, y, symmetries_[n]) / tolerance_;
    Check& check = sums_[n];
    if (!check.take(balance, where)) continue;
    check.failure =
        fmt::format("What flows into {} is not what flows out: {:.2g} of the momenta of {} is left. {}", where,
                    check.value, symmetries_[n].name,
                    invariant.passed() ? "The Lagrangian has this symmetry, so the field equations do not hold there."
                                       : "The Lagrangian does not have this symmetry.");
  }
}

std::vector<Check> ComplexNoether::checks() const {
  std::vector<Check> result;
  for (std::size_t n = 0; n < symmetries_.size(); ++n) {
    if (invariant_[n].samples > 0) result.push_back(invariant_[n]);
    if (sums_[n].samples > 0) result.push_back(sums_[n]);
  }
  return result;
}

}  // namespace delf
