// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <string>

#include "jets/tables/radau_element.hpp"
#include "jets/tables/table_product.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/methods/space_keys.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/energy.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

int stages(const Problem& p) { return p.parameters.get<int>("scheme.stages"); }

/// No action has these equations, and so Noether's theorem says nothing of the theory's symmetries.
SchemeParts radau_iia_parts(const FieldTheory& theory, const Problem& p) {
  if (theory.constraint())
    throw BadInput("scheme.method",
                   "scheme.method = radau-iia: this version has no constraints at its stages; use scheme.method = "
                   "multisymplectic");
  const StencilTable time = radau_element(stages(p));
  SchemeParts parts = element_parts(theory, product(time, space_table(p)));
  take_to_mesh(parts, theory, p, time);
  parts.symmetries.clear();
  return parts;
}

std::string radau_iia_label(const Problem& p) {
  return fmt::format("Radau IIA, {} stages{}", stages(p), space_label(p));
}

std::optional<int> radau_iia_order(const Problem& p) { return order_in_space(p, 2 * stages(p) - 1); }

std::string radau_iia_words(const Problem& p) {
  return fmt::format("the Radau IIA method of {} stages in time", stages(p)) + space_in_words(p);
}

}  // namespace

extern const MethodEntry radau_iia_method;
const MethodEntry radau_iia_method{
    .name = "radau-iia",
    .formula = "comparator: Runge-Kutta method Radau IIA of scheme.stages, loses energy, is not multisymplectic",
    .build = radau_iia_parts,
    .parameters = {{.key = "scheme.stages",
                    .fallback = 3,
                    .help = "stages s: the order is 2s - 1",
                    .range = {.low = 2, .high = 8}},
                   space_key(),
                   space_order_key(),
                   degree_space_key()},
    .on_meshes = true,
    .label = radau_iia_label,
    .starts = {StartRule::legendre},
    .start = StartRule::legendre,
    .energy = &hamiltonian_of_row,
    .order = radau_iia_order,
    .words = radau_iia_words,
    .sources = {"hairer-wanner-1996"}};

}  // namespace delf
