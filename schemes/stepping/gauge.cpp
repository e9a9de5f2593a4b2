// SPDX-License-Identifier: MIT
#include "schemes/stepping/gauge.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "lattice/index.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/system/slab_extent.hpp"

namespace delf {
namespace {

/// A sum of this part of its terms is rounding.
constexpr double rounding_of_sums = 1e-11;

/// A component of fields alone, on a space without walls that keep values.
bool may_have_gauge(const LatticeSystem& system, const SolvePlan& plan) {
  const Lattice& lattice = system.lattice();
  const bool is_free = lattice.is_circle() || (lattice.space() == Space::interval && lattice.left() == Wall::natural &&
                                               lattice.right() == Wall::natural);
  return is_free && plan.table.regular && system.placement() == Placement::every_site &&
         std::ranges::all_of(system.all_components(), [](const Component& c) { return c.role == Role::field; });
}

/// The entries of one equation at the row that it is solved for add up to nothing: most theories have their mass there.
bool is_balanced(const LatticeSystem& system, const SolvePlan& plan, int component) {
  const Site site{0, system.lattice().sites() / 2};
  const int row = plan.shift(site.space, component) + plan.offset(site.space, component);
  double sum = 0, absolute = 0;
  for (const Coefficient& c : system.linearised(site, component))
    if (c.offset.time == row && c.component == component) sum += c.value, absolute += std::abs(c.value);
  return absolute > 0 && std::abs(sum) <= rounding_of_sums * absolute;
}

}  // namespace

bool has_undetermined_means(const LatticeSystem& system, const SolvePlan& plan) {
  if (!may_have_gauge(system, plan)) return false;
  for (int c = 0; c < system.components(); ++c)
    if (!is_balanced(system, plan, c)) return false;
  const SlabExtent extent = slab_extent(system, plan);
  const int past = std::max(plan.history, extent.below + 1);
  const std::size_t size = at(system.lattice().sites() * system.components());
  const Assembly equations(system, Assembly::slab(plan, 0, past, extent.above, 0));
  SectionRing ring(past + extent.above + 1, size);
  std::mt19937 random(5489);
  std::uniform_real_distribution<double> value(-1, 1);
  for (std::int64_t row = -past; row <= extent.above; ++row)
    std::generate_n(ring.row(row), size, [&] { return value(random); });
  std::vector<double> J, E, absolute;
  equations.jacobian(ring, 0, J);
  equations.residual(ring, 0, E, &absolute);
  for (int c = 0; c < system.components(); ++c) {
    std::vector<double> sums(at(equations.size()), 0.0), terms(sums);
    for (std::size_t n = 0; n < J.size(); ++n) {
      const auto& [equation, unknown] = equations.places()[n];
      if (equations.unknown(unknown).component == c) sums[equation] += J[n], terms[equation] += std::abs(J[n]);
    }
    double all = 0, all_terms = 0;
    for (int n = 0; n < equations.size(); ++n) {
      if (!(std::abs(sums[n]) <= rounding_of_sums * terms[n])) return false;
      if (equations.equation(n).component == c) all += E[n], all_terms += absolute[n];
    }
    if (!(std::abs(all) <= rounding_of_sums * all_terms)) return false;
  }
  return true;
}

SolvePlan with_gauge(const LatticeSystem& system, SolvePlan plan) {
  if (!has_undetermined_means(system, plan)) return plan;
  plan.table.held.assign(at(system.lattice().sites()), 0);
  plan.table.held.front() = 1;
  return plan;
}

}  // namespace delf
