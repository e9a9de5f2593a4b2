// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/jet_table.hpp"
#include "lattice/shapes/time_step.hpp"

namespace delf {

// Mechanics: φ = q and φ_t = (q₂ − q₁)/h on two sites of a time lattice, φ_x = 0. Veselov's map is the scheme of any of
// these: p = −∂L/∂q₁(q₁, q₂), and p′ = ∂L/∂q₂.                                    Marsden–Patrick–Shkoller, §1; Veselov

/// q at the middle: the midpoint rule.
///
/// The field equation of ℓ = ½φ_t² + cos φ − 1:
///
///     (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 + sin((phi(j+1,i) + phi(j,i))/2)/2
///       + sin((phi(j,i) + phi(j-1,i))/2)/2 = 0
inline constexpr struct Midpoint {
  static constexpr JetTable<2, 1> table{shapes::time_step, 1, {{{1, {.5, .5}, {-1, 1}, {0, 0}}}}};
} midpoint;

/// ½ at either end: the trapezoidal rule, Störmer–Verlet for ½q_t² − V(q).
///
/// The field equation of ℓ = ½φ_t² + cos φ − 1:
///
///     (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 + sin(phi(j,i)) = 0
inline constexpr struct Trapezoidal {
  static constexpr JetTable<2, 2> table{
      shapes::time_step, 1, {{{.5, {1, 0}, {-1, 1}, {0, 0}}, {.5, {0, 1}, {-1, 1}, {0, 0}}}}};
} trapezoidal;

/// q at the first vertex: the same positions as the trapezoidal rule, other momenta (symplectic Euler).
///
/// The field equation of ℓ = ½φ_t² + cos φ − 1:
///
///     (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 + sin(phi(j,i)) = 0
inline constexpr struct Vertex {
  static constexpr JetTable<2, 1> table{shapes::time_step, 1, {{{1, {1, 0}, {-1, 1}, {0, 0}}}}};
} vertex;

}  // namespace delf
