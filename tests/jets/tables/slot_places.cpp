// SPDX-License-Identifier: MIT
#include "jets/tables/slot_places.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/named_tables.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "jets/tables/tuple_jets.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

std::size_t points_for(const StencilTable& table, const std::string& density) {
  return with_slot_places(table, *expression(density)).points.size();
}

}  // namespace

TEST_CASE("a slot lies where its weights are a derivative to second order") {
  const StencilTable table = stencil_table(Triangle::table);
  const auto place = [&](JetSlot slot) {
    const NodePosition at = place_of(table, table.points[0], slot);
    return std::pair{at.time, at.space};
  };
  CHECK(place(JetSlot::phi).first == Approx(2. / 3));
  CHECK(place(JetSlot::phi).second == Approx(1. / 3));
  CHECK(place(JetSlot::phi_t) == std::pair{0.5, 0.0});
  CHECK(place(JetSlot::phi_x) == std::pair{1.0, 0.5});
  const StencilTable nine = stencil_table(NineTuple::table);
  NodePosition mean;
  for (const TablePoint& p : nine.points) {
    const NodePosition at = place_of(nine, p, JetSlot::phi_xx);
    mean.time += p.weight * at.time, mean.space += p.weight * at.space;
  }
  CHECK(std::abs(mean.time) + std::abs(mean.space) < 1e-15);
}

TEST_CASE("only triangles are cut, and only where a derivative goes with a function of t or x") {
  const StencilTable triangles = stencil_table(Triangle::table);
  CHECK(points_for(triangles, "0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi)") == 1);
  CHECK(points_for(triangles, "0.5*phi_t^2 - 0.5*phi_x^2 + sin(x + t)*cos(phi)") == 1);
  CHECK(points_for(triangles, "0.5*phi_t^2 - 0.5*(1 + x^2)*phi_x^2 + cos(phi)") == 3);
  CHECK(points_for(triangles, "exp(t)*(0.5*phi_t^2 - 0.5*phi_x^2)") == 5);
  CHECK(points_for(triangles, "0.5*phi_t^2 - 0.5*phi_x^2 + t*phi_t*phi_x") == 3);
  CHECK(points_for(triangles, "0.5*phi_t^2 - (1 + x^2)/phi_x") == 1);  // which has no value at phi_x = 0
  for (const NamedTable& named : named_tables())
    if (!named.is_for_point() && !named.name.starts_with("triangle")) {
      INFO(named.name);
      CHECK(points_for(named.table, "exp(t - x)*(0.5*phi_t^2 - 0.5*phi_x^2 - phi^4)") == named.table.points.size());
    }
}

TEST_CASE("the points of a cut sum to the stencil's own, and cutting again changes nothing") {
  const auto density = expression("exp(t - x)*(0.5*phi_t^2 - 0.5*phi_x^2 - phi^4)");
  const StencilTable cut = with_slot_places(stencil_table(Triangle::table), *density);
  double weight = 0;
  for (const TablePoint& p : cut.points) {
    weight += p.weight;
    if (!p[JetSlot::phi_t].empty()) CHECK(std::pair{p.time, p.space} == std::pair{0.5, 0.0});
    if (!p[JetSlot::phi_x].empty()) CHECK(std::pair{p.time, p.space} == std::pair{1.0, 0.5});
  }
  CHECK(weight == Approx(1));
  CHECK(with_slot_places(cut, *density).points.size() == cut.points.size());
}
