// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "jets/tables/pair_element.hpp"
#include "jets/tables/splitting.hpp"
#include "lattice/error.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"

namespace delf {
namespace {

/// The row after s sub-steps carries the d fields: component = s · d + a.
SchemeParts build(const FieldTheory& theory, const Problem& p) {
  if (!p.lattice.is_circle())
    throw BadInput("lattice.space",
                   "scheme.method = composition: wide stencils have no walls in this version; use "
                   "lattice.space = circle");
  if (theory.constraint())
    throw BadInput("scheme.method",
                   "scheme.method = composition: this version has no constraints between sub-steps; "
                   "use scheme.method = multisymplectic");
  const Splitting splitting = splitting_of_order(p.order);
  if (splitting.drifts.empty())
    throw BadInput("scheme.order",
                   fmt::format("scheme.order = {}: compositions are of order 2, 4, 6 or 8; choose one", p.order));
  const int pairs = p.space_order / 2;
  if (p.space_order % 2 != 0 || pairs < 1 || pairs > widest_pair)
    throw BadInput("lattice.space_order",
                   fmt::format("lattice.space_order = {}: wide stencils are of order 2, 4, 6, 8, 10 or 12; choose one",
                               p.space_order));
  if (p.lattice.sites() < 2 * pairs + 1)
    throw BadInput("lattice.sites",
                   fmt::format("lattice.sites = {}: a stencil of space order {} is {} sites wide; give more",
                               p.lattice.sites(), p.space_order, 2 * pairs + 1));
  const Element element = pair_element(splitting, pairs);
  SchemeParts parts{{theory.on_element(element)}, fields(theory.components()), theory.symmetries()};
  if (!parts.families[0]->nodal_kernel())
    throw BadInput("theory.name", fmt::format("theory.name = {}: scheme.method = composition takes densities that are "
                                              "nonlinear in phi alone; use scheme.method = multisymplectic",
                                              p.theory));
  for (std::size_t s = 1; s < element.nodes.size(); ++s)
    for (const Component& field : fields(theory.components()))
      parts.components.push_back({fmt::format("{} after {} sub-steps", field.name, s), Role::inner, element.nodes[s]});
  return parts;
}

std::vector<NamedScheme> variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  for (int order = 2; order <= highest_splitting_order; order += 2)
    for (int space = 2; space <= 2 * widest_pair; space += 2) {
      schemes.push_back({fmt::format("composition ({},{})", order, space), base});
      schemes.back().problem.order = order;
      schemes.back().problem.space_order = space;
    }
  return schemes;
}

}  // namespace

extern const MethodEntry composition_method;
const MethodEntry composition_method{
    "composition", "sub-steps of scheme.order over pairs of sites of lattice.space_order: explicit, any even order",
    build, variants};

}  // namespace delf
