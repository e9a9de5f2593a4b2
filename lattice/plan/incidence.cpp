// SPDX-License-Identifier: MIT
#include "lattice/plan/incidence.hpp"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

#include "lattice/stencil.hpp"

namespace delf {

StencilIncidence StencilIncidence::dense(const StencilPattern& pattern, Dependence dependence) {
  StencilIncidence family{pattern, {}};
  for (int l = 0; l < pattern.size(); ++l)
    for (int m = 0; m < pattern.size(); ++m) family.couplings.push_back({l, m, 0, 0, dependence});
  return family;
}

SystemPattern system_of(int components, std::vector<StencilIncidence> families) {
  SystemPattern system{components, 0, Placement::every_site, {}};
  for (const auto& [pattern, couplings] : families) {
    if (pattern.placement == Placement::brick_wall) system.placement = Placement::brick_wall;
    for (const VertexCoupling& c : couplings)
      system.width = std::max(
          system.width, std::abs(pattern.vertices[c.column_vertex].space - pattern.vertices[c.row_vertex].space));
  }
  const auto shared = std::make_shared<const std::vector<StencilIncidence>>(std::move(families));
  system.equations = [shared](const Lattice& lattice, Site site, int component) {
    std::vector<Coupling> equation;
    if (lattice.is_fixed(site.space)) return equation;
    for (const auto& [pattern, couplings] : *shared)
      for (const VertexCoupling& c : couplings) {
        if (c.row_component != component) continue;
        const Site anchor = site - pattern.vertices[c.row_vertex];
        if (!has_stencil(lattice, pattern, anchor)) continue;
        equation.push_back({anchor + pattern.vertices[c.column_vertex] - site, c.column_component, c.dependence});
      }
    return equation;
  };
  return system;
}

}  // namespace delf
