// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/jet_table.hpp"
#include "lattice/shapes/rectangle.hpp"

namespace delf {

/// Marsden–Patrick–Shkoller (5.9) with the kinetic term split over both vertical edges, which gives the same equations
/// (5.10) inside, and second order at natural walls where the printed form gives first.
///
/// The field equation of ℓ = ½φ_t² − ½φ_x² + cos φ − 1:
///
///     -(phi(j+1,i-1) - 2*phi(j+1,i) + phi(j+1,i+1) + 2*phi(j,i-1) - 4*phi(j,i) + 2*phi(j,i+1) + phi(j-1,i-1) -
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*k^2) + (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2
///       + sin((phi(j+1,i) + phi(j+1,i+1) + phi(j,i) + phi(j,i+1))/4)/4
///       + sin((phi(j,i) + phi(j,i+1) + phi(j-1,i) + phi(j-1,i+1))/4)/4
///       + sin((phi(j,i-1) + phi(j,i) + phi(j-1,i-1) + phi(j-1,i))/4)/4
///       + sin((phi(j+1,i-1) + phi(j+1,i) + phi(j,i-1) + phi(j,i))/4)/4 = 0
inline constexpr struct Rectangle {
  static constexpr JetTable<4, 2> table{shapes::rectangle,
                                        1,
                                        {{{.5, {.25, .25, .25, .25}, {-1, 1, 0, 0}, {-.5, -.5, .5, .5}},
                                          {.5, {.25, .25, .25, .25}, {0, 0, 1, -1}, {-.5, -.5, .5, .5}}}}};
} rectangle;

/// Marsden–Patrick–Shkoller, above (5.12): space and time alike.
///
/// The field equation of ℓ = ½φ_t² − ½φ_x² + cos φ − 1:
///
///     (phi(j+1,i-1) + 2*phi(j+1,i) + phi(j+1,i+1) - 2*phi(j,i-1) - 4*phi(j,i) - 2*phi(j,i+1) + phi(j-1,i-1) +
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*h^2)
///       - (phi(j+1,i-1) - 2*phi(j+1,i) + phi(j+1,i+1) + 2*phi(j,i-1) - 4*phi(j,i) + 2*phi(j,i+1) + phi(j-1,i-1) -
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*k^2) + sin((phi(j+1,i) + phi(j+1,i+1) + phi(j,i) + phi(j,i+1))/4)/4
///       + sin((phi(j,i) + phi(j,i+1) + phi(j-1,i) + phi(j-1,i+1))/4)/4
///       + sin((phi(j,i-1) + phi(j,i) + phi(j-1,i-1) + phi(j-1,i))/4)/4
///       + sin((phi(j+1,i-1) + phi(j+1,i) + phi(j,i-1) + phi(j,i))/4)/4 = 0
inline constexpr struct RectangleSymmetric {
  static constexpr JetTable<4, 1> table{
      shapes::rectangle, 1, {{{1, {.25, .25, .25, .25}, {-.5, .5, .5, -.5}, {-.5, -.5, .5, .5}}}}};
} rectangle_symmetric;

}  // namespace delf
