// SPDX-License-Identifier: MIT
#include "jets/tables/stencil_table.hpp"

#include <cmath>
#include <set>
#include <string>

#include "jets/tables/named_tables.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/spacetime_element.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/scheme.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"

using namespace delf;
using delf::testing::for_each_map;

namespace {

std::vector<StencilTable> tables() {
  std::vector<StencilTable> all;
  for (const NamedTable& named : named_tables()) all.push_back(named.table);
  for (const auto& [time, space] : {std::pair{1, 1}, {2, 2}, {3, 1}})
    for (const TimeQuadrature quadrature : {TimeQuadrature::lobatto, TimeQuadrature::gauss})
      all.push_back(spacetime_element(time, space, quadrature));
  for (int order : {2, 4, 6, 8}) all.push_back(pair_element(splitting_of_order(order), 2));
  return all;
}

/// The stencil of three sites in space and three rows, with all second derivatives.
StencilTable second_order() {
  StencilTable table{.pattern = StencilPattern(shapes::nine_tuple), .points = {}};
  TablePoint point;
  point.set(JetSlot::phi, {0, 0, 0, 0, 1, 0, 0, 0, 0});
  point.set(JetSlot::phi_t, {0, -.5, 0, 0, 0, 0, 0, .5, 0});
  point.set(JetSlot::phi_x, {0, 0, 0, -.5, 0, .5, 0, 0, 0});
  point.set(JetSlot::phi_tt, {0, 1, 0, 0, -2, 0, 0, 1, 0});
  point.set(JetSlot::phi_tx, {.25, 0, -.25, 0, 0, 0, -.25, 0, .25});
  point.set(JetSlot::phi_xx, {0, 0, 0, 1, -2, 1, 0, 0, 0});
  table.points.push_back(point);
  return table;
}

}  // namespace

TEST_CASE("a built-in table becomes one whose sparse slots have its weights, at the places of its points") {
  for_each_map([](auto map) {
    const StencilTable table = stencil_table(map.table);
    REQUIRE(table.points.size() == at(map.table.points));
    CHECK(table.measure == map.table.measure);
    CHECK(table.pattern.size() == map.table.vertices);
    for (int q = 0; q < map.table.points; ++q) {
      const auto& from = map.table.point(q);
      const TablePoint& to = table.points[q];
      CHECK(to.weight == from.weight);
      CHECK(to.time == time_offset(map.table.shape, from));
      CHECK(to.space == space_offset(map.table.shape, from));
      const auto same = [&](JetSlot slot, const auto& weights) {
        auto entry = to[slot].begin();
        for (int l = 0; l < map.table.vertices; ++l)
          if (const double w = weights[l]; w != 0) {
            REQUIRE(entry != to[slot].end());
            CHECK((entry->vertex == l && entry->weight == w));
            ++entry;
          }
        CHECK(entry == to[slot].end());
      };
      same(JetSlot::phi, from.phi), same(JetSlot::phi_t, from.phi_t), same(JetSlot::phi_x, from.phi_x);
      same(JetSlot::phi_tt, from.phi_tt), same(JetSlot::phi_tx, from.phi_tx), same(JetSlot::phi_xx, from.phi_xx);
    }
  });
}

TEST_CASE("every shipped table is consistent, stencils, elements and compositions") {
  for (const StencilTable& table : tables()) CHECK(is_consistent(table));
  CHECK(is_consistent(second_order()));
  std::set<std::string> names;
  for (const NamedTable& named : named_tables()) names.insert(named.name);
  CHECK(names.size() == named_tables().size());
}

TEST_CASE("no alias is the name of a stencil, and none has two meanings on one kind of lattice") {
  std::set<std::pair<std::string, bool>> seen;
  for (const NamedTable& named : named_tables()) {
    CHECK(stencil_name(named.name, named.is_for_point()) == named.name);
    for (const std::string& alias : named.aliases) {
      CAPTURE(alias, named.name);
      CHECK(std::ranges::find(named_tables(), alias, &NamedTable::name) == named_tables().end());
      CHECK(seen.insert({alias, named.is_for_point()}).second);
      CHECK(stencil_name(alias, named.is_for_point()) == named.name);
      CHECK(std::ranges::count(stencil_names_and_aliases(), alias) == 1);
    }
  }
  CHECK(stencil_name("no such stencil", false) == "no such stencil");
}

TEST_CASE("one wrong weight of any slot, point or vertex is found") {
  auto all = tables();
  all.push_back(second_order());
  for (const StencilTable& right : all)
    for (std::size_t q = 0; q < right.points.size(); ++q) {
      StencilTable wrong = right;
      wrong.points[q].weight += 1e-9;
      CHECK_FALSE(is_consistent(wrong));
      for (std::size_t s = 0; s < right.points[q].slots.size(); ++s)
        for (std::size_t e = 0; e < right.points[q].slots[s].size(); ++e) {
          wrong = right;
          wrong.points[q].slots[s][e].weight += 1e-9;
          CHECK_FALSE(is_consistent(wrong));
        }
      for (double TablePoint::*place : {&TablePoint::time, &TablePoint::space}) {
        wrong = right;
        wrong.points[q].*place += 1e-9;
        CHECK_FALSE(is_consistent(wrong));
      }
      for (const JetSlot slot : {JetSlot::phi, JetSlot::phi_t}) {
        wrong = right;
        wrong.points[q].set(slot, {});
        CHECK_FALSE(is_consistent(wrong));
      }
    }
}

TEST_CASE("a scheme refuses a table whose weights are wrong, when it is made") {
  StencilTable table = second_order();
  CHECK_NOTHROW((Scheme{table, SineGordon{}}));
  table.points[0].weight = 0.5;
  CHECK_THROWS_AS((Scheme{table, SineGordon{}}), BadInput);
}
