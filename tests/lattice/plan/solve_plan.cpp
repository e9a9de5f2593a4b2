// SPDX-License-Identifier: MIT
#include "lattice/plan/solve_plan.hpp"

#include <chrono>
#include <cstdlib>
#include <string>

#include "lattice/error.hpp"
#include "lattice/shapes/hexagon.hpp"
#include "lattice/shapes/nine_tuple.hpp"
#include "lattice/shapes/rectangle.hpp"
#include "lattice/shapes/six_tuple.hpp"
#include "lattice/shapes/triangle.hpp"
#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::coupled;
using testing::dense;

namespace {

const Lattice circle = Lattice::circle(256, 40);
const Lattice fixed_walls = Lattice::interval(256, 40);
const Lattice natural_walls = Lattice::interval(256, 40, Wall::natural, Wall::natural);

struct Refusal {
  std::string key, message;
};
Refusal refused(const Lattice& lattice, const SystemPattern& system) {
  try {
    make_plan(lattice, system);
  } catch (const BadInput& error) {
    return {error.key(), error.what()};
  }
  return {"accepted", ""};
}

bool says(const Refusal& refusal, const std::string& words) { return refusal.message.find(words) != std::string::npos; }

void check_band(const SolvePlan& plan, int lower, int upper, int forward, int backward) {
  CHECK(to_string(plan.kind) == std::string("cyclic-band"));
  CHECK(plan.lower == lower);
  CHECK(plan.upper == upper);
  CHECK(plan.forward == forward);
  CHECK(plan.backward == backward);
  CHECK(plan.history == forward + backward);
  CHECK(plan.own);
  CHECK(plan.one_block());
  CHECK(plan.exceptional.empty());
}

/// The wave equation on triangles: y₁y₂ and y₂y₃ occur in L, y₁y₃ does not.                      above (5.8)
const SystemPattern wave_on_triangles = coupled(shapes::triangle, {{0, 1}, {1, 2}});

}  // namespace

TEST_CASE("on a circle, a shape whose vertices are all coupled is a cyclic band") {
  // (j, i) contains y(j+1, i) and y(j+1, i+1): one diagonal above
  check_band(make_plan(circle, dense(shapes::triangle)), 0, 1, 1, 1);
  check_band(make_plan(circle, dense(shapes::rectangle)), 1, 1, 1, 1);
  check_band(make_plan(circle, dense(shapes::hexagon)), 2, 2, 1, 1);
  check_band(make_plan(circle, dense(shapes::six_tuple)), 2, 2, 1, 1);
  check_band(make_plan(circle, dense(shapes::nine_tuple)), 2, 2, 2, 2);
}

TEST_CASE("with fixed walls the same bands have no corners, and the triangle is a chain from the right") {
  for (const SystemPattern& system : {dense(shapes::rectangle), dense(shapes::hexagon), dense(shapes::nine_tuple)}) {
    const SolvePlan plan = make_plan(fixed_walls, system);
    CHECK(plan.kind == SolveKind::cyclic_band);
    CHECK_FALSE(plan.cyclic);
    CHECK(plan.unknowns == 254);
    CHECK(plan.one_block());
  }
  const SolvePlan chain = make_plan(fixed_walls, dense(shapes::triangle));
  CHECK(chain.kind == SolveKind::chain);
  CHECK((chain.lower == 0 && chain.upper == 1));
  CHECK(chain.blocks == 254);
  CHECK(chain.describe() == "chain, width 0+1, 254 unknowns a slab, leftwards");
}

TEST_CASE("the wave equation on triangles is explicit, and one more coupling makes it implicit") {
  CHECK(make_plan(circle, wave_on_triangles).describe() == "explicit, 256 unknowns a slab");
  CHECK(make_plan(fixed_walls, wave_on_triangles).kind == SolveKind::explicit_);
  CHECK(make_plan(circle, coupled(shapes::triangle, {{0, 1}, {1, 2}, {0, 2}})).kind == SolveKind::cyclic_band);
}

TEST_CASE("a nine-tuple that couples neighbouring rows only, and itself in the middle one, goes forward by one row") {
  std::vector<std::pair<int, int>> pairs;
  for (int l = 0; l < 9; ++l)
    for (int m = 0; m < 9; ++m)
      if (std::abs(l / 3 - m / 3) == 1) pairs.push_back({l, m});
  check_band(make_plan(circle, coupled(shapes::nine_tuple, pairs)), 2, 2, 1, 1);
}

TEST_CASE("at a natural right wall no triangle reaches the next row: its equation is solved at its own row") {
  const SolvePlan plan = make_plan(natural_walls, dense(shapes::triangle));
  REQUIRE(plan.exceptional.size() == 1);
  CHECK(plan.exceptional[0].site == 255);
  CHECK(plan.shift(255) == 0);
  CHECK(plan.offset(255) == 0);
  for (const int site : {0, 1, 100, 253, 254}) {
    CHECK(plan.shift(site) == 1);
    CHECK(plan.offset(site) == 0);
  }
  // it contains y(j, N−2), whose equation contains y(j, N−1): the last two are one block, and the others follow
  CHECK(plan.blocks == 255);
  CHECK((plan.lower == 1 && plan.upper == 1));
  CHECK(make_plan(Lattice::interval(256, 40, Wall::natural, Wall::fixed), dense(shapes::triangle)).exceptional.empty());

  // y₁y₃ left out: only the wall waits, for its neighbour
  const SolvePlan wave = make_plan(natural_walls, wave_on_triangles);
  CHECK(wave.describe() == "chain, width 1+0, 256 unknowns a slab, rightwards");
}

TEST_CASE("other natural walls change nothing, but a brick wall ends in half bricks that fill two rows at once") {
  CHECK(make_plan(natural_walls, dense(shapes::rectangle)).exceptional.empty());
  CHECK(make_plan(natural_walls, dense(shapes::nine_tuple)).exceptional.empty());

  const SolvePlan bricks = make_plan(natural_walls, dense(shapes::hexagon));
  CHECK(bricks.kind == SolveKind::sparse);
  CHECK_FALSE(bricks.table.regular);
  CHECK(bricks.slab(0).unknowns.size() + bricks.slab(1).unknowns.size() == 2 * 256);
}

TEST_CASE("a band that wraps onto itself is sparse") {
  for (const int sites : {2, 3}) {
    CHECK(make_plan(Lattice::circle(sites, 1), dense(shapes::triangle)).kind == SolveKind::sparse);
    CHECK(make_plan(Lattice::circle(sites, 1), dense(shapes::rectangle)).kind == SolveKind::sparse);
  }
  CHECK(make_plan(Lattice::circle(4, 1), dense(shapes::rectangle)).kind == SolveKind::cyclic_band);
  CHECK(make_plan(Lattice::circle(4, 1), dense(shapes::hexagon)).kind == SolveKind::sparse);
  CHECK(make_plan(Lattice::circle(6, 1), dense(shapes::hexagon)).kind == SolveKind::cyclic_band);
  CHECK(make_plan(Lattice::circle(2, 1), wave_on_triangles).kind == SolveKind::explicit_);
  CHECK(make_plan(Lattice::interval(3, 1), dense(shapes::rectangle)).kind == SolveKind::explicit_);
}

TEST_CASE("moving all offsets by a constant changes nothing but the anchors' names") {
  for (const Site away : {Site{3, -7}, Site{-2, 5}, Site{1, 0}}) {
    StencilPattern hexagon(shapes::hexagon), nine(shapes::nine_tuple);
    for (Site& v : hexagon.vertices) v = v + away;
    for (Site& v : nine.vertices) v = v + away;
    for (const Lattice& lattice : {circle, natural_walls}) {
      const auto same = [&](const StencilPattern& pattern, const SystemPattern& unmoved) {
        const SolvePlan moved = make_plan(lattice, system_of(1, {StencilIncidence::dense(pattern)}));
        const SolvePlan plan = make_plan(lattice, unmoved);
        return moved.describe() == plan.describe() && moved.forward == plan.forward && moved.history == plan.history;
      };
      CHECK(same(nine, dense(shapes::nine_tuple)));
      // by an odd number of sites, the bricks of an interval end in other rows at the walls
      CHECK(same(hexagon, dense(shapes::hexagon)));
    }
  }
}

TEST_CASE("decoupled sublattices are separate blocks: gcd(m, N) of them for neighbours m apart on a circle") {
  const auto neighbours = [](int m) {
    return system_of(1, {StencilIncidence::dense(StencilPattern({{0, 0}, {1, 0}, {1, m}, {0, m}}))});
  };
  CHECK(make_plan(Lattice::circle(60, 1), neighbours(2)).blocks == 2);
  CHECK(make_plan(Lattice::circle(61, 1), neighbours(2)).blocks == 1);
  CHECK(make_plan(Lattice::circle(60, 1), neighbours(4)).blocks == 4);
  CHECK(make_plan(Lattice::circle(62, 1), neighbours(4)).blocks == 2);
  CHECK(make_plan(Lattice::interval(61, 1), neighbours(3)).blocks == 3);
}

TEST_CASE("two fields that meet at their sites only: N blocks of two") {
  StencilIncidence family{StencilPattern(shapes::triangle), {}};
  for (int a : {0, 1}) {
    for (int l = 0; l < 3; ++l) family.couplings.push_back({l, l, a, a});
    for (const auto& [l, m] : {std::pair{0, 1}, {1, 2}}) {
      family.couplings.push_back({l, m, a, a});
      family.couplings.push_back({m, l, a, a});
    }
    family.couplings.push_back({0, 1, a, 1 - a, Dependence::nonlinear});
  }
  const SolvePlan plan = make_plan(circle, system_of(2, {family}));
  CHECK(plan.describe() == "cyclic band, width 1+1, 512 unknowns a slab, 256 blocks");
  CHECK(plan.nonlinear_in_slab);
  CHECK_FALSE(plan.linear);
  CHECK(make_plan(Lattice::interval(12, 1), system_of(2, {family})).blocks == 10);
}

TEST_CASE("a constraint's equation is solved for the field, and the field's for the multiplier") {
  // L(φ_j, φ_{j+1}) + λ_j G(φ_{j+1}). The constraint at row j is for φ_{j+1}; the field equation at row j, which also
  // contains φ_{j+1}, is for the multiplier of G(φ_j): λ_{j−1}.
  const StencilIncidence action{StencilPattern(std::vector<Site>{{0, 0}, {1, 0}}),
                                {{0, 0}, {0, 1}, {1, 0}, {1, 1},
                                 {1, 0, 0, 1, Dependence::nonlinear},    // ∂²/∂φ_{j+1}∂λ_j
                                 {0, 1, 1, 0, Dependence::nonlinear}}};  // and its transpose
  for (const Lattice& lattice : {circle, natural_walls}) {
    const SolvePlan plan = make_plan(lattice, system_of(2, {action}));
    CHECK(plan.offset(7, 0) == 0);
    CHECK(plan.offset(7, 1) == -2);
    CHECK(plan.shift(7, 0) == 1);
    CHECK(plan.shift(7, 1) == 1);
    CHECK_FALSE(plan.own);
    CHECK(plan.blocks == 256 * 2);  // φ_J first, then λ_{J−2}
    const Slab slab = plan.slab(5);
    CHECK((slab.unknowns[15] == Node{{3, 7}, 1}));
    CHECK((slab.equations[15] == Node{{4, 7}, 0}));
    CHECK((slab.unknowns[14] == Node{{5, 7}, 0}));
    CHECK((slab.equations[14] == Node{{4, 7}, 1}));
  }
}

TEST_CASE("whether coefficients are constant, and whether those of the slab are, are two questions") {
  const auto action = [](Dependence at_next_row) {
    return system_of(1, {{StencilPattern(std::vector<Site>{{0, 0}, {1, 0}}),
                          {{0, 0, 0, 0, Dependence::nonlinear}, {0, 1, 0, 0, at_next_row}, {1, 0}, {1, 1}}}});
  };
  CHECK_FALSE(make_plan(circle, action(Dependence::linear)).nonlinear_in_slab);
  CHECK_FALSE(make_plan(circle, action(Dependence::linear)).linear);
  CHECK(make_plan(circle, action(Dependence::nonlinear)).nonlinear_in_slab);
  CHECK(make_plan(circle, dense(shapes::triangle)).linear);
  CHECK(make_plan(circle, dense(shapes::triangle, Dependence::nonlinear)).nonlinear_in_slab);
}

TEST_CASE("what nobody determines is refused and named") {
  // φ of component 1 occurs nowhere, and its equation contains component 0 only
  const StencilIncidence nobody{StencilPattern(shapes::rectangle), {{0, 2, 0, 0}, {2, 0, 0, 0}, {1, 3, 1, 0}}};
  const Refusal component = refused(circle, system_of(2, {nobody}));
  CHECK(component.key == "lattice.stencil");
  CHECK(says(component, "determine the unknown of component 1 at every site"));

  const Refusal without = refused(circle, system_of(2, {StencilIncidence::dense(StencilPattern(shapes::rectangle))}));
  CHECK(without.key == "lattice.stencil");
  CHECK(says(without, "component 1 has no equation"));

  // neighbours at i ± 1 only: with natural walls an odd number of sites does not pair up
  SystemPattern pairs{1, 1, Placement::every_site, [](const Lattice& lattice, Site site, int) {
                        std::vector<Coupling> equation;
                        if (site.space > 0) equation.push_back({{1, -1}, 0, Dependence::linear});
                        if (site.space < lattice.sites() - 1) equation.push_back({{1, 1}, 0, Dependence::linear});
                        return equation;
                      }};
  CHECK(refused(natural_walls, pairs).key == "accepted");
  CHECK(refused(Lattice::interval(257, 1, Wall::natural, Wall::natural), pairs).key == "lattice.stencil");

  CHECK(refused(Lattice::interval(2, 1), dense(shapes::rectangle)).key == "lattice.sites");
  CHECK(refused(Lattice::circle(255, 1), dense(shapes::hexagon)).key == "lattice.sites");
  CHECK(refused(circle, SystemPattern{}).key == "lattice.stencil");
}

TEST_CASE("couplings that leave the lattice, the components or the width are refused") {
  const auto only = [](Coupling c) {
    return SystemPattern{1, 1, Placement::every_site, [c](const Lattice&, Site, int) { return std::vector{c}; }};
  };
  CHECK(refused(circle, only({{1, 0}, 0, Dependence::linear})).key == "accepted");
  CHECK(refused(circle, only({{1, 2}, 0, Dependence::linear})).key == "lattice.stencil");
  CHECK(refused(circle, only({{1, 0}, 1, Dependence::linear})).key == "lattice.stencil");
  CHECK(refused(natural_walls, only({{1, 1}, 0, Dependence::linear})).key == "lattice.stencil");
}

TEST_CASE("equations that only follow a characteristic drift from wall to wall, and are refused") {
  const SystemPattern advection = dense(Offsets<2>{{{{0, 0}, {1, 1}}}});
  CHECK(refused(circle, advection).key == "accepted");
  const Refusal drift = refused(natural_walls, advection);
  CHECK(drift.key == "lattice.stencil");
  CHECK(says(drift, "drifts"));
}

TEST_CASE("a plan costs the same for ten sites and ten million") {
  for (const SystemPattern& system : {dense(shapes::triangle), dense(shapes::hexagon), dense(shapes::nine_tuple)}) {
    const auto start = std::chrono::steady_clock::now();
    const SolvePlan ring = make_plan(Lattice::circle(10'000'000, 1), system);
    const SolvePlan plan = make_plan(Lattice::interval(10'000'001, 1, Wall::fixed, Wall::natural), system);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::milliseconds(500));
    CHECK(ring.unknowns == 10'000'000);
    CHECK(plan.unknowns >= 10'000'000);
    CHECK(plan.table.entries.size() < 200);
  }
}

TEST_CASE("a plan says what it does in words") {
  CHECK(make_plan(Lattice::circle(255, 40), dense(shapes::rectangle)).describe() ==
        "cyclic band, width 1+1, 255 unknowns a slab, one block");
  const std::string report = make_plan(natural_walls, dense(shapes::triangle)).report();
  CHECK(report.find("the value at (j, i) is determined by the equation at (j − 1, i)") != std::string::npos);
  CHECK(report.find("site 255: the value at j, the equation at j\n") != std::string::npos);
  CHECK(to_string(SolveKind::explicit_) == std::string("explicit"));
  CHECK(to_string(SolveKind::chain) == std::string("chain"));
  CHECK(to_string(SolveKind::sparse) == std::string("sparse"));
}
