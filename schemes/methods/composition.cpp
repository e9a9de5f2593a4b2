// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "jets/tables/named_splittings.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/splitting.hpp"
#include "lattice/error.hpp"
#include "schemes/declared.hpp"
#include "schemes/methods/pair_parts.hpp"

namespace delf {
namespace {

constexpr int usual_time_order = 4;

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
  Splitting splitting = splitting_of_order(order.value_or(usual_time_order));
  if (splitting.drifts.empty())
    throw BadInput("scheme.order",
                   fmt::format("scheme.order = {}: compositions are of order 2, 4, 6 or 8; choose one", *order));
  return splitting;
}

/// The parameter, without a value of its own where there are no pairs.
Parameter unless_given(Parameter parameter) {
  parameter.otherwise = "4, on a circle or an interval";
  return parameter;
}

/// Mechanics, and cells that have a space of their own.
bool has_no_pairs(const Problem& p) { return p.lattice.space() == Space::point || p.lattice.space() == Space::mesh; }

SchemeParts composition_parts(const FieldTheory& theory, const Problem& p) {
  if (has_no_pairs(p)) {
    if (p.parameters.has("lattice.space_order"))
      throw BadInput("lattice.space_order",
                     "lattice.space_order: is for lattice.space = circle or interval; leave it out");
    return pair_parts(theory, p, splitting_of(p), {});
  }
  const int pairs = pairs_of_order(p, "lattice.space_order", space_order_of(p));
  return pair_parts(theory, p, splitting_of(p), pair_weights(pairs));
}

std::vector<NamedScheme> composition_variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  if (has_no_pairs(base)) {
    for (int order = 2; order <= highest_splitting_order; order += 2) {
      schemes.push_back({fmt::format("composition {}", order), base});
      schemes.back().problem.parameters["scheme.order"] = order;
    }
    return schemes;
  }
  for (int order = 2; order <= highest_splitting_order; order += 2)
    for (int space = 2; space <= 12; space += 2) {
      schemes.push_back({fmt::format("composition ({},{})", order, space), base});
      schemes.back().problem.parameters["scheme.order"] = order;
      schemes.back().problem.parameters["lattice.space_order"] = space;
      schemes.back().rank = 100 + order + space;
    }
  return schemes;
}

/// The lower one of the orders in space and in time.
std::optional<int> composition_order(const Problem& p) {
  const auto name = p.parameters.maybe<std::string>("scheme.splitting");
  const int time = name ? std::ranges::find(named_splittings(), *name, &NamedSplitting::name)->order
                        : p.parameters.maybe<int>("scheme.order").value_or(usual_time_order);
  if (p.lattice.space() == Space::point) return time;
  return std::min(time, p.lattice.space() == Space::mesh ? 2 : space_order_of(p));
}

/// The sources of the splitting, by its name or by the order.
std::vector<std::string> sources_of_splitting(const Problem& p) {
  const auto name = p.parameters.maybe<std::string>("scheme.splitting");
  const std::vector<double> kicks = splitting_of(p).kicks;
  for (const NamedSplitting& named : named_splittings())
    if (name ? *name == named.name : named.make().kicks == kicks) return named.sources;
  return {};
}

std::string composition_words(const Problem& p) {
  const auto name = p.parameters.maybe<std::string>("scheme.splitting");
  const int order = p.parameters.maybe<int>("scheme.order").value_or(usual_time_order);
  std::string words = name ? fmt::format("the explicit symplectic splitting {} in time", *name)
                           : fmt::format("an explicit symplectic splitting of order {} in time", order);
  if (p.lattice.mesh()) words += " with linear finite elements of lumped mass in space";
  else if (!has_no_pairs(p)) words += fmt::format(" with central differences of order {} in space", space_order_of(p));
  return words;
}

}  // namespace

extern const EnergyEntry composition_energy;
extern const MethodEntry composition_method;
const MethodEntry composition_method{
    .name = "composition",
    .formula = "sub-steps of scheme.order over pairs of sites of lattice.space_order: explicit, any even order",
    .build = composition_parts,
    .parameters = {unless_given(space_order_parameter()),
                   {.key = "scheme.order",
                    .fallback = usual_time_order,
                    .help = "order in time: 2, 4, 6, 8",
                    .range = {.low = 2, .high = highest_splitting_order},
                    .otherwise = "that of scheme.splitting, or else 4"},
                   {.key = "scheme.splitting",
                    .fallback = "blanes-moan-4",
                    .help = "the sub-steps, by name; the number is their order",
                    .choices = names_of(named_splittings()),
                    .otherwise = "leapfrog, blanes-moan-4, blanes-moan-6 or kahan-li-8, by scheme.order"}},
    .on_meshes = true,
    .starts = {StartRule::exact, StartRule::centred, StartRule::legendre},
    .start = StartRule::legendre,
    .own_energy = &composition_energy,
    .variants = composition_variants,
    .order = composition_order,
    .words = composition_words,
    .sources = {"mclachlan-quispel-2002", "fornberg-1988"},
    .further_sources = sources_of_splitting};

}  // namespace delf
