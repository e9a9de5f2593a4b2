// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_solver.hpp"

#include <cmath>
#include <limits>

#include "lattice/error.hpp"
#include "schemes/complex/spacetime_complex.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/stencil_lists.hpp"
#include "tests/schemes/support.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

/// Pieces of spacetime side by side that share no site: bent rows of as many columns.
StencilList side_by_side(int pieces, int columns) {
  const StencilList one = bent_rows(columns, 4);
  StencilList list;
  for (int p = 0; p < pieces; ++p) {
    for (StencilList::Site site : one.sites) site.position[1] += 4.0 * p, list.sites.push_back(site);
    for (StencilList::Entry e : one.stencils) {
      for (int& s : e.sites) s += p * static_cast<int>(one.sites.size());
      list.stencils.push_back(e);
    }
  }
  return list;
}

std::vector<double> start_of(const StencilList& list) {
  std::vector<double> y;
  for (std::size_t s = 0; s < list.sites.size(); ++s) y.push_back(std::sin(1.7 * static_cast<double>(s)));
  return y;
}

TEST_CASE(
    "a level in parts has the same bits for any number of threads, by divisions, factorisations and Newton's method") {
  Problem problem;
  // columns 3: one unknown a row and piece; 6: blocks of four
  for (const auto& [theory, columns, pieces] : {std::tuple("wave", 3, 100), std::tuple("wave", 6, 100),
                                                std::tuple("sine-gordon", 3, 100), std::tuple("sine-gordon", 6, 100)}) {
    CAPTURE(theory, columns);
    problem.theory = theory;
    const StencilList list = side_by_side(pieces, columns);
    REQUIRE_FALSE(find_fault(list));
    const ComplexSystem system = spacetime_complex(list, theory_named(problem)->shared_density());
    const auto solved = [&](int threads) {
      std::vector<double> y = start_of(list);
      const ComplexSolver solver(system,
                                 {.tolerance = 1e-14, .max_iterations = 50, .threads = threads, .unknowns = 32});
      CHECK(solver.shared_levels() == solver.plan().levels);
      CHECK(solver.plan().widest >= pieces);
      CHECK(solver.is_direct() == (problem.theory == "wave"));
      solver.solve(y);
      return y;
    };
    const std::vector<double> one = solved(1);
    CHECK(largest_residual(system, one) < 1e-13);
    for (const int threads : {2, 3}) CHECK(solved(threads) == one);

    // each piece alone has its values too, within rounding
    const StencilList alone = side_by_side(1, columns);
    const ComplexSystem small = spacetime_complex(alone, theory_named(problem)->shared_density());
    const std::vector<double> start = start_of(list);
    std::vector<double> z(start.end() - static_cast<std::ptrdiff_t>(small.nodes()), start.end());
    ComplexSolver(small).solve(z);
    for (std::size_t n = 0; n < z.size(); ++n) CHECK(std::abs(z[n] - one[one.size() - z.size() + n]) < 1e-10);
  }
}

TEST_CASE("a level that fails leaves y as it was, whichever threads come upon it") {
  Problem problem;
  problem.theory = "sine-gordon";
  const StencilList list = side_by_side(100, 3);
  const ComplexSystem system = spacetime_complex(list, theory_named(problem)->shared_density());
  std::vector<double> start = start_of(list);
  for (const std::size_t piece : {60, 90}) start[piece * 12] = std::numeric_limits<double>::infinity();
  for (const int threads : {1, 3}) {
    std::vector<double> y = start;
    const ComplexSolver solver(system, {.tolerance = 1e-14, .max_iterations = 50, .threads = threads, .unknowns = 32});
    CHECK_THROWS_AS(solver.solve(y), NotFinite);
    CHECK(y == start);
  }
}

}  // namespace
