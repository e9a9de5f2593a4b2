// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/table_product.hpp"
#include "jets/tables/time_element.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/methods/space_keys.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/energy.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

struct Keys {
  explicit Keys(const Problem& p)
      : basis_name(p.parameters.get<std::string>("scheme.basis")),
        quadrature(p.parameters.get<std::string>("scheme.quadrature")),
        functions(p.parameters.get<int>("scheme.functions")),
        points(p.parameters.maybe<int>("scheme.points").value_or(functions - 1)) {
    basis = std::ranges::find(named_line_bases(), basis_name, &NamedLineBasis::name)->make(functions);
    const auto given = p.parameters.maybe<std::string>("scheme.continuity");
    continuity = (given ? *given == "shared" : basis.has_end_nodes()) ? Continuity::shared : Continuity::multipliers;
  }
  LineRule rule() const {
    const auto named = std::ranges::find(named_line_rules(), quadrature, &NamedLineRule::name);
    if (points < named->fewest)
      throw BadInput("scheme.points", fmt::format("scheme.points = {}: the rule {} has {} points at least; raise "
                                                  "scheme.points",
                                                  points, quadrature, named->fewest));
    return named->make(points);
  }

  std::string basis_name, quadrature;
  int functions, points;
  LineBasis basis;
  Continuity continuity;
};

SchemeParts build(const FieldTheory& theory, const Problem& p) {
  if (theory.constraint())
    throw BadInput("scheme.method",
                   "scheme.method = cgvi: this version has no constraints at the nodes of elements; use scheme.method "
                   "= multisymplectic");
  const Keys keys(p);
  const StencilTable space = space_table(p);
  std::optional<Traces> traces;
  // r⁺ = φ(0) and r⁻ = φ(1)
  if (keys.continuity == Continuity::multipliers) traces = {keys.basis.values(0), keys.basis.values(1), space};
  return element_parts(theory, product(time_element(keys.basis, keys.rule(), keys.continuity), space), traces);
}

/// H(q, p) at the newest row, p = ∂L/∂q of what lies below it: an observable of the scheme's own phase space.
EnergyMomentum energy(const RowsInTime& rows) {
  if (rows.system.lattice().space() != Space::point) return element_energy(rows);
  const std::vector<double> p = momenta(rows.system, rows.rows, rows.newest, Side::below);
  std::vector<double> q;
  for (int a = 0; a < rows.theory.components(); ++a) q.push_back(rows.rows(rows.newest, 0, a));
  return {hamiltonian(rows.theory.density(), q, p, static_cast<double>(rows.newest) * rows.time_step), 0};
}

/// Gauss of S − 1 points has the order 2S − 2 of the basis; Lobatto has it with S points. On a circle and an interval
/// with each space; spectral ones are scheme.method = spacetime.
std::vector<NamedScheme> variants(const Problem& base) {
  const bool point = base.lattice.space() == Space::point;
  std::vector<std::string> spaces{point ? "" : "lumped"};
  if (!point) spaces.emplace_back("linear");
  if (base.lattice.is_circle()) spaces.emplace_back("pairs");
  std::vector<NamedScheme> schemes;
  for (int S = 2; S <= (point ? 6 : 4); ++S)
    for (const auto& [quadrature, points] : {std::pair{"gauss", S - 1}, {"lobatto", S}})
      for (const std::string& space : spaces) {
        schemes.push_back({fmt::format("cgvi S={} {} R={}{}{}", S, quadrature, points, point ? "" : " ", space), base});
        ParameterValues& parameters = schemes.back().problem.parameters;
        parameters["scheme.basis"] = "lagrange-lobatto";
        parameters["scheme.functions"] = S;
        parameters["scheme.quadrature"] = quadrature;
        parameters["scheme.points"] = points;
        parameters["scheme.continuity"] = "shared";
        if (!point) parameters["scheme.space"] = space;
        if (space == "pairs") parameters["lattice.space_order"] = 2 * S - 2;
        schemes.back().rank = point && points == S - 1 ? 2 * S : 0;
      }
  return schemes;
}

std::string label(const Problem& p) {
  const Keys keys(p);
  return fmt::format("cgvi, {} {} functions, {} {} points, {}{}{}", keys.basis_name, keys.functions, keys.quadrature,
                     keys.points, keys.continuity == Continuity::shared ? "shared" : "multipliers",
                     p.lattice.space() == Space::point ? "" : ", ",
                     p.lattice.space() == Space::point ? "" : space_label(p));
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& named : list) names.push_back(named.name);
  return names;
}

}  // namespace

extern const MethodEntry cgvi_method;
const MethodEntry cgvi_method{
    .name = "cgvi",
    .formula = "continuous Galerkin variational integrators: scheme.functions of scheme.basis, scheme.quadrature",
    .build = build,
    .parameters =
        with_space_keys({{.key = "scheme.basis",
                          .fallback = "lagrange-lobatto",
                          .help = "the functions on a step",
                          .choices = names_of(named_line_bases())},
                         {.key = "scheme.functions",
                          .fallback = 3,
                          .help = "S: how many; their degree is S - 1",
                          .range = {.low = 2, .high = 20}},
                         {.key = "scheme.quadrature",
                          .fallback = "gauss",
                          .help = "the quadrature in time",
                          .choices = names_of(named_line_rules())},
                         {.key = "scheme.points",
                          .fallback = 2,
                          .help = "R: points of the quadrature",
                          .range = {.low = 1, .high = 40},
                          .otherwise = "functions - 1"},
                         {.key = "scheme.continuity",
                          .fallback = "shared",
                          .help = "what joins the steps: end nodes that they share, or multipliers",
                          .choices = {"shared", "multipliers"},
                          .otherwise = "shared where the basis has a node at both ends, or else multipliers"}}),
    .label = label,
    .starts = {StartRule::legendre},
    .start = StartRule::legendre,
    .energy = energy,
    .variants = variants};

}  // namespace delf
