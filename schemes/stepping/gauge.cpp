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

std::vector<int> undetermined_means(const LatticeSystem& system, const SolvePlan& plan) {
  if (!may_have_gauge(system, plan)) return {};
  std::vector<int> undetermined;
  for (int c = 0; c < system.components(); ++c)
    if (is_balanced(system, plan, c)) undetermined.push_back(c);
  if (undetermined.empty()) return {};
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
  std::erase_if(undetermined, [&](int c) {
    std::vector<double> sums(at(equations.size()), 0.0), terms(sums);
    for (std::size_t n = 0; n < J.size(); ++n) {
      const auto& [equation, unknown] = equations.places()[n];
      if (equations.unknown(unknown).component == c) sums[equation] += J[n], terms[equation] += std::abs(J[n]);
    }
    double all = 0, all_terms = 0;
    for (int n = 0; n < equations.size(); ++n) {
      if (!(std::abs(sums[n]) <= rounding_of_sums * terms[n])) return true;
      if (equations.equation(n).component == c) all += E[n], all_terms += absolute[n];
    }
    return !(std::abs(all) <= rounding_of_sums * all_terms);
  });
  return undetermined;
}

std::string gauge_in_words(const LatticeSystem& system, const std::vector<int>& undetermined) {
  if (static_cast<int>(undetermined.size()) == system.components())
    return "no equation determines the mean of a row, which is that of row 0";
  std::string names;
  for (const int c : undetermined) names += (names.empty() ? "" : ", ") + system.component(c).name;
  return "no equation determines the mean of " + names + " in a row, which is that of row 0";
}

SolvePlan with_gauge(const LatticeSystem& system, SolvePlan plan) {
  const int C = system.components();
  for (const int c : undetermined_means(system, plan)) {
    plan.table.held.resize(at(system.lattice().sites() * C), 0);
    plan.table.held[at(c)] = 1;
    // the equation that is left out is the field's own, whichever its unknown is matched with
    for (std::size_t n = 0; n < plan.table.entries.size(); ++n)
      if (const SolvePlan::Entry& entry = plan.table.entries[n];
          entry.solved && static_cast<int>(n) / plan.table.parities % C == c && entry.equation_component != c)
        plan.table.matched = false;
  }
  return plan;
}

}  // namespace delf
