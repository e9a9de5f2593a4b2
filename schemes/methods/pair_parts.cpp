// SPDX-License-Identifier: MIT
#include "schemes/methods/pair_parts.hpp"

#include <fmt/format.h>

#include <utility>

#include "jets/tables/mirror_table.hpp"
#include "jets/tables/pair_element.hpp"
#include "lattice/error.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

Parameter space_order_parameter() {
  return {.key = "lattice.space_order",
          .fallback = 4,
          .help = "order in space: 2, 4, ..., 20",
          .range = {.low = 2, .high = 2 * widest_pair}};
}

int pairs_of_order(const Problem& p, const char* key, int order) {
  if (order % 2 != 0 || order < 2 || order > 2 * widest_pair)
    throw BadInput(
        key, fmt::format("{} = {}: wide stencils are of order 2, 4, ..., {}; choose one", key, order, 2 * widest_pair));
  if (p.lattice.sites() < order + 1)
    throw BadInput("lattice.sites",
                   fmt::format("lattice.sites = {}: a stencil of space order {} is {} sites wide; give more",
                               p.lattice.sites(), order, order + 1));
  return order / 2;
}

std::vector<StencilTable> at_both_walls(const StencilTable& table, const Lattice& lattice) {
  if (lattice.space() != Space::interval) return {};
  const auto mirror = [](Wall wall) { return wall == Wall::fixed ? Mirror::odd : Mirror::even; };
  return {mirror_table(table, Placement::left_mirror, mirror(lattice.left())).table,
          mirror_table(table, Placement::right_mirror, mirror(lattice.right())).table};
}

SchemeParts pair_parts(const FieldTheory& theory, const Problem& p, const Splitting& splitting,
                       const std::vector<double>& pairs) {
  if (p.lattice.space() == Space::point)
    throw BadInput("lattice.space", fmt::format("scheme.method = {}: wide stencils have no neighbours at a point; use "
                                                "lattice.space = circle or interval",
                                                p.method));
  if (theory.constraint())
    throw BadInput("scheme.method",
                   fmt::format("scheme.method = {}: this version has no constraints between sub-steps; "
                               "use scheme.method = multisymplectic",
                               p.method));
  if (theory.density().nonlinearity() == Nonlinearity::all)
    throw BadInput("theory.name", fmt::format("theory.name = {}: scheme.method = {} takes densities that are "
                                              "nonlinear in phi alone; use scheme.method = multisymplectic",
                                              p.theory, p.method));
  const StencilTable time = splitting_element(splitting), space = pair_space(pairs), element = product(time, space);
  // Between sub-steps momenta change by ∂ℓ/∂φ, linear or not.
  SchemeParts parts{{theory.on_table(element, true)}, theory.fields(), theory.symmetries(), splitting.processor, {}};
  for (const StencilTable& at_wall : at_both_walls(space, p.lattice)) {
    StencilTable term = product(time, at_wall);
    term.pattern.placement = at_wall.pattern.placement;
    parts.families.push_back(theory.on_table(std::move(term), true));
  }
  for (std::size_t s = 1; s < element.nodes.size(); ++s)
    for (const Component& field : theory.fields())
      parts.components.push_back(
          {fmt::format("{} after {} sub-steps", field.name, s), Role::inner, element.nodes[s], false, field.field});
  return parts;
}

}  // namespace delf
