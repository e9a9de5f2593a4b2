// SPDX-License-Identifier: MIT
#include "jets/expressions/stencil_text.hpp"

#include <algorithm>
#include <string>

#include "jets/tables/named_tables.hpp"
#include "lattice/error.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

const std::string three_sites = "(0,0) (1,0) (1,1)";
const std::string triangle_point = "1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1";

StencilTable read(const std::string& sites, const std::string& points) {
  return stencil_of(sites, points, "stencil.sites", "stencil.point");
}
std::string refusal(const std::string& sites, const std::string& points) {
  try {
    read(sites, points);
  } catch (const BadInput& bad) {
    return bad.what();
  }
  return "accepted";
}
void check_says(const std::string& message, const std::string& part) {
  INFO(message);
  CHECK(message.find(part) != std::string::npos);
}
const StencilTable& named(const std::string& name) {
  return std::ranges::find(named_tables(), name, &NamedTable::name)->table;
}

}  // namespace

TEST_CASE("the triangle and the two-point rectangle as text are the built-in tables") {
  const auto same = [](const StencilTable& a, const StencilTable& b) {
    REQUIRE(a.points.size() == b.points.size());
    CHECK(a.pattern.vertices == b.pattern.vertices);
    for (std::size_t q = 0; q < a.points.size(); ++q) {
      CHECK(a.points[q].weight == b.points[q].weight);
      CHECK(a.points[q].time == Approx(b.points[q].time));
      CHECK(a.points[q].space == Approx(b.points[q].space));
      for (std::size_t s = 0; s < jet_slots; ++s) {
        REQUIRE(a.points[q].slots[s].size() == b.points[q].slots[s].size());
        for (std::size_t e = 0; e < a.points[q].slots[s].size(); ++e) {
          CHECK(a.points[q].slots[s][e].vertex == b.points[q].slots[s][e].vertex);
          CHECK(a.points[q].slots[s][e].weight == b.points[q].slots[s][e].weight);
        }
      }
    }
  };
  same(read(three_sites, triangle_point), named("triangle"));
  same(read("(0,0) (1,0) (1,1) (0,1)", "1; phi: 1/4 1/4 1/4 1/4; phi_t: -1/2 1/2 1/2 -1/2; phi_x: -1/2 -1/2 1/2 1/2"),
       named("rectangle-symmetric"));
}

TEST_CASE("the order of consistency is that of the linear equations") {
  for (const char* name : {"triangle", "triangle-vertex", "rectangle-symmetric", "nine-tuple"})
    CHECK(order_of_consistency(named(name)) == 2);
  // four times the difference of neighbours less a third of that of three apart: φ_x of order 4 between rows of one time
  const StencilTable wide =
      read("(0,0) (1,0) (0,-1) (0,1) (0,2)", "1; phi: 1 0 0 0 0; phi_t: -1 1 0 0 0; phi_x: -9/8 0 1/24 9/8 -1/24");
  CHECK(order_of_consistency(wide) == 2);  // φ_t is of second order still
  // one-sided: the slope between sites 0 and 2 for that at 1 and a half, but of weights that are exact on affine fields
  CHECK(order_of_consistency(read("(0,0) (1,0) (0,1) (1,1)",
                                  "1/2; phi: 1 0 0 0; phi_t: -1 1 0 0; phi_x: -1 0 1 0 | "
                                  "1/2; phi: 0 0 0 1; phi_t: 0 0 -1 1; phi_x: 0 -1 0 1")) == 2);
}

TEST_CASE("a stencil that is none is refused with the key and what is wrong") {
  check_says(refusal("0,0 1,0", triangle_point), "stencil.sites: \"0,0 1,0\" is no list of sites");
  check_says(refusal("(0,0)", triangle_point), "fewer than two sites");
  check_says(refusal("(0,0) (0,1)", "1; phi: 1 0"), "all sites lie in one row");
  check_says(refusal("(0,0) (1,0) (1,0)", triangle_point), "names a site twice");
  check_says(refusal("(0,0) (1,0) (1,99)", triangle_point), "more than 16 steps");
  check_says(refusal(three_sites, ""), "no point is given");
  check_says(refusal(three_sites, "1; phi: 1/3 1/3; phi_t: -1 1 0"), "stencil.point: phi has 2 weights for 3 sites");
  check_says(refusal(three_sites, "1; phi 1/3 1/3 1/3"), "gives no slot of a jet");
  check_says(refusal(three_sites, "1; phi: 1/3 1/3 a"), "unknown name a");
  check_says(refusal(three_sites, "1; phi: 1 0 0; phi: 0 1 0"), "phi is given twice");
  check_says(refusal(three_sites, "1; phi: 1/3 1/3 1/2; phi_t: -1 1 0; phi_x: 0 -1 1"),
             "is not consistent: of the field 1, phi finds 1.16667, not 1");
  check_says(refusal(three_sites, "1; phi: 1/3 1/3 1/3; phi_t: -1 0 1; phi_x: 0 -1 1"),
             "of the field x, phi_t finds 1, not 0");
  check_says(refusal(three_sites, "1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 1 -1"),
             "of the field x, phi_x finds -1, not 1");
  check_says(refusal(three_sites, "1/2; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1"), "sum to 0.5, not to 1");
  CHECK(refusal(three_sites, triangle_point) == "accepted");
}
