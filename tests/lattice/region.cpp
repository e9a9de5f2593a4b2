// SPDX-License-Identifier: MIT
#include "lattice/region.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <span>

#include "lattice/error.hpp"
#include "lattice/region_shapes.hpp"
#include "lattice/shapes/hexagon.hpp"
#include "lattice/shapes/nine_tuple.hpp"
#include "lattice/shapes/rectangle.hpp"
#include "lattice/shapes/six_tuple.hpp"
#include "lattice/shapes/triangle.hpp"
#include "tests/catch.hpp"
#include "tests/lattice/plan/systems.hpp"

using namespace delf;
using testing::pick;

namespace {

using Sites = std::set<Site>;

enum class Mistake { none, one_family_only, closure_of_all, boundary_of_all, stencils_through_walls };

struct Definition {
  Sites interior, closure, boundary;
  int inside = 0;  // how many Δ ⊂ U

  friend bool operator==(const Definition&, const Definition&) = default;
};

/// §5.1 word for word, from the list of all stencils near U.
Definition by_definition(const Lattice& lattice, const std::vector<StencilPattern>& families, const Sites& U,
                         Mistake mistake = Mistake::none) {
  std::vector<Sites> stencils;
  const int N = lattice.sites();
  for (const StencilPattern& family : families) {
    for (int j = -4; j <= 12; ++j)
      for (int i = lattice.is_circle() ? 0 : -4; i < (lattice.is_circle() ? N : N + 4); ++i) {
        if (family.placement == Placement::brick_wall && ((i + j) & 1)) continue;
        Sites stencil;
        bool exists = true;
        for (const Site v : family.vertices) {
          int space = i + v.space;
          if (lattice.is_circle()) space = (space + 10 * N) % N;
          exists = exists && space >= 0 && space < N;
          stencil.insert({j + v.time, space});
        }
        if (exists || mistake == Mistake::stencils_through_walls) stencils.push_back(stencil);
      }
    if (mistake == Mistake::one_family_only) break;
  }
  const auto within_U = [&](const Sites& s) { return std::ranges::includes(U, s); };

  Definition d;
  for (const Site site : U) {
    int touching = 0, held = 0;
    for (const Sites& s : stencils)
      if (s.contains(site)) ++touching, held += within_U(s);
    if (touching > 0 && held == touching) d.interior.insert(site);
  }
  for (const Sites& s : stencils) {
    const bool meets = std::ranges::any_of(s, [&](Site site) { return d.interior.contains(site); });
    if (meets || (mistake == Mistake::closure_of_all && within_U(s))) d.closure.insert(s.begin(), s.end());
    d.inside += within_U(s);
  }
  for (const Site site : U)
    if ((d.closure.contains(site) || mistake == Mistake::boundary_of_all) && !d.interior.contains(site))
      d.boundary.insert(site);
  return d;
}

/// {Δ ⊂ U}
std::vector<Stencil> stencils_of(const Region& U) {
  std::vector<Stencil> found;
  U.visit_stencils(
      [&](int family, Site anchor, std::span<const std::size_t>) { found.push_back(*U.all().find(family, anchor)); });
  return found;
}

Definition by_region(const Region& region) {
  const auto set = [](const std::vector<Site>& sites) { return Sites(sites.begin(), sites.end()); };
  return {set(region.interior()), set(region.closure()), set(region.boundary()),
          static_cast<int>(stencils_of(region).size())};
}

struct Example {
  Lattice lattice = Lattice::circle(8, 1);
  std::vector<StencilPattern> families;
  Sites U;
};

Example random_example(std::mt19937& random) {
  Example example;
  const int N = 2 * pick(random, 1, 5);
  if (pick(random, 0, 1) == 0) example.lattice = Lattice::circle(N, 1);
  else example.lattice = Lattice::interval(N + pick(random, 0, 1), 1);
  const std::vector<StencilPattern> known = {StencilPattern(shapes::triangle),
                                             StencilPattern(shapes::rectangle),
                                             StencilPattern(shapes::hexagon),
                                             StencilPattern(shapes::six_tuple),
                                             StencilPattern(shapes::nine_tuple),
                                             testing::random_pattern(random, Placement::every_site),
                                             testing::random_pattern(random, Placement::brick_wall)};
  for (int n = pick(random, 1, 3); n > 0; --n) example.families.push_back(known[pick(random, 0, 6)]);
  // mostly full, so that there is an interior
  for (int j = 0; j <= 7; ++j)
    for (int i = 0; i < example.lattice.sites(); ++i)
      if (pick(random, 0, 12) > 0) example.U.insert({j, i});
  return example;
}

Region region_of(const Example& e) { return Region::from_sites(e.lattice, e.families, {e.U.begin(), e.U.end()}); }

}  // namespace

TEST_CASE("interior, closure, boundary and the stencils inside are those of the definition, on random regions") {
  std::mt19937 random(11);
  int interiors = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Example e = random_example(random);
    const Region U = region_of(e);
    const Definition d = by_definition(e.lattice, e.families, e.U);
    REQUIRE(by_region(U) == d);
    CHECK(U.regular() == (d.interior.size() + d.boundary.size() == e.U.size()));
    interiors += !d.interior.empty();
  }
  CHECK(interiors > 100);
}

TEST_CASE("the comparison can fail: a definition with one mistake differs") {
  for (const Mistake mistake :
       {Mistake::one_family_only, Mistake::closure_of_all, Mistake::boundary_of_all, Mistake::stencils_through_walls}) {
    std::mt19937 random(11);
    int different = 0;
    for (int trial = 0; trial < 50; ++trial) {
      const Example e = random_example(random);
      different += !(by_region(region_of(e)) == by_definition(e.lattice, e.families, e.U, mistake));
    }
    CHECK(different > 3);
  }
}

TEST_CASE("the rows j = 0, 1, 2 of a circle are regular, with interior j = 1 (Fig. 5.3)") {
  const auto row = [](int j) {
    std::vector<Site> sites;
    for (int i = 0; i < 10; ++i) sites.push_back({j, i});
    return sites;
  };
  const Region U = Region::rectangle(Lattice::circle(10, 1), {StencilPattern(shapes::triangle)}, {0, 2}, {0, 9});
  CHECK(U.regular());
  CHECK(U.interior() == row(1));
  CHECK(U.boundary().size() == 20);
  CHECK(stencils_of(U).size() == 20);
}

TEST_CASE("3 × 3 sites are not regular for triangles: two corners lie in no triangle that touches the centre") {
  const Region U = Region::rectangle(Lattice::circle(10, 1), {StencilPattern(shapes::triangle)}, {0, 2}, {4, 6});
  CHECK(U.interior() == std::vector<Site>{{1, 5}});
  CHECK(U.boundary() == std::vector<Site>{{0, 4}, {0, 5}, {1, 4}, {1, 6}, {2, 5}, {2, 6}});
  CHECK_FALSE(U.regular());
  CHECK(Region::rectangle(Lattice::circle(10, 1), {StencilPattern(shapes::rectangle)}, {0, 2}, {4, 6}).regular());
}

TEST_CASE("a wall column is interior when U holds the stencils that the interval has") {
  const Region U = Region::rectangle(Lattice::interval(10, 1), {StencilPattern(shapes::rectangle)}, {0, 2}, {0, 2});
  CHECK(U.interior() == std::vector<Site>{{1, 0}, {1, 1}});
}

TEST_CASE("of two families both must be held, and a site that no stencil touches is not interior") {
  const Lattice circle = Lattice::circle(12, 1);
  const StencilPattern triangle(shapes::triangle), wide(std::vector<Site>{{0, 0}, {0, 3}});
  CHECK(Region::rectangle(circle, {triangle}, {0, 2}, {0, 4}).interior().size() == 3);
  CHECK(Region::rectangle(circle, {triangle, wide}, {0, 2}, {0, 4}).interior().empty());
  CHECK(Region::rectangle(circle, {triangle, wide}, {0, 2}, {0, 6}).interior() == std::vector<Site>{{1, 3}});

  const StencilPattern bricks({{0, 0}, {1, 0}}, Placement::brick_wall);
  const Region column = Region::rectangle(circle, {bricks}, {0, 3}, {0, 0});
  CHECK(column.interior().size() == 4);
}

TEST_CASE("stencils that are listed have the regions of the pattern that they repeat, and data are at the boundary") {
  std::mt19937 random(3);
  int interiors = 0;
  for (int trial = 0; trial < 50; ++trial) {
    Example e = random_example(random);
    std::erase_if(e.families, [](const StencilPattern& p) { return p.placement == Placement::brick_wall; });
    if (e.families.empty()) continue;
    // The columns of a pattern's vertices, in the order of their vertices, are the places of a list.
    std::vector<StencilPattern> places;
    std::vector<ListedStencils> lists;
    const Stencils repeated(e.lattice, e.families);
    for (int f = 0; f < std::ssize(e.families); ++f) {
      std::vector<std::int32_t> sites;
      const int vertices = e.families[f].size();
      for (int i = e.lattice.is_circle() ? 0 : -8; i < e.lattice.sites() + (e.lattice.is_circle() ? 0 : 8); ++i)
        if (const auto stencil = repeated.find(f, {0, i}))
          for (const Site site : stencil->sites) sites.push_back(site.space);
      lists.emplace_back(vertices, std::move(sites), e.lattice.sites());
      places.push_back(e.families[f]);
      for (int l = 0; l < vertices; ++l) places.back().vertices[l].space = l;
    }
    std::vector<const ListedStencils*> listed;
    for (const ListedStencils& list : lists) listed.push_back(&list);
    const Stencils all(e.lattice, places, listed);
    const std::vector<Site> sites(e.U.begin(), e.U.end());
    const Region U = region_of(e);
    CHECK(by_region(Region::from_sites(all, sites)) == by_region(U));
    for (const Site site : {Site{3, 0}, Site{4, 1}}) {
      CHECK(all.touching(site).size() == repeated.touching(site).size());
      CHECK(region_around(all, {site}).sites() == region_around(repeated, {site}).sites());
    }

    const auto is_data = [](Site site) { return site.space == 0; };
    const Region with_data = Region::from_sites(all, sites, is_data);
    std::vector<Site> expected = U.interior();
    std::erase_if(expected, is_data);
    CHECK(with_data.interior() == expected);
    interiors += !expected.empty();
    std::mt19937_64 draws(trial);
    const std::vector<Site> connected = draw_connected(with_data, 5, draws);
    CHECK(connected.empty() == expected.empty());
    CHECK(std::ranges::all_of(connected, [&](Site site) { return with_data.in_interior(site); }));
    CHECK(std::set<Site>(connected.begin(), connected.end()).size() == connected.size());
  }
  CHECK(interiors > 10);
}

TEST_CASE("a rectangle may run past x = 0") {
  const Lattice circle = Lattice::circle(10, 1);
  const std::vector<StencilPattern> families{StencilPattern(shapes::rectangle)};
  const Region across = Region::rectangle(circle, families, {0, 3}, {8, 12});
  CHECK(across.sites().size() == 20);
  CHECK(across.contains(Site{1, -1}));
  CHECK(across.in_interior({1, 10}));
}

TEST_CASE("a region outside the interval is refused") {
  CHECK_THROWS_AS(Region::from_sites(Lattice::interval(5, 1), {StencilPattern(shapes::triangle)}, {{0, 5}}), BadInput);
  CHECK_THROWS_AS(Region::from_sites(Lattice::circle(5, 1), {StencilPattern(shapes::hexagon)}, {{0, 0}}), BadInput);
  CHECK(Region::from_sites(Lattice::circle(5, 1), {StencilPattern(shapes::triangle)}, {}).regular());
}
