// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "jets/tables/spacetime_element.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

struct SpacetimeKeys {
  explicit SpacetimeKeys(const Problem& p)
      : degree_time(p.parameters.get<int>("scheme.degree_time")),
        degree_space(p.parameters.get<int>("scheme.degree_space")),
        quadrature(p.parameters.get<std::string>("scheme.quadrature")) {}
  int degree_time, degree_space;
  std::string quadrature;
};

SchemeParts spacetime_parts(const FieldTheory& theory, const Problem& p) {
  if (p.lattice.space() == Space::point)
    throw BadInput("scheme.method",
                   "scheme.method = spacetime: an element of space and time; use lattice.space = circle "
                   "or interval");
  if (theory.constraint())
    throw BadInput("scheme.method",
                   "scheme.method = spacetime: this version has no constraints at the nodes of elements; "
                   "use scheme.method = multisymplectic");
  const SpacetimeKeys keys(p);
  return element_parts(theory,
                       spacetime_element(keys.degree_time, keys.degree_space,
                                         keys.quadrature == "gauss" ? TimeQuadrature::gauss : TimeQuadrature::lobatto));
}

/// Degrees of which the nodal orders in time and space, 2p_t and p_x + 2, go together.
std::vector<NamedScheme> spacetime_variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  for (const auto& [time, space] : {std::pair{1, 1}, {1, 2}, {2, 2}, {2, 3}, {3, 4}, {4, 6}})
    for (const char* quadrature : {"gauss", "lobatto"}) {
      schemes.push_back({fmt::format("spacetime ({},{}) {}", time, space, quadrature), base});
      ParameterValues& parameters = schemes.back().problem.parameters;
      parameters["scheme.degree_time"] = time;
      parameters["scheme.degree_space"] = space;
      parameters["scheme.quadrature"] = quadrature;
      schemes.back().nodes = space;
      schemes.back().rank = quadrature == std::string_view("gauss") ? 10 + 2 * time : 0;
    }
  return schemes;
}

std::string spacetime_label(const Problem& p) {
  const SpacetimeKeys keys(p);
  return fmt::format("spacetime of degrees {} and {}, {}", keys.degree_time, keys.degree_space, keys.quadrature);
}

std::string spacetime_words(const Problem& p) {
  const SpacetimeKeys keys(p);
  return fmt::format(
      "continuous Galerkin elements of spacetime, of degree {} in time and {} in space, with Lobatto nodes and "
      "{} quadrature in time",
      keys.degree_time, keys.degree_space, keys.quadrature);
}

}  // namespace

extern const MethodEntry spacetime_method;
const MethodEntry spacetime_method{
    .name = "spacetime",
    .formula = "spacetime Galerkin elements of scheme.degree_time, scheme.degree_space, Lobatto nodes",
    .build = spacetime_parts,
    .parameters = {{.key = "scheme.degree_time",
                    .fallback = 2,
                    .help = "degree of an element in time",
                    .range = {.low = 1, .high = 12}},
                   {.key = "scheme.degree_space",
                    .fallback = 2,
                    .help = "degree of an element in space",
                    .range = {.low = 1, .high = 12}},
                   {.key = "scheme.quadrature",
                    .fallback = "gauss",
                    .help = "the quadrature in time",
                    .choices = {"gauss", "lobatto"}}},
    .label = spacetime_label,
    .starts = {StartRule::exact, StartRule::centred, StartRule::legendre},
    .start = StartRule::legendre,
    .energy = &hamiltonian_of_row,
    .variants = spacetime_variants,
    .words = spacetime_words,
    .sources = {"marsden-patrick-shkoller-1998", "hall-leok-2015"}};

}  // namespace delf
