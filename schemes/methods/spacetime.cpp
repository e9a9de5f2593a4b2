// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "jets/spacetime_element.hpp"
#include "lattice/error.hpp"
#include "schemes/field_theory.hpp"
#include "schemes/method_registry.hpp"
#include "schemes/simulation.hpp"

namespace delf {
namespace {

/// Every node of the unit cell carries the d fields: component = node · d + a.
SchemeParts build(const FieldTheory& theory, const Problem& p) {
  if (p.lattice.space() == Space::point)
    throw BadInput("scheme.method", "scheme.method = spacetime: an element of space and time; use lattice.space = circle "
                                    "or interval");
  if (theory.constraint())
    throw BadInput("scheme.method", "scheme.method = spacetime: this version has no constraints at the nodes of elements; "
                                    "use scheme.method = multisymplectic");
  if (p.quadrature != "gauss" && p.quadrature != "lobatto")
    throw BadInput("scheme.quadrature",
                   fmt::format("scheme.quadrature = {}: is gauss or lobatto; choose one", p.quadrature));
  const Element element = spacetime_element(p.degree_time, p.degree_space,
                                            p.quadrature == "gauss" ? TimeQuadrature::gauss : TimeQuadrature::lobatto);
  SchemeParts parts{{theory.on_element(element)}, fields(theory.components()), theory.symmetries()};
  for (std::size_t node = 1; node < element.nodes.size(); ++node)
    for (const Component& field : fields(theory.components()))
      parts.components.push_back({fmt::format("{} at ({:.4g}, {:.4g})", field.name, element.nodes[node].time,
                                              element.nodes[node].space),
                                  Role::inner, element.nodes[node]});
  return parts;
}

}  // namespace

extern const MethodEntry spacetime_method;
const MethodEntry spacetime_method{
    "spacetime", "spacetime Galerkin elements of scheme.degree_time, scheme.degree_space, Lobatto nodes", build};

}  // namespace delf
