// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/jet_table.hpp"
#include "lattice/shapes/nine_tuple.hpp"
#include "lattice/shapes/six_tuple.hpp"

namespace delf {

/// Jets on the six-tuple ◫ (vertices 0 1 2 below, 5 4 3 above): φ and φ_t on the middle edge, φ_x and φ_tx on the left
/// and on the right half, φ_xx the mean of both rows.
///
/// The field equation of ℓ = ½φ_t² − ½φ_x² + cos φ − 1:
///
///     -(phi(j+1,i-1) - 2*phi(j+1,i) + phi(j+1,i+1) + 2*phi(j,i-1) - 4*phi(j,i) + 2*phi(j,i+1) + phi(j-1,i-1) -
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*k^2) + (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2
///       + sin((phi(j+1,i) + phi(j,i))/2)/2 + sin((phi(j,i) + phi(j-1,i))/2)/2 = 0
inline constexpr struct SixTuple {
  static constexpr JetTable<6, 2> table{shapes::six_tuple,
                                        1,
                                        {{{.weight = .5,
                                           .phi = {0, .5, 0, 0, .5, 0},
                                           .phi_t = {0, -1, 0, 0, 1, 0},
                                           .phi_x = {-.5, .5, 0, 0, .5, -.5},
                                           .phi_tx = {1, -1, 0, 0, 1, -1},
                                           .phi_xx = {.5, -1, .5, .5, -1, .5}},
                                          {.weight = .5,
                                           .phi = {0, .5, 0, 0, .5, 0},
                                           .phi_t = {0, -1, 0, 0, 1, 0},
                                           .phi_x = {0, -.5, .5, .5, -.5, 0},
                                           .phi_tx = {0, 1, -1, 1, -1, 0},
                                           .phi_xx = {.5, -1, .5, .5, -1, .5}}}}};
} six_tuple;

/// Jets on the nine-tuple ⊞: the symmetric rectangle's jet in each of its four cells, with φ_tx of the cell, φ_xx the
/// mean of its two rows and φ_tt that of its two columns.
///
/// The field equation of ℓ = ½φ_t² − ½φ_x² + cos φ − 1:
///
///     (phi(j+1,i-1) + 2*phi(j+1,i) + phi(j+1,i+1) - 2*phi(j,i-1) - 4*phi(j,i) - 2*phi(j,i+1) + phi(j-1,i-1) +
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*h^2)
///       - (phi(j+1,i-1) - 2*phi(j+1,i) + phi(j+1,i+1) + 2*phi(j,i-1) - 4*phi(j,i) + 2*phi(j,i+1) + phi(j-1,i-1) -
///           2*phi(j-1,i) + phi(j-1,i+1))/(4*k^2) + sin((phi(j+1,i) + phi(j+1,i+1) + phi(j,i) + phi(j,i+1))/4)/4
///       + sin((phi(j+1,i-1) + phi(j+1,i) + phi(j,i-1) + phi(j,i))/4)/4
///       + sin((phi(j,i) + phi(j,i+1) + phi(j-1,i) + phi(j-1,i+1))/4)/4
///       + sin((phi(j,i-1) + phi(j,i) + phi(j-1,i-1) + phi(j-1,i))/4)/4 = 0
inline constexpr struct NineTuple {
  static constexpr JetTable<9, 4> table = [] {
    JetTable<9, 4> result{shapes::nine_tuple, 1, {}};
    int q = 0;
    for (int dt : {-1, 0})
      for (int dx : {-1, 0}) {
        QuadraturePoint<9>& point = result.quadrature[q++];
        point.weight = .25;
        for (std::size_t l = 0; l < 9; ++l) {
          const Site v = shapes::nine_tuple.vertex(static_cast<int>(l)) - Site{dt, dx};
          const bool in_rows = v.time == 0 || v.time == 1, in_columns = v.space == 0 || v.space == 1;
          const Site centre = shapes::nine_tuple.vertex(static_cast<int>(l));
          if (in_rows) point.phi_xx[l] = centre.space == 0 ? -1 : .5;
          if (in_columns) point.phi_tt[l] = centre.time == 0 ? -1 : .5;
          if (!in_rows || !in_columns) continue;
          point.phi[l] = .25;
          point.phi_t[l] = v.time == 1 ? .5 : -.5;
          point.phi_x[l] = v.space == 1 ? .5 : -.5;
          point.phi_tx[l] = v.time == v.space ? 1 : -1;
        }
      }
    return result;
  }();
} nine_tuple;

}  // namespace delf
