// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <utility>

#include "jets/tables/spacetime_element.hpp"
#include "lattice/error.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"

namespace delf {
namespace {

/// Every node of the unit cell carries the d fields: component = node · d + a.
SchemeParts build(const FieldTheory& theory, const Problem& p) {
  if (p.lattice.space() == Space::point)
    throw BadInput("scheme.method",
                   "scheme.method = spacetime: an element of space and time; use lattice.space = circle "
                   "or interval");
  if (theory.constraint())
    throw BadInput("scheme.method",
                   "scheme.method = spacetime: this version has no constraints at the nodes of elements; "
                   "use scheme.method = multisymplectic");
  if (p.quadrature != "gauss" && p.quadrature != "lobatto")
    throw BadInput("scheme.quadrature",
                   fmt::format("scheme.quadrature = {}: is gauss or lobatto; choose one", p.quadrature));
  const Element element = spacetime_element(p.degree_time, p.degree_space,
                                            p.quadrature == "gauss" ? TimeQuadrature::gauss : TimeQuadrature::lobatto);
  SchemeParts parts{{theory.on_element(element)}, fields(theory.components()), theory.symmetries()};
  for (std::size_t node = 1; node < element.nodes.size(); ++node)
    for (const Component& field : fields(theory.components()))
      parts.components.push_back(
          {fmt::format("{} at ({:.4g}, {:.4g})", field.name, element.nodes[node].time, element.nodes[node].space),
           Role::inner, element.nodes[node]});
  return parts;
}

/// Degrees of which the nodal orders in time and space, 2p_t and p_x + 2, go together.
std::vector<NamedScheme> variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  for (const auto& [time, space] : {std::pair{1, 1}, {1, 2}, {2, 2}, {2, 3}, {3, 4}, {4, 6}})
    for (const char* quadrature : {"gauss", "lobatto"}) {
      schemes.push_back({fmt::format("spacetime ({},{}) {}", time, space, quadrature), base});
      Problem& p = schemes.back().problem;
      p.degree_time = time, p.degree_space = space, p.quadrature = quadrature;
    }
  return schemes;
}

}  // namespace

extern const MethodEntry spacetime_method;
const MethodEntry spacetime_method{
    "spacetime", "spacetime Galerkin elements of scheme.degree_time, scheme.degree_space, Lobatto nodes", build,
    variants};

}  // namespace delf
