// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <string>
#include <vector>

#include "jets/tables/stencil_table.hpp"

namespace delf {

/// A point of a path from q⁻ to q⁺: weights of (q⁻, q, q⁺) in the place and in the increment along the path. The value q
/// between the two is that of the vertex.
struct FluxPoint {
  double weight;
  std::array<double, 3> place, increment;
};

/// A numerical flux, which stands for the action ∫ θ(q)·dq of a jump:
///
///     J(q⁻, q⁺) = Σ_i β_i θ(μ⁻_i q⁻ + μ⁺_i q⁺)·(α⁻_i q⁻ + α⁺_i q⁺)
///
struct NamedFlux {
  /// The observed value, of the highest order: ½(q⁻ + q⁺); (x⁺, y) whose momentum θ_x(x⁺, y) is that of q⁻; or q.
  enum class Observed { average, momentum, vertex };
  std::string name;
  std::vector<FluxPoint> points;
  Observed observed = Observed::average;
};
/// The straight line from q⁻ to q⁺ by a quadrature rule: midpoint, trapezoid, gauss2, simpson; θ at q⁻: one-sided; two
/// straight lines, from q⁻ to q and from q to q⁺, by the trapezoidal rule: nodal.
const std::vector<NamedFlux>& named_fluxes();

/// −ν [θ(q⁺)·q⁺ − θ(q⁻)·q⁻]: what a gauge −ν d(θ·q)/dt adds to a jump. Without its part in the cells it is wrong.
std::vector<FluxPoint> gauge_of_jumps(double nu);

/// The nodes of the unit cell that carry q⁻, q and q⁺.
using FluxNodes = std::array<int, 3>;

/// A flux as a table for densities ℓ = θ(q)·q̇ − H(q), whatever θ is: the weights of ±ℓ are those of
///
///     θ(Q)·α = h [ℓ(Q, α/h) − ℓ(Q, 0)]
///
StencilTable flux_table(const std::vector<FluxPoint>&, const FluxNodes&);

/// κ·(θ(q) − θ(q⁻)): the vertex has the momentum θ(q⁻). Node `multiplier` of the unit cell carries κ.
StencilTable momentum_tie_table(const FluxNodes&, int multiplier);

}  // namespace delf
