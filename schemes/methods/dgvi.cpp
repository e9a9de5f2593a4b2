// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/flux_table.hpp"
#include "jets/tables/table_product.hpp"
#include "jets/tables/time_element.hpp"
#include "lattice/error.hpp"
#include "schemes/declared.hpp"
#include "schemes/families/trace_stencil.hpp"
#include "schemes/methods/element_keys.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/methods/space_keys.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

struct DgviKeys : ElementKeys {
  explicit DgviKeys(const Problem& p)
      : ElementKeys(p.parameters),
        flux(*std::ranges::find(named_fluxes(), p.parameters.get<std::string>("scheme.flux"), &NamedFlux::name)),
        nu(p.parameters.get<double>("scheme.nu")) {}

  const NamedFlux& flux;
  double nu;
};

/// Nodes of the unit cell: 0 the observed q, 1 … S the coefficients, then the traces and the multipliers.
struct Nodes {
  explicit Nodes(int S) : minus(S + 1), plus(S + 2), lambda(S + 3), mu(S + 4), observed(S + 5) {}
  int minus, plus, lambda, mu, observed;
};

int variable(JetSlot slot, int d, int a) { return static_cast<int>(slot) * d + a; }

/// ℓ = θ(q)·q̇ − H(q), proved from the density: ∂²ℓ/∂q̇∂q̇ = 0, and every field has a partner, ∂²ℓ/∂q̇∂q ≠ 0.
void require_first_order(const FieldTheory& theory) {
  const BatchDensity& density = theory.density();
  const int d = theory.components();
  const auto name = [&](int a) { return theory.fields()[a].name; };
  const auto refuse = [](const std::string& why) {
    throw BadInput("scheme.method", "scheme.method = dgvi: for densities theta(q).q_t - H(q), and " + why);
  };
  for (int a = 0; a < d; ++a)
    for (int b = 0; b <= a; ++b)
      if (!density.is_zero(variable(JetSlot::phi_t, d, a), variable(JetSlot::phi_t, d, b)))
        refuse(fmt::format("this one is not linear in {}_t; use scheme.method = cgvi", name(a)));
  for (int a = 0; a < d; ++a) {
    bool coupled = false;
    for (int b = 0; b < d; ++b)
      for (const auto& [v, u] : {std::pair{a, b}, {b, a}})
        if (!density.is_zero(variable(JetSlot::phi_t, d, v), variable(JetSlot::phi, d, u))) coupled = true;
    if (!coupled) refuse(fmt::format("in this one no term of theta moves {}: no step determines it", name(a)));
  }
  if (d % 2 != 0) refuse(fmt::format("this one has {} field{}: theta needs an even number", d, d == 1 ? "" : "s"));
}

/// One-sided fluxes are for gauges in which half of the fields have momenta: those, and the others.
std::pair<std::vector<int>, std::vector<int>> halves(const FieldTheory& theory) {
  std::vector<int> with, without;
  const int d = theory.components();
  for (int a = 0; a < d; ++a)
    (theory.density().depends_on(variable(JetSlot::phi_t, d, a)) ? with : without).push_back(a);
  if (with.size() != without.size())
    throw BadInput(
        "scheme.flux",
        fmt::format("scheme.flux = one-sided: needs a gauge theta = (theta_x, 0) in which half of the fields "
                    "have velocities in the density, and here {} of {} have; choose such a theory.gauge, or "
                    "use gauss2",
                    with.size(), d));
  return {with, without};
}

std::vector<Component> traces(const char* name, int d) {
  std::vector<Component> list;
  for (const Component& field : fields(d))
    list.push_back({fmt::format("{}{}", field.name, name), Role::trace, {}, false, field.field});
  return list;
}

/// The observation of a vertex from its traces, with multipliers κ that nothing else reads, so that κ = 0.
///
///     straight lines   κ·(½(q⁻ + q⁺) − q)
///     one-sided        κ·(θ(q) − θ(q⁻)) and κ·(x⁺ − x): the phase space is (x⁺, θ_x(q⁻))
///     nodal            nothing: the flux reads q itself
void observe(SchemeParts& parts, const FieldTheory& theory, const DgviKeys& keys, const Nodes& nodes) {
  const int d = theory.components();
  const FluxNodes at{nodes.minus, 0, nodes.plus};
  std::vector<double> weights(nodes.plus, 0.0);
  double &of_minus = weights[nodes.minus - 1], &of_plus = weights[nodes.plus - 1];
  const auto tie = [&](TraceStencil stencil) {
    parts.families.push_back(std::make_shared<LagrangianFamily<TraceStencil>>(std::move(stencil).with_own_nodes()));
  };
  if (keys.flux.observed == NamedFlux::Observed::vertex) return;
  std::vector<Component> kappa = momentum_components("kappa", d);
  if (keys.flux.observed == NamedFlux::Observed::momentum) {
    const auto [with, without] = halves(theory);
    std::vector<std::pair<int, int>> tied;
    for (std::size_t i = 0; i < with.size(); ++i) tied.emplace_back(with[i], nodes.observed * d + without[i]);
    of_plus = 1;
    tie({TraceStencil::End::lower, d, weights, tied});
    parts.families.push_back(theory.on_table(momentum_tie_table(at, nodes.observed)));
    for (Component& c : kappa) c.momentum = false;
  } else {
    of_minus = of_plus = 0.5;
    tie({TraceStencil::End::lower, d, weights, nodes.observed * d});
  }
  std::ranges::move(kappa, std::back_inserter(parts.components));
}

/// Refuses a space whose nodes are no sites, and walls that cut masses in half.
void require_own_mass(const Problem& p) {
  const std::string space = p.parameters.maybe<std::string>("scheme.space").value_or("lumped");
  if (space == "linear" || space == "spectral")
    throw BadInput("scheme.space",
                   fmt::format("scheme.space = {}: the jumps of dgvi are those of sites, whose mass is their own; use "
                               "lumped or pairs",
                               space));
  if (p.lattice.space() == Space::interval)
    for (const auto& [wall, key] :
         {std::pair{p.lattice.left(), "boundary.left"}, {p.lattice.right(), "boundary.right"}})
      if (wall == Wall::natural)
        throw BadInput(key, fmt::format("{} = natural: the jumps of dgvi have no action at walls; use fixed", key));
}

/// The action of the sources' discontinuous Galerkin integrators, with the ends of the cells as traces of their own:
///
///     Σ_n h Σ_i b_i ℓ(Q_i, V_i) + λ_n·(r⁺x_n − q_n⁺) + μ_{n+1}·(r⁻x_n − q⁻_{n+1}) + J(q_n⁻, q_n⁺)
///
/// Then λ = ∂₊J and μ = ∂₋J. Fields have this at every site, and φ_x in ℓ by the table of space, whose points are
/// sites: the mass of a jump is its site's own.
SchemeParts dgvi_parts(const FieldTheory& theory, const Problem& p) {
  const StencilTable space = space_table(p);
  if (p.lattice.space() != Space::point) require_own_mass(p);
  if (theory.constraint())
    throw BadInput("scheme.method",
                   "scheme.method = dgvi: the theory has a constraint, and this scheme has none; use "
                   "scheme.method = multisymplectic");
  require_first_order(theory);
  const DgviKeys keys(p);
  const int d = theory.components();
  const Nodes nodes(keys.functions);
  const StencilTable element = product(time_element(keys.basis, keys.rule(), Continuity::multipliers), space);
  SchemeParts parts = element_parts(theory, element);
  for (const auto& more :
       {traces("-", d), traces("+", d), momentum_components("lambda", d), momentum_components("mu", d)})
    std::ranges::copy(more, std::back_inserter(parts.components));

  using enum TraceStencil::End;
  for (const TraceStencil& end : {TraceStencil(lower, d, keys.basis.values(0), nodes.lambda * d, nodes.plus * d),
                                  TraceStencil(upper, d, keys.basis.values(1), nodes.mu * d, nodes.minus * d)})
    parts.families.push_back(std::make_shared<LagrangianFamily<TraceStencil>>(TraceStencil(end).with_own_nodes()));
  std::vector<FluxPoint> jump = keys.flux.points;
  std::ranges::copy(gauge_of_jumps(keys.nu), std::back_inserter(jump));
  parts.families.push_back(theory.on_table(flux_table(jump, {nodes.minus, 0, nodes.plus})));
  observe(parts, theory, keys, nodes);
  return parts;
}

/// max |q⁺ − q⁻|, as twice the distance of q⁻ from the observed q: a nodal flux finds q⁺ with the next row.
double jump(const RowsInTime& rows) {
  double most = 0;
  for (int c = 0; c < rows.system.components(); ++c) {
    const Component& trace = rows.system.component(c);
    if (trace.role != Role::trace || !trace.name.ends_with('-')) continue;
    for (int i = 0; i < rows.system.lattice().sites(); ++i)
      most = std::max(most, 2 * std::abs(rows.rows(rows.newest, i, c) - rows.rows(rows.newest, i, trace.field)));
  }
  return most;
}

/// Each flux, with functions and Gauss's rule of as many points.
std::vector<NamedScheme> dgvi_variants(const Problem& base) {
  if (base.lattice.space() != Space::point) return {{base.method, base}};
  std::vector<NamedScheme> schemes;
  for (int S = 1; S <= 4; ++S)
    for (const NamedFlux& flux : named_fluxes()) {
      if (S != 3 && flux.name != "gauss2" && flux.name != "one-sided") continue;
      schemes.push_back({fmt::format("{} S={} {}", base.method, S, flux.name), base});
      ParameterValues& parameters = schemes.back().problem.parameters;
      parameters["scheme.basis"] = "lagrange-gauss", parameters["scheme.functions"] = S;
      parameters["scheme.quadrature"] = "gauss", parameters["scheme.points"] = S;
      parameters["scheme.flux"] = flux.name;
    }
  return schemes;
}

std::string dgvi_label(const Problem& p) {
  const DgviKeys keys(p);
  return fmt::format("dgvi, {} flux, {} {} functions, {} {} points{}", keys.flux.name, keys.basis_name, keys.functions,
                     keys.quadrature, keys.points, keys.nu == 0 ? "" : fmt::format(", nu = {}", keys.nu)) +
         space_label(p);
}

std::string dgvi_words(const Problem& p) {
  const DgviKeys keys(p);
  return fmt::format(
             "the discontinuous Galerkin variational integrator with {} basis functions ({}), {} quadrature of {} "
             "point{} and the {} flux in time",
             keys.functions, keys.basis_name, keys.quadrature, keys.points, keys.points == 1 ? "" : "s",
             keys.flux.name) +
         space_in_words(p);
}

}  // namespace

extern const MethodEntry dgvi_method;
const MethodEntry dgvi_method{
    .name = "dgvi",
    .formula = "discontinuous Galerkin variational integrators of theta(q).q_t - H(q): scheme.functions, scheme.flux",
    .build = dgvi_parts,
    .parameters = {basis_parameter("lagrange-gauss"),
                   functions_parameter(3, 1),
                   quadrature_parameter(),
                   points_parameter("functions", 3),
                   {.key = "scheme.flux",
                    .fallback = "gauss2",
                    .help = "the action of a jump",
                    .choices = names_of(named_fluxes())},
                   {.key = "scheme.nu",
                    .fallback = 0.0,
                    .help = "a fault for `delf verify` to find: a gauge -nu d(theta.q)/dt on the jumps alone"},
                   space_key(),
                   space_order_key(),
                   degree_space_key()},
    .label = dgvi_label,
    .starts = {StartRule::values},
    .start = StartRule::values,
    .energy = &hamiltonian_of_row,
    .monitors = {{.name = "jump",
                  .value = jump,
                  .when_it_grows = "a mode of the doubled phase space takes over, and the energy does not show it; run "
                                   "less far, or use scheme.flux = one-sided in a gauge that allows it"}},
    .variants = dgvi_variants,
    .words = dgvi_words,
    .sources = {"kraus-2017", "geometric-integrators-2020"}};

}  // namespace delf
