// SPDX-License-Identifier: MIT
#include "lattice/complex/complex_plan.hpp"

#include <algorithm>
#include <array>

#include "lattice/error.hpp"
#include "tests/catch.hpp"

namespace {

using namespace delf;

/// Rows of N sites round a circle, two of them data, and stencils that couple all their sites or only time neighbours.
Complex rows(int sites, int steps, bool explicit_) {
  Complex complex;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i < sites; ++i)
      complex.add_site({0.1 * j, 1.0 * i, 0, 0}, j == 0       ? SiteRole::given
                                                 : j == 1     ? SiteRole::initial
                                                 : j == steps ? SiteRole::final
                                                              : SiteRole::free);
  const int triangle = complex.add_shape({3, {1, 1, 1, 1, 1, 0, 1, 0, 1}}), rectangle = complex.add_shape({4, {}});
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < sites; ++i) {
      const int a = j * sites + i, b = j * sites + (i + 1) % sites;
      if (explicit_) complex.add_stencil(triangle, std::array{a, a + sites, b});
      else complex.add_stencil(rectangle, std::array{a, b, b + sites, a + sites});
    }
  return complex;
}

ComplexPlan planned(const Complex& complex) { return make_plan(complex, Touching(complex)); }

TEST_CASE("a plan of rows as a complex has one level a row, explicit or in one block") {
  CHECK(planned(rows(9, 5, true)).describe() == "4 levels, 36 unknowns, each in a block of its own");
  CHECK(planned(rows(9, 5, false)).describe() == "4 levels, 36 unknowns in 4 blocks, the largest of 9");
  // every block comes after those that its equations need
  const Complex complex = rows(9, 5, true);
  const ComplexPlan plan = planned(complex);
  for (std::size_t n = 0; n < plan.unknowns.size(); ++n) CHECK(plan.unknowns[n] == plan.equations[n] + 9);
  CHECK(std::is_sorted(plan.level.begin(), plan.level.end()));
}

TEST_CASE("a complex with data all round is one block") {
  Complex complex;
  const int n = 6, square = complex.add_shape({4, {}});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      complex.add_site({0, 1.0 * i, 1.0 * j, 0},
                       i % (n - 1) == 0 || j % (n - 1) == 0 ? SiteRole::given : SiteRole::free);
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i)
      complex.add_stencil(square, std::array{j * n + i, j * n + i + 1, j * n + i + n + 1, j * n + i + n});
  CHECK(planned(complex).describe() == "one block of 16 unknowns");
}

TEST_CASE("an ill-posed complex names the sites that have too much or too little") {
  Complex complex = rows(6, 4, true);
  SECTION("a value is data twice over: an equation has nothing left to determine") {
    complex.set_role(2 * 6 + 3, SiteRole::initial);
    CHECK_THROWS_WITH(planned(complex),
                      Catch::Contains("more equations than unknowns at") && Catch::Contains("site 9 at"));
  }
  SECTION("an equation is missing: the value above it is not determined") {
    complex.set_role(6 + 3, SiteRole::given);
    CHECK_THROWS_WITH(planned(complex), Catch::Contains("no equation is left") && Catch::Contains("site 15 at"));
  }
}

TEST_CASE("the largest matching is found where the greedy start is wrong") {
  // row 0 takes column 1, which is the only one of row 1
  Incidence graph{.columns = 2, .first = {0, 2, 3}, .entries = {0, 1, 1}};
  const Matching matching = largest_matching(graph);
  CHECK(matching.is_perfect());
  CHECK(matching.column_of == std::vector<std::int32_t>{0, 1});
  Incidence poor{.columns = 3, .first = {0, 1, 2, 4}, .entries = {0, 0, 1, 2}};
  const IllPosed parts = ill_posed_parts(poor, largest_matching(poor));
  CHECK(parts.rows == std::vector<std::int32_t>{0, 1});
  CHECK(parts.columns == std::vector<std::int32_t>{1, 2});
}

}  // namespace
