// SPDX-License-Identifier: MIT
#include "schemes/methods/pair_parts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <utility>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/mirror_table.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/space_table.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

Parameter space_order_parameter() {
  return {.key = "lattice.space_order",
          .fallback = 4,
          .help = "order in space: 2, 4, ..., 20",
          .range = {.low = 2, .high = 2 * widest_pair}};
}

int space_order_of(const Problem& p) { return p.parameters.maybe<int>("lattice.space_order").value_or(4); }

int pairs_of_order(const Problem& p, const char* key, int order) {
  if (order % 2 != 0 || order < 2 || order > 2 * widest_pair)
    throw BadInput(
        key, fmt::format("{} = {}: wide stencils are of order 2, 4, ..., {}; choose one", key, order, 2 * widest_pair));
  if (p.lattice.sites() < order + 1)
    throw BadInput("lattice.sites",
                   fmt::format("lattice.sites = {}: a stencil of space order {} is {} sites wide; give more",
                               p.lattice.sites(), order, order + 1));
  return order / 2;
}

std::vector<StencilTable> at_both_walls(const StencilTable& table, const Lattice& lattice) {
  if (lattice.space() != Space::interval) return {};
  const auto mirror = [](Wall wall) { return wall == Wall::fixed ? Mirror::odd : Mirror::even; };
  return {mirror_table(table, Placement::left_mirror, mirror(lattice.left())).table,
          mirror_table(table, Placement::right_mirror, mirror(lattice.right())).table};
}

namespace {

/// ℓ = ½ Σ M_ab(x) φ_a,t φ_b,t + U(t, x, φ, φ_x): a sub-step is a kick, of U where the row is, and a drift. M is
/// checked where it is not proved constant: at two jets in every place.
bool is_quadratic_in_rates(const BatchDensity& density) {
  const int d = density.components(), m = density.variables(), t = m;
  bool proved = true;
  for (int a = d; a < 2 * d; ++a) {
    if (!density.is_zero(a, t)) return false;
    for (int b = 0; b < m; ++b) {
      if ((b < d || b >= 2 * d) && !density.is_zero(a, b)) return false;
      proved = proved && density.is_constant(a, b);
    }
  }
  if (proved) return true;
  const ScratchRows jet(m, lanes), x(1, lanes), one(m * m, lanes), other(m * m, lanes);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> some(0.1, 2);
  const double time = some(random);
  for (int l = 0; l < lanes; ++l) x[0][l] = some(random);
  for (const auto& H : {one.data(), other.data()}) {
    for (int v = 0; v < m; ++v)
      for (int l = 0; l < lanes; ++l) jet[v][l] = some(random);
    density.hessian({lanes, jet.data(), time, x[0]}, H);
  }
  for (int a = d; a < 2 * d; ++a)
    for (int b = d; b < 2 * d; ++b)
      for (int l = 0; l < lanes; ++l) {
        const double M = one[a * m + b][l];
        if (!(std::abs(M - other[a * m + b][l]) <= 1e-12 * std::abs(M))) return false;
      }
  return true;
}

/// Each sub-step alone is self-adjoint: the action's potential acts at both of its ends alike.
bool is_of_leapfrog(const Splitting& splitting) {
  double upper = 0;
  for (std::size_t s = 0; s < splitting.drifts.size(); ++s) {
    const double lower = splitting.kicks[s] - upper;
    upper = splitting.drifts[s] - lower;
    if (!(std::abs(lower - upper) <= 1e-12)) return false;
  }
  return true;
}

/// Checks the conditions under which sub-steps serve densities that are nonlinear in more than φ.
void check_density(const BatchDensity& density, const Problem& p, const Splitting& splitting) {
  if (density.nonlinearity() != Nonlinearity::all) return;
  if (!splitting.processor.empty())
    throw BadInput("theory.name", fmt::format("theory.name = {}: scheme.method = {} takes densities that are "
                                              "nonlinear in phi alone; use scheme.method = composition",
                                              p.theory, p.method));
  // Orders 4 and 6 count on forces that do not depend on rates, and on drifts that do not depend on t.
  if (!is_of_leapfrog(splitting) && !is_quadratic_in_rates(density))
    throw BadInput(
        "theory.name",
        fmt::format("theory.name = {}: these sub-steps need phi_t in 0.5*M(x)*phi_t^2 alone; use "
                    "scheme.order = 2 or 8, whose sub-steps are leapfrog's, or scheme.method = multisymplectic",
                    p.theory));
  // Images are those of the density too, and what φ_t or φ_x is multiplied by has a kink there.
  const int d = density.components(), x = density.variables() + 1;
  for (int a = d; a < 3 * d && p.lattice.space() == Space::interval; ++a)
    if (!density.is_zero(a, x) && space_order_of(p) > 2)
      throw BadInput("lattice.space_order",
                     fmt::format("lattice.space_order = {}: between walls pairs go on by mirror images, and a density "
                                 "with coefficients of x has none to this order; use lattice.space_order = 2, or "
                                 "lattice.space = circle",
                                 space_order_of(p)));
}

}  // namespace

SchemeParts pair_parts(const FieldTheory& theory, const Problem& p, const Splitting& splitting,
                       const std::vector<double>& pairs) {
  if (p.lattice.space() == Space::point && !splitting.processor.empty())
    throw BadInput("lattice.space", fmt::format("scheme.method = {}: wide stencils have no neighbours at a point; use "
                                                "lattice.space = circle or interval",
                                                p.method));
  if (theory.constraint())
    throw BadInput("scheme.method",
                   fmt::format("scheme.method = {}: this version has no constraints between sub-steps; "
                               "use scheme.method = multisymplectic",
                               p.method));
  check_density(theory.density(), p, splitting);
  const StencilTable time = splitting_element(splitting), space = pairs.empty() ? point_space() : pair_space(pairs),
                     element = product(time, space);
  // Between sub-steps momenta change by ∂ℓ/∂φ, linear or not.
  SchemeParts parts{{theory.on_table(element, true)}, theory.fields(), theory.symmetries(), splitting.processor, {}};
  for (const StencilTable& at_wall : at_both_walls(space, p.lattice)) {
    StencilTable term = product(time, at_wall);
    term.pattern.placement = at_wall.pattern.placement;
    parts.families.push_back(theory.on_table(std::move(term), true));
  }
  take_to_mesh(parts, theory, p, time, true);
  for (std::size_t s = 1; s < element.nodes.size(); ++s)
    for (const Component& field : theory.fields())
      parts.components.push_back(
          {fmt::format("{} after {} sub-steps", field.name, s), Role::inner, element.nodes[s], false, field.field});
  return parts;
}

}  // namespace delf
