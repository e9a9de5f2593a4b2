// SPDX-License-Identifier: MIT
#pragma once
#include "jets/tables/jet_table.hpp"
#include "lattice/shapes/nine_tuple.hpp"
#include "lattice/shapes/six_tuple.hpp"

namespace delf {

/// First-order jets on the six-tuple ◫ (vertices 0 1 2 below, 5 4 3 above): φ and φ_t on the middle edge, φ_x on the
/// left and on the right half.
inline constexpr struct SixTuple {
  static constexpr JetTable<6, 2> table{shapes::six_tuple,
                                        1,
                                        {{{.5, {0, .5, 0, 0, .5, 0}, {0, -1, 0, 0, 1, 0}, {-.5, .5, 0, 0, .5, -.5}},
                                          {.5, {0, .5, 0, 0, .5, 0}, {0, -1, 0, 0, 1, 0}, {0, -.5, .5, .5, -.5, 0}}}}};
} six_tuple;

/// First-order jets on the nine-tuple ⊞: the symmetric rectangle's jet in each of its four cells.
inline constexpr struct NineTuple {
  static constexpr JetTable<9, 4> table = [] {
    JetTable<9, 4> result{shapes::nine_tuple, 1, {}};
    int q = 0;
    for (int dt : {-1, 0})
      for (int dx : {-1, 0}) {
        QuadraturePoint<9>& point = result.quadrature[static_cast<std::size_t>(q++)];
        point.weight = .25;
        for (std::size_t l = 0; l < 9; ++l) {
          const Site v = shapes::nine_tuple.vertex(static_cast<int>(l)) - Site{dt, dx};
          if (v.time < 0 || v.time > 1 || v.space < 0 || v.space > 1) continue;
          point.phi[l] = .25;
          point.phi_t[l] = v.time == 1 ? .5 : -.5;
          point.phi_x[l] = v.space == 1 ? .5 : -.5;
        }
      }
    return result;
  }();
} nine_tuple;

}  // namespace delf
