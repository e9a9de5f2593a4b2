// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/table_product.hpp"
#include "jets/tables/time_tableau.hpp"
#include "lattice/error.hpp"
#include "schemes/declared.hpp"
#include "schemes/families/mapped_family.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/methods/space_keys.hpp"
#include "schemes/methods/time_element_keys.hpp"
#include "schemes/simulation.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_on_space.hpp"

namespace delf {
namespace {

/// G = 0 at every point of the rule, which are nodes of the basis: at the vertex of a row, which neighbours share, and at
/// the nodes inside, each with a multiplier. Its force then has the values of the quadrature, as that of SHAKE and RATTLE.
void add_constraints(SchemeParts& parts, const FieldTheory& theory, const TimeElementKeys& keys,
                     const StencilTable& element) {
  const auto refuse = [] {
    throw BadInput("scheme.method",
                   "scheme.method = cgvi: a constraint is kept at the points of the rule, which must be "
                   "shared ends and nodes of the basis; use scheme.tableau = stormer-verlet or lobatto3");
  };
  const int d = theory.components(), last = keys.functions - 1;
  if (keys.continuity != Continuity::shared || !keys.basis.knots.empty()) refuse();
  std::vector<int> nodes;
  for (const double point : keys.rule().points) {
    const std::vector<double> phi = keys.basis.values(point);
    nodes.push_back(static_cast<int>(std::ranges::max_element(phi) - phi.begin()));
    for (int j = 0; j <= last; ++j)
      if (phi[j] != (j == nodes.back() ? 1 : 0)) refuse();
  }
  if (nodes.front() != 0 || nodes.back() != last) refuse();
  nodes.pop_back();  // the next row's own
  for (const int node : nodes) {
    const int first = static_cast<int>(parts.components.size());
    const auto constraint = theory.constraint();
    MappedFamily::Map map;
    for (int i = 0; i < constraint->size(); ++i) {
      const int c = constraint->values()[i].component;
      map.reads.push_back({{{.time = 0, .space = 0, .node = node}, c < d ? node * d + c : first + c - d, 1}});
    }
    parts.families.push_back(std::make_shared<MappedFamily>(constraint, map));
    const NodePosition at = element.nodes[node];
    for (const Component& multiplier : multipliers_of(theory))
      parts.components.push_back(
          {node == 0 ? multiplier.name : fmt::format("{} at {:.4g}", multiplier.name, at.time), Role::multiplier, at});
  }
}

/// p = ∂ℓ/∂q_t must determine every velocity: the densities of dgvi have none.
void require_mass(const FieldTheory& theory) {
  const int d = theory.components();
  for (int a = d; a < 2 * d; ++a) {
    bool has_mass = false;
    for (int b = d; b < 2 * d; ++b) has_mass = has_mass || !theory.density().is_zero(a, b);
    if (!has_mass)
      throw BadInput(
          "scheme.method",
          fmt::format("scheme.method = cgvi: the density is linear in the velocity of {}, so that its momentum "
                      "does not determine it; use scheme.method = dgvi if it is so in all",
                      theory.fields()[a - d].name));
  }
}

SchemeParts cgvi_parts(const FieldTheory& theory, const Problem& p) {
  require_mass(theory);
  if (theory.constraint() && p.lattice.space() != Space::point && p.lattice.space() != Space::mesh)
    throw BadInput(
        "scheme.method",
        "scheme.method = cgvi: constraints of elements are for lattice.space = point or complex; use scheme.method = "
        "multisymplectic");
  const TimeElementKeys keys(p.parameters);
  const StencilTable time = keys.element(), space = space_table(p), element = product(time, space);
  SchemeParts parts = keys.continuity == Continuity::shared
                          ? element_parts(theory, element)
                          : element_parts(theory, element, Traces{keys.basis.values(0), keys.basis.values(1), space});
  take_to_mesh(parts, theory, p, time);
  if (theory.constraint()) add_constraints(parts, theory, keys, element);
  return parts;
}

/// p = ∂L/∂q of what lies below the row; at the start, where nothing does, −∂L/∂q of what lies above it. Under a
/// constraint p is known up to the force of the row itself: it is the one whose velocity keeps the constraint,
///
///     ∂G/∂q·q̇ = 0,    ∂ℓ/∂q̇(q, q̇) = p + μ ∂G/∂q
std::vector<double> momentum(const RowsInTime& rows, std::int64_t row) {
  std::vector<double> all = momenta(rows.system, rows.rows, row, row == rows.newest ? Side::below : Side::above);
  if (rows.theory.constraint()) {
    const LegendreTransform transform(rows.system, rows.rows, row);
    if (const auto v = transform.velocities(all)) all = transform.momenta(*v);
  }
  std::vector<double> p;  // at each site the fields come first
  for (auto site = all.begin(); site != all.end(); site += rows.system.components())
    p.insert(p.end(), site, site + rows.theory.components());
  return p;
}
std::vector<std::string> momentum_names(const FieldTheory& theory) {
  std::vector<std::string> names;
  for (const Component& field : fields(theory.components())) names.push_back("p of " + field.name);
  return names;
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

/// One of each tableau, whatever keys of elements the base has.
std::vector<NamedScheme> cgvi_variants(const Problem& base) {
  Problem without = base;
  without.parameters = {};
  const std::vector<Parameter> own = TimeElementKeys::parameters();
  for (const auto& [key, value] : base.parameters)
    if (!find_parameter(own, key)) without.parameters[key] = value;
  if (base.lattice.space() != Space::point) return on_spaces(without);
  std::vector<NamedScheme> schemes;
  for (const TimeTableau& tableau : time_tableaux()) {
    schemes.push_back({fmt::format("{} {}", base.method, tableau.name), without});
    schemes.back().problem.parameters["scheme.tableau"] = tableau.name;
    // the highest order makes the reference: Gauss's methods, stable at any step
    schemes.back().rank = tableau.quadrature == "gauss" ? 2 * tableau.functions : 0;
  }
  return schemes;
}

std::string cgvi_label(const Problem& p) {
  return "cgvi, " + TimeElementKeys(p.parameters).in_words() + space_label(p);
}

std::vector<Parameter> keys() {
  std::vector<Parameter> list = TimeElementKeys::parameters();
  list.insert(list.end(), {space_key(), space_order_key(), degree_space_key()});
  return list;
}

/// The order for polynomials of degree S − 1: 2(S − 1), if the rule of R points has it, 2R of Gauss, 2R − 2 of Lobatto.
std::optional<int> cgvi_order(const Problem& p) {
  const TimeElementKeys keys(p.parameters);
  if (keys.basis_name == "b-spline" || (keys.quadrature != "gauss" && keys.quadrature != "lobatto"))
    return std::nullopt;
  const int of_rule = 2 * keys.points - (keys.quadrature == "lobatto" ? 2 : 0);
  return order_in_space(p, std::min(2 * (keys.functions - 1), of_rule));
}

std::vector<std::string> sources_of_tableau(const Problem& p) {
  const std::string tableau = TimeElementKeys(p.parameters).tableau;
  if (tableau.empty()) return {};
  return std::ranges::find(time_tableaux(), tableau, &TimeTableau::name)->sources;
}

std::string cgvi_words(const Problem& p) {
  const TimeElementKeys keys(p.parameters);
  const std::string time =
      keys.tableau.empty()
          ? fmt::format(
                "the continuous Galerkin variational integrator with {} basis functions ({}) and {} quadrature of "
                "{} point{} in time",
                keys.functions, keys.basis_name, keys.quadrature, keys.points, keys.points == 1 ? "" : "s")
          : std::ranges::find(time_tableaux(), keys.tableau, &TimeTableau::name)->words + " in time";
  return time + space_in_words(p);
}

}  // namespace

extern const MethodEntry cgvi_method;
const MethodEntry cgvi_method{
    .name = "cgvi",
    .formula = "continuous Galerkin variational integrators: Gauss, Lobatto IIIA-IIIB and other elements of time",
    .build = cgvi_parts,
    .parameters = keys(),
    .on_meshes = true,
    .label = cgvi_label,
    .starts = {StartRule::legendre},
    .start = StartRule::legendre,
    .energy = &hamiltonian_of_row,
    .datasets = {{.name = "momentum",
                  .meaning = "p = dL/dq of the step below the row: the momenta of q",
                  .components = momentum_names,
                  .values = momentum}},
    .variants = cgvi_variants,
    .order = cgvi_order,
    .words = cgvi_words,
    .sources = {"marsden-west-2001", "ober-blobaum-saake-2015"},
    .further_sources = sources_of_tableau};

}  // namespace delf
