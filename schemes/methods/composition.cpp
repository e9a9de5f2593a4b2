// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "jets/tables/named_splittings.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/splitting.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

constexpr int usual_order = 4;

/// The splitting of a name, or that of an order.
Splitting splitting_of(const Problem& p) {
  const auto name = p.parameters.maybe<std::string>("scheme.splitting");
  const auto order = p.parameters.maybe<int>("scheme.order");
  if (name) {
    const NamedSplitting& named = *std::ranges::find(named_splittings(), *name, &NamedSplitting::name);
    if (order && *order != named.order)
      throw BadInput("scheme.order",
                     fmt::format("scheme.order = {}: scheme.splitting = {} is of order {}; leave one out", *order,
                                 *name, named.order));
    return named.make();
  }
  Splitting splitting = splitting_of_order(order.value_or(usual_order));
  if (splitting.drifts.empty())
    throw BadInput("scheme.order",
                   fmt::format("scheme.order = {}: compositions are of order 2, 4, 6 or 8; choose one", *order));
  return splitting;
}

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
  const int space_order = p.parameters.get<int>("lattice.space_order");
  const Splitting splitting = splitting_of(p);
  const int pairs = space_order / 2;
  if (space_order % 2 != 0)
    throw BadInput("lattice.space_order",
                   fmt::format("lattice.space_order = {}: wide stencils are of order 2, 4, 6, 8, 10 or 12; choose one",
                               space_order));
  if (p.lattice.sites() < 2 * pairs + 1)
    throw BadInput("lattice.sites",
                   fmt::format("lattice.sites = {}: a stencil of space order {} is {} sites wide; give more",
                               p.lattice.sites(), space_order, 2 * pairs + 1));
  const StencilTable element = pair_element(splitting, pairs);
  // Between sub-steps momenta change by ∂ℓ/∂φ, linear or not.
  SchemeParts parts{{theory.on_table(element, true)}, theory.fields(), theory.symmetries()};
  if (theory.density().nonlinearity() == Nonlinearity::all)
    throw BadInput("theory.name", fmt::format("theory.name = {}: scheme.method = composition takes densities that are "
                                              "nonlinear in phi alone; use scheme.method = multisymplectic",
                                              p.theory));
  for (std::size_t s = 1; s < element.nodes.size(); ++s)
    for (const Component& field : theory.fields())
      parts.components.push_back(
          {fmt::format("{} after {} sub-steps", field.name, s), Role::inner, element.nodes[s], false, field.field});
  return parts;
}

std::vector<NamedScheme> variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  for (int order = 2; order <= highest_splitting_order; order += 2)
    for (int space = 2; space <= 2 * widest_pair; space += 2) {
      schemes.push_back({fmt::format("composition ({},{})", order, space), base});
      schemes.back().problem.parameters["scheme.order"] = order;
      schemes.back().problem.parameters["lattice.space_order"] = space;
      schemes.back().rank = 100 + order + space;
    }
  return schemes;
}

std::vector<std::string> splitting_names() {
  std::vector<std::string> names;
  for (const NamedSplitting& named : named_splittings()) names.push_back(named.name);
  return names;
}

}  // namespace

extern const MethodEntry composition_method;
const MethodEntry composition_method{
    .name = "composition",
    .formula = "sub-steps of scheme.order over pairs of sites of lattice.space_order: explicit, any even order",
    .build = build,
    .parameters = {{.key = "lattice.space_order",
                    .fallback = 4,
                    .help = "order in space: 2, 4, ..., 12",
                    .range = {.low = 2, .high = 2 * widest_pair}},
                   {.key = "scheme.order",
                    .fallback = usual_order,
                    .help = "order in time: 2, 4, 6, 8",
                    .range = {.low = 2, .high = highest_splitting_order},
                    .otherwise = "that of scheme.splitting, or else 4"},
                   {.key = "scheme.splitting",
                    .fallback = "blanes-moan-4",
                    .help = "the sub-steps, by name; the number is their order",
                    .choices = splitting_names(),
                    .otherwise = "leapfrog, blanes-moan-4, blanes-moan-6 or kahan-li-8, by scheme.order"}},
    .starts = {StartRule::exact, StartRule::centred, StartRule::legendre},
    .start = StartRule::legendre,
    .variants = variants};

}  // namespace delf
