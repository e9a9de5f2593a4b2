// SPDX-License-Identifier: MIT
#include "jets/tables/wall_tables.hpp"

#include <vector>

#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/named_tables.hpp"
#include "jets/tables/point_jets.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "jets/tables/tuple_jets.hpp"
#include "lattice/index.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

/// (5.9) as printed: φ_t on the left edge alone.
const StencilTable printed_rectangle = stencil_table(
    JetTable<4, 1>{shapes::rectangle, 1, {{{1, {.25, .25, .25, .25}, {-1, 1, 0, 0}, {-.5, -.5, .5, .5}}}}});

/// Shares of a cell that the potential and the kinetic term have in a column of a table's cells.
struct Shares {
  double potential = 0, kinetic = 0;
};
Shares shares(const StencilTable& table, int column) {
  Shares sum;
  for (const TablePoint& p : table.points) {
    // ½φ_t² at φ_t = 1: what the column's values of the next row contribute to it
    for (const auto& e : p[JetSlot::phi])
      if (table.pattern.vertices[e.vertex].space == column) sum.potential += p.weight * e.weight;
    for (const auto& e : p[JetSlot::phi_t]) {
      const Site v = table.pattern.vertices[e.vertex];
      if (v.space == column && v.time == 1) sum.kinetic += p.weight * e.weight;
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("with its terms at natural walls a wall has half a cell's kinetic and half a cell's potential term") {
  const std::vector<StencilTable> tables{stencil_table(Triangle::table), stencil_table(TriangleVertex::table),
                                         printed_rectangle};
  for (const StencilTable& table : tables) {
    const std::vector<StencilTable> terms = wall_tables(table);
    REQUIRE(terms.size() == 2);
    CHECK(terms[0].pattern.placement == Placement::left_wall);
    CHECK(terms[1].pattern.placement == Placement::right_wall);
    for (const int wall : {0, 1}) {
      const Shares inside = shares(table, wall), term = shares(terms[at(wall)], 0);
      CHECK(inside.kinetic != Approx(0.5));  // the check can fail
      CHECK(inside.kinetic + term.kinetic == Approx(0.5));
      CHECK(inside.potential + term.potential == Approx(0.5));
      for (const TablePoint& p : terms[at(wall)].points) CHECK(p[JetSlot::phi_x].empty());
    }
  }
}

TEST_CASE("what the walls of the triangles lack: a half of the kinetic term, and a sixth or a half of the potential") {
  const auto of_wall = [](const StencilTable& table, std::size_t wall) {
    return shares(wall_tables(table).at(wall), 0);
  };
  for (const auto& [table, potential] :
       {std::pair{stencil_table(Triangle::table), 1. / 6}, std::pair{stencil_table(TriangleVertex::table), .5},
        std::pair{printed_rectangle, 0.}}) {
    CHECK(of_wall(table, 0).kinetic == Approx(-.5));
    CHECK(of_wall(table, 1).kinetic == Approx(.5));
    CHECK(of_wall(table, 0).potential == Approx(-potential).margin(1e-15));
    CHECK(of_wall(table, 1).potential == Approx(potential).margin(1e-15));
  }
}

TEST_CASE("tables whose columns are alike, wide ones, bricks and time lattices have no terms at walls") {
  for (const StencilTable& table :
       {stencil_table(Rectangle::table), stencil_table(RectangleSymmetric::table), stencil_table(Hexagon::table),
        stencil_table(SixTuple::table), stencil_table(NineTuple::table), stencil_table(Vertex::table)})
    CHECK(wall_tables(table).empty());
}
