// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/jet_table.hpp"
#include "lattice/shapes/hexagon.hpp"

namespace delf {

/// The brick a₀a₁a₂ b₀b₁b₂ with dₙ = (bₙ − aₙ)/h, g_c = (a_{c+1} − a_c + b_{c+1} − b_c)/2k: four points of weight ¼,
/// (φ_t, φ_x) = (d₀,g₀), (d₁,g₀), (d₁,g₁), (d₂,g₁), and φ the mean of the six. Marsden–Patrick–Shkoller propose
/// hexagons (Fig. 5.4) without printing a jet; this one has no hourglass modes, and for N = 0 gives (5.10).
///
/// The field equation of ℓ = ½φ_t² − ½φ_x² + cos φ − 1:
///
///     -(phi(j+1,i-1) - 2*phi(j+1,i) + phi(j+1,i+1) + 2*phi(j,i-1) - 4*phi(j,i) + 2*phi(j,i+1) + phi(j-1,i-1) -
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*k^2) + (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2
///       + sin((phi(j+1,i) + phi(j+1,i+1) + phi(j+1,i+2) + phi(j,i) + phi(j,i+1) + phi(j,i+2))/6)/3
///       + sin((phi(j+1,i-2) + phi(j+1,i-1) + phi(j+1,i) + phi(j,i-2) + phi(j,i-1) + phi(j,i))/6)/3
///       + sin((phi(j,i-1) + phi(j,i) + phi(j,i+1) + phi(j-1,i-1) + phi(j-1,i) + phi(j-1,i+1))/6)/3 = 0 (i + j even)
///     -(phi(j+1,i-1) - 2*phi(j+1,i) + phi(j+1,i+1) + 2*phi(j,i-1) - 4*phi(j,i) + 2*phi(j,i+1) + phi(j-1,i-1) -
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*k^2) + (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2
///       + sin((phi(j+1,i-1) + phi(j+1,i) + phi(j+1,i+1) + phi(j,i-1) + phi(j,i) + phi(j,i+1))/6)/3
///       + sin((phi(j,i) + phi(j,i+1) + phi(j,i+2) + phi(j-1,i) + phi(j-1,i+1) + phi(j-1,i+2))/6)/3
///       + sin((phi(j,i-2) + phi(j,i-1) + phi(j,i) + phi(j-1,i-2) + phi(j-1,i-1) + phi(j-1,i))/6)/3 = 0 (i + j odd)
inline constexpr struct Hexagon {
  static constexpr JetTable<6, 4> table = [] {
    constexpr double m = 1. / 6;
    constexpr std::array<double, 6> mean{m, m, m, m, m, m};
    constexpr std::array<double, 6> d0{-1, 0, 0, 1, 0, 0}, d1{0, -1, 0, 0, 1, 0}, d2{0, 0, -1, 0, 0, 1};
    constexpr std::array<double, 6> g0{-.5, .5, 0, -.5, .5, 0}, g1{0, -.5, .5, 0, -.5, .5};
    return JetTable<6, 4>{
        shapes::hexagon, 2, {{{.25, mean, d0, g0}, {.25, mean, d1, g0}, {.25, mean, d1, g1}, {.25, mean, d2, g1}}}};
  }();
} hexagon;

}  // namespace delf
