// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/space_table.hpp"
#include "jets/tables/stencil_table.hpp"
#include "jets/tables/table_product.hpp"
#include "jets/tables/time_element.hpp"
#include "lattice/error.hpp"

namespace delf {

/// The quadrature in time: Lobatto with p_t + 1 points, at the nodes, or Gauss with p_t points.
enum class TimeQuadrature { lobatto, gauss };

/// The spacetime Galerkin element of degree (p_t, p_x): φ = Σ_ab ψ_a(t/h) ψ_b(x/k) y_ab on the Lobatto nodes, a product
/// of a time element and a spectral one.
///
///     ●──∘──○      p_t = p_x = 2. The unit cell has the p_t p_x nodes a·p_x + b, a < p_t, b < p_x: ● and ∘ of the
///     ∘──∘──∘      lowest rows; the others belong to the cells above and on the right.
///     ●──∘──○      The vertices of the pattern are all (p_t + 1)(p_x + 1) nodes, l = a (p_x + 1) + b.
///
inline StencilTable spacetime_element(int degree_time, int degree_space, TimeQuadrature quadrature) {
  if (degree_time < 1 || degree_time > 12)
    throw BadInput("scheme.degree_time", "scheme.degree_time = " + std::to_string(degree_time) +
                                             ": an element has a degree from 1 to 12; choose one");
  const LineRule nodes = lobatto_rule(degree_time + 1);
  const LineRule rule = quadrature == TimeQuadrature::lobatto ? nodes : gauss_rule(degree_time);
  return product(time_element(lagrange_basis(nodes.points), rule, Continuity::shared), spectral_space(degree_space));
}

}  // namespace delf
