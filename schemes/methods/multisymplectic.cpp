// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/unknown_name.hpp"

namespace delf {
namespace {

/// What a wall does to a scheme that its stencils cannot see.
void check_walls(const Problem& p, const StencilFamily& family) {
  const auto [least, most] = std::ranges::minmax(family.pattern().vertices, {}, &Site::space);
  const int width = most.space - least.space;
  if (p.lattice.space() == Space::point ? width > 0 : width == 0)
    throw BadInput("lattice.stencil",
                   width > 0 ? fmt::format("lattice.stencil = {}: has sites side by side, and on lattice.space = point "
                                           "there is one; use midpoint, trapezoidal or vertex",
                                           p.stencil)
                             : fmt::format("lattice.stencil = {}: is for mechanics and couples no neighbours; use "
                                           "rectangle-symmetric, or lattice.space = point",
                                           p.stencil));
  if (!p.lattice.is_circle() && width > 1)
    throw BadInput(
        "lattice.stencil",
        fmt::format("lattice.stencil = {}: on an interval stencils wider than a cell leave part of the cells "
                    "at the walls out of the action, and the error there does not vanish with k; use "
                    "triangle, rectangle or rectangle-symmetric, or lattice.space = circle",
                    p.stencil));
}

SchemeParts build(const FieldTheory& theory, const Problem& p) {
  SchemeParts parts{{theory.variational(p.stencil)},
                    theory.fields(),
                    theory.symmetries()};
  if (!parts.families[0]) throw unknown_name("lattice.stencil", p.stencil, stencil_names_and_aliases());
  check_walls(p, *parts.families[0]);
  for (auto& term : theory.at_walls(p.stencil, p.lattice)) parts.families.push_back(std::move(term));
  if (auto constraint = theory.constraint()) {
    parts.families.push_back(std::move(constraint));
    parts.components.push_back({"lambda", Role::multiplier, {}});
  }
  return parts;
}

std::vector<NamedScheme> variants(const Problem& base) {
  std::vector<NamedScheme> schemes;
  for (const NamedFormula& stencil : stencils()) {
    schemes.push_back({stencil.name, base});
    schemes.back().problem.stencil = stencil.name;
    schemes.back().rank = stencil.name == "rectangle-symmetric" ? 1 : 0;
  }
  return schemes;
}

}  // namespace

extern const MethodEntry multisymplectic_method;
const MethodEntry multisymplectic_method{.name = "multisymplectic",
                                         .formula = "discrete Euler-Lagrange field equations of lattice.stencil (5.2)",
                                         .build = build,
                                         .reads_stencil = true,
                                         .label = [](const Problem& p) { return p.stencil; },
                                         .variants = variants};

}  // namespace delf
