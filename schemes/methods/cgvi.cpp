// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "jets/tables/table_product.hpp"
#include "jets/tables/time_element.hpp"
#include "lattice/error.hpp"
#include "schemes/families/trace_stencil.hpp"
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

std::vector<Component> multipliers(const char* name, int d) {
  std::vector<Component> list;
  for (const Component& field : fields(d))
    list.push_back(
        {fmt::format("{} of {}", name, field.name), Role::multiplier, {}, false, static_cast<int>(list.size()), true});
  return list;
}

/// Every node of the unit cell carries the d fields, component = node · d + a; multipliers follow.
SchemeParts build(const FieldTheory& theory, const Problem& p) {
  if (theory.constraint())
    throw BadInput("scheme.method",
                   "scheme.method = cgvi: this version has no constraints at the nodes of elements; use scheme.method "
                   "= multisymplectic");
  const Keys keys(p);
  const int d = theory.components();
  const StencilTable element = time_element(keys.basis, keys.rule(), keys.continuity), space = space_table(p);
  if (p.lattice.space() != Space::point)
    return keys.continuity == Continuity::shared
               ? element_parts(theory, product(element, space))
               : element_parts(theory, product(element, space),
                               Traces{keys.basis.values(0), keys.basis.values(1), space});
  SchemeParts parts{{theory.on_table(element)}, fields(d), theory.symmetries()};
  for (std::size_t node = 1; node < element.nodes.size(); ++node)
    for (int a = 0; a < d; ++a)
      parts.components.push_back(
          {fmt::format("{} at {:.4g}", fields(d)[static_cast<std::size_t>(a)].name, element.nodes[node].time),
           Role::inner, element.nodes[node], false, a});
  if (keys.continuity == Continuity::shared) return parts;
  // λ_n·(r⁺x_n − q_n) and μ_{n+1}·(r⁻x_n − q_{n+1}), with r⁺ = φ(0) and r⁻ = φ(1)
  for (const auto& [end, name, at] :
       {std::tuple{TraceStencil::End::lower, "lambda", 0.0}, std::tuple{TraceStencil::End::upper, "mu", 1.0}}) {
    parts.families.push_back(std::make_shared<LagrangianFamily<TraceStencil>>(
        TraceStencil(end, d, keys.basis.values(at), static_cast<int>(parts.components.size()))));
    std::ranges::copy(multipliers(name, d), std::back_inserter(parts.components));
  }
  return parts;
}

/// H(q, p) at the newest row, p = ∂L/∂q of what lies below it: an observable of the scheme's own phase space.
EnergyMomentum energy(const RowsInTime& rows) {
  if (rows.system.lattice().space() != Space::point) return element_energy(rows);
  const std::vector<double> p = momenta(rows.system, rows.rows, rows.newest, Side::below);
  std::vector<double> q;
  for (int a = 0; a < rows.theory.components(); ++a) q.push_back(rows.rows(rows.newest, 0, a));
  return {hamiltonian(rows.theory.density(), q, p, static_cast<double>(rows.newest) * rows.time_step), 0};
}

/// Fields: with each space; spectral ones are scheme.method = spacetime.
std::vector<NamedScheme> on_spaces(const Problem& base) {
  std::vector<std::string> spaces{"lumped", "linear"};
  if (base.lattice.is_circle()) spaces.emplace_back("pairs");
  std::vector<NamedScheme> schemes;
  for (int S = 2; S <= 4; ++S)
    for (const auto& [quadrature, points] : {std::pair{"gauss", S - 1}, {"lobatto", S}})
      for (const std::string& space : spaces) {
        schemes.push_back({fmt::format("cgvi S={} {} R={} {}", S, quadrature, points, space), base});
        ParameterValues& parameters = schemes.back().problem.parameters;
        parameters["scheme.basis"] = "lagrange-lobatto";
        parameters["scheme.functions"] = S;
        parameters["scheme.quadrature"] = quadrature;
        parameters["scheme.points"] = points;
        parameters["scheme.continuity"] = "shared";
        parameters["scheme.space"] = space;
        if (space == "pairs") parameters["lattice.space_order"] = 2 * S - 2;
      }
  return schemes;
}

/// p = ∂L/∂q of what lies below the row; at the start, where nothing does, −∂L/∂q of what lies above it.
std::vector<double> momentum(const RowsInTime& rows, std::int64_t row) {
  std::vector<double> p = momenta(rows.system, rows.rows, row, row == rows.newest ? Side::below : Side::above);
  p.resize(static_cast<std::size_t>(rows.theory.components()));  // one site; fields come first
  return p;
}
std::vector<std::string> momentum_names(const FieldTheory& theory) {
  std::vector<std::string> names;
  for (const Component& field : fields(theory.components())) names.push_back("p of " + field.name);
  return names;
}

/// Gauss of S − 1 points has the order 2S − 2 of the basis; Lobatto has it with S points.
std::vector<NamedScheme> variants(const Problem& base) {
  if (base.lattice.space() != Space::point) return on_spaces(base);
  std::vector<NamedScheme> schemes;
  for (int S = 2; S <= 6; ++S)
    for (const auto& [quadrature, points] : {std::pair{"gauss", S - 1}, {"lobatto", S}}) {
      schemes.push_back({fmt::format("cgvi S={} {} R={}", S, quadrature, points), base});
      ParameterValues& parameters = schemes.back().problem.parameters;
      parameters["scheme.basis"] = "lagrange-lobatto";
      parameters["scheme.functions"] = S;
      parameters["scheme.quadrature"] = quadrature;
      parameters["scheme.points"] = points;
      parameters["scheme.continuity"] = "shared";
      schemes.back().rank = points == S - 1 ? 2 * S : 0;
    }
  return schemes;
}

std::string label(const Problem& p) {
  const Keys keys(p);
  return fmt::format("cgvi, {} {} functions, {} {} points, {}", keys.basis_name, keys.functions, keys.quadrature,
                     keys.points, keys.continuity == Continuity::shared ? "shared" : "multipliers") +
         space_label(p);
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
    .parameters = {{.key = "scheme.basis",
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
                    .otherwise = "shared where the basis has a node at both ends, or else multipliers"},
                   space_key(),
                   space_order_key(),
                   degree_space_key()},
    .label = label,
    .starts = {StartRule::legendre},
    .start = StartRule::legendre,
    .energy = energy,
    .datasets = {{.name = "momentum",
                  .meaning = "p = dL/dq of the step below the row: the momenta of q",
                  .components = momentum_names,
                  .values = momentum}},
    .variants = variants};

}  // namespace delf
