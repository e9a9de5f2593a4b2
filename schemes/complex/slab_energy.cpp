// SPDX-License-Identifier: MIT
#include "schemes/complex/slab_energy.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"
#include "schemes/complex/spacetime_complex.hpp"

namespace delf {
namespace {

/// The sites row after row, each in the order of x; empty if they do not lie in rows of as many.
std::vector<std::vector<int>> rows_of(const StencilList& list) {
  constexpr double rounding = 1e-12;
  std::vector<int> order;
  double longest = 0;
  for (const auto& site : list.sites)
    order.push_back(static_cast<int>(order.size())), longest = std::max(longest, std::abs(site.position[0]));
  std::ranges::sort(order, {}, [&](int s) { return list.sites[s].position[0]; });
  std::vector<std::vector<int>> rows;
  double t = 0;
  for (const int s : order) {
    const double here = list.sites[s].position[0];
    if (rows.empty() || here - t > rounding * longest) rows.emplace_back();
    rows.back().push_back(s), t = here;
  }
  for (auto& row : rows) {
    if (row.size() < 2 || row.size() != rows.front().size()) return {};
    std::ranges::sort(row, {}, [&](int s) { return list.sites[s].position[1]; });
  }
  return rows;
}

}  // namespace

std::vector<SlabEnergy> slab_energies(const StencilList& list, const std::shared_ptr<const BatchDensity>& density,
                                      std::span<const double> y) {
  if (list.coordinates() > 2 || density->slots() > 3) return {};
  const auto rows = rows_of(list);
  if (rows.size() < 2) return {};
  StencilList cells{list.sites, {}, list.circumference};
  const std::size_t count = rows.front().size(), in_slab = list.circumference > 0 ? count : count - 1;
  for (std::size_t j = 0; j + 1 < rows.size(); ++j)
    for (std::size_t i = 0; i < in_slab; ++i) {
      const std::size_t next = (i + 1) % count;
      cells.stencils.push_back({"rectangle-symmetric", {rows[j][i], rows[j + 1][i], rows[j + 1][next], rows[j][next]}});
    }
  if (find_fault(cells)) return {};  // rows that turn or cross
  const ComplexSystem system = spacetime_complex(cells, density);
  std::vector<SlabEnergy> slabs(rows.size() - 1);
  const auto time = [&](std::size_t j) { return list.sites[rows[j].front()].position[0]; };
  const std::vector<double> energies = system.energies(y);
  for (std::size_t n = 0; n < energies.size(); ++n) slabs[n / in_slab].energy += energies[n];
  for (std::size_t j = 0; j < slabs.size(); ++j) slabs[j].time = time(j + 1), slabs[j].energy /= time(j + 1) - time(j);
  return slabs;
}

}  // namespace delf
