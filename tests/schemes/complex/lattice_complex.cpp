// SPDX-License-Identifier: MIT
#include "tests/schemes/complex/lattice_complex.hpp"

#include <algorithm>
#include <vector>

#include "lattice/stencil.hpp"

namespace delf {

namespace {

/// An equation at a row of all its stencils reaches this far; what cancels between them, and less far, is the plan's.
int height(const StencilPattern& pattern) {
  const auto [low, high] = std::ranges::minmax(pattern.vertices, {}, &Site::time);
  return high.time - low.time;
}

}  // namespace

LatticeComplex::LatticeComplex(const Lattice& lattice, const SolvePlan& plan, const StencilTable& table,
                               std::shared_ptr<const BatchDensity> density, double time_step, int rows)
    : sites(lattice.sites()),
      outer(std::max(0, height(table.pattern) - std::min(plan.backward, plan.forward))),
      system(density->components()) {
  for (int j = -outer; j < rows + outer; ++j) {
    const bool is_data = j < plan.history || j >= rows, has_equation = plan.backward <= j && j < rows - plan.forward;
    const SiteRole role = is_data        ? has_equation ? SiteRole::initial : SiteRole::given
                          : has_equation ? SiteRole::free
                                         : SiteRole::final;
    for (int i = 0; i < sites; ++i)
      system.add_site({j * time_step, lattice.position(i), 0, 0}, lattice.is_fixed(i) ? SiteRole::given : role);
  }
  // |Δ| = measure · h k, and the weights of φ_x per length, of φ_xx per its square
  std::vector<TablePoint> points = table.points;
  for (TablePoint& p : points)
    for (std::size_t slot = 0; slot < p.slots.size(); ++slot)
      for (TablePoint::Entry& e : p.slots[slot])
        for (int n = 0; n < slot_powers[slot].space; ++n) e.weight /= lattice.space_step();
  const int family = system.add_family(ComplexSystem::Family(std::move(density), table.pattern.size(), points));
  const int number = system.add_table(family, points);
  const Stencils stencils(lattice, {table.pattern});
  const auto is_there = [&](const Site& s) { return -outer <= s.time && s.time < rows + outer; };
  std::vector<int> vertices;
  for (int j = -outer - 2; j < rows + outer + 2; ++j)
    for (int i = lattice.is_circle() ? 0 : -1; i < sites + (lattice.is_circle() ? 0 : 1); ++i) {
      const auto stencil = stencils.find(0, {j, i});
      if (!stencil || !std::ranges::all_of(stencil->sites, is_there)) continue;
      vertices.clear();
      for (const Site& s : stencil->sites) vertices.push_back(site(s.time, s.space));
      system.add_stencil(family, vertices, number, table.measure * time_step * lattice.space_step(), time_step);
    }
}

}  // namespace delf
