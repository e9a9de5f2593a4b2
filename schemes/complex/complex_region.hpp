// SPDX-License-Identifier: MIT
#pragma once
#include <utility>
#include <vector>

#include "schemes/complex/complex_system.hpp"
#include "schemes/verify/region_system.hpp"

namespace delf {

/// All sites of a complex as a region of its row, with its data: regions around some of its sites are checked as those of
/// lattices are. The complex outlives it.
inline Region region_of(const ComplexSystem& system) {
  std::vector<Site> sites;
  for (int s = 0; s < system.complex().sites(); ++s) sites.push_back({.time = 0, .space = s});
  return Region::from_sites(stencils_of(system.row()), std::move(sites),
                            [&complex = system.complex()](Site site) { return !complex.has_equation(site.space); });
}

}  // namespace delf
