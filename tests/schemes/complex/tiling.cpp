// SPDX-License-Identifier: MIT
#include "schemes/complex/tiling.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/space/mesh_topology.hpp"
#include "schemes/complex/refined_piece.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/stencil_lists.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

/// Rows of four sites around a circle, at t = 0, 1, 2 and so on, with all rectangles or all triangles of a lattice between.
StencilList rows(const std::string& shape, int count = 3, int sites = 4) {
  StencilList list;
  list.circumference = sites;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < sites; ++i)
      list.sites.push_back({{1.0 * j, 1.0 * i, 0, 0},
                            j == 0           ? SiteRole::given
                            : j == 1         ? SiteRole::initial
                            : j == count - 1 ? SiteRole::final
                                             : SiteRole::free,
                            100 + sites * j + i});
  for (int j = 0; j + 1 < count; ++j)
    for (int i = 0; i < sites; ++i) {
      const int a = j * sites + i, b = j * sites + (i + 1) % sites;
      if (shape != "rectangle") list.stencils.push_back({shape, {a, a + sites, b + sites}});
      else list.stencils.push_back({shape, {a, a + sites, b + sites, b}});
      list.stencils.back().line = 200 + a;
    }
  return list;
}

TEST_CASE("lists whose stencils tile have no fault and no gap, whatever their shapes") {
  for (const StencilList& list :
       {rows("rectangle"), rows("triangle", 5), rows("triangle-vertex", 4), bent_rows(9, 9), bent_rows(17, 11, 0),
        refined_piece(18, 5, 36, 20), beam_rows(16, 5, 6.28, 0.05, [](int i) { return 6.28 * i / 16; })}) {
    REQUIRE_FALSE(find_fault(list));
    const Tiling tiling = tiling_of(list);
    INFO((tiling.fault ? tiling.fault->what : ""));
    CHECK_FALSE(tiling.fault);
    CHECK(tiling.gaps.empty());
  }
  const Tiling circle = tiling_of(rows("rectangle"));
  CHECK(circle.area == Approx(8));
  REQUIRE(circle.cells);
  CHECK(in_words(topology(*circle.cells), 2) == "Euler characteristic 0, 2 boundary curves");
  CHECK_FALSE(tiling_of(rows("triangle")).cells);  // each stands for twice its own area
  CHECK(tiling_of(rows("triangle")).area == Approx(8));
  CHECK(in_words(topology(*tiling_of(refined_piece(18, 5, 36, 20)).cells), 2) ==
        "Euler characteristic 1, 1 boundary curve");
}

TEST_CASE("natural walls, straight or bent, and a complex that ends in steps at sites without equations have no gap") {
  StencilList list = bent_rows(9, 9, 0);
  for (std::size_t s = 0; s < list.sites.size(); ++s)
    if (list.sites[s].role == SiteRole::given && s >= 9)
      list.sites[s].role = s < 18 ? SiteRole::initial : SiteRole::free;
  for (int j = 0; j < 9; ++j) {
    list.sites[9 * j].position[1] += 0.02 * j * j / 9;
    list.sites[9 * j + 8].position[1] -= 0.01 * j;
  }
  REQUIRE_FALSE(find_fault(list));
  CHECK_FALSE(tiling_of(list).fault);
  CHECK(tiling_of(list).gaps.empty());
}

TEST_CASE("a stencil that is missing, in excess, or stands for a wrong share is found, by line") {
  for (const auto& [share, words] : {std::pair(7.0, "stands for 7 of its area"), {0.9, "stands for 1 of its area"}}) {
    StencilList list = rows("rectangle");
    list.stencils[7].share = share;
    const Tiling wrong = tiling_of(list);
    REQUIRE(wrong.fault);
    CHECK_THAT(wrong.fault->what, Catch::Contains("do not tile") && Catch::Contains(words));
    if (share > 1) CHECK(wrong.fault->line == 207);
  }
  StencilList list = rows("rectangle");
  list.stencils.push_back({"triangle", {0, 4, 5}, {}, 300});
  REQUIRE(tiling_of(list).fault);
  CHECK(tiling_of(list).fault->line == 300);
  list.stencils.resize(7);
  const Tiling gap = tiling_of(list);
  CHECK_FALSE(gap.fault);
  REQUIRE(gap.gaps.size() == 2);
  CHECK_THAT(gap.gaps[0], Catch::StartsWith("stencils cover 0.75 of the surroundings of site 4 (t = 1, x = 0)"));
  // triangles that stand for the whole cells of a lattice: one for half of its cell, and one for two
  list = rows("triangle", 5);
  list.stencils[9].share = 0.5;
  CHECK_FALSE(tiling_of(list).gaps.empty());
  list.stencils[9].share = 2;
  REQUIRE(tiling_of(list).fault);
  CHECK(tiling_of(list).fault->line == list.stencils[9].line);
}

TEST_CASE("stencils that lie on each other without a site in common are found, also across the seam of a circle") {
  for (const double moved : {0.3, 3.6}) {
    StencilList list = rows("rectangle");
    const StencilList other = rows("rectangle");
    const int count = static_cast<int>(list.sites.size());
    for (StencilList::Site site : other.sites) {
      site.position[1] += moved, site.role = SiteRole::given;
      list.sites.push_back(site);
    }
    list.stencils.push_back({"rectangle", {count, count + 4, count + 5, count + 1}, {}, 300});
    const Tiling tiling = tiling_of(list);
    REQUIRE(tiling.fault);
    CHECK(tiling.fault->line == 300);
    CHECK_THAT(tiling.fault->what, Catch::StartsWith("stencil 8 (rectangle) overlaps stencil"));
  }
}

}  // namespace
