// SPDX-License-Identifier: MIT
#include "schemes/solvers/sitewise_lu.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "lattice/index.hpp"
#include "tests/catch.hpp"

namespace {

using namespace delf;
using Matrix = SitewiseLU::Matrix;
using Vector = SitewiseLU::Vector;

/// Two fields and a multiplier at each site of a square, as a saddle: the diagonal of multipliers is zero. Numbers of
/// equations and of unknowns are shuffled.
struct Saddle {
  explicit Saddle(int n, double slope = 1) : A(3 * n * n, 3 * n * n) {
    std::vector<int> row(3 * n * n), column;
    for (std::size_t u = 0; u < row.size(); ++u) row[u] = static_cast<int>(u);
    column = row;
    std::mt19937 seed(4);
    std::ranges::shuffle(row, seed), std::ranges::shuffle(column, seed);
    of_equations.resize(row.size()), of_unknowns.resize(row.size());
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int i, int m, double value) { entries.emplace_back(row[i], column[m], value); };
    for (int s = 0; s < n * n; ++s) {
      for (int a = 0; a < 3; ++a) {
        of_equations[at(row[3 * s + a])] = s;
        of_unknowns[at(column[3 * s + a])] = s;
      }
      for (int a = 0; a < 2; ++a) {
        add(3 * s + a, 3 * s + a, 4);
        if (s % n > 0) add(3 * s + a, 3 * (s - 1) + a, -1), add(3 * (s - 1) + a, 3 * s + a, -1);
        if (s >= n) add(3 * s + a, 3 * (s - n) + a, -1), add(3 * (s - n) + a, 3 * s + a, -1);
        const double g = slope * (a == 0 ? std::cos(0.3 * s) : std::sin(0.3 * s));
        add(3 * s + a, 3 * s + 2, g), add(3 * s + 2, 3 * s + a, g);
      }
    }
    A.setFromTriplets(entries.begin(), entries.end());
  }
  Matrix A;
  std::vector<int> of_equations, of_unknowns;
};

}  // namespace

TEST_CASE("saddles with a multiplier at each site are solved place by place, and a singular one is told") {
  constexpr int n = 20;
  const Saddle saddle(n);
  SitewiseLU lu(saddle.of_equations, saddle.of_unknowns);
  REQUIRE(lu.factorize(saddle.A));
  Vector x(3 * n * n);
  for (Eigen::Index u = 0; u < x.size(); ++u) x[u] = std::sin(1.0 + static_cast<double>(u * u));
  CHECK((lu.solve(saddle.A * x) - x).lpNorm<Eigen::Infinity>() < 1e-11);
  Matrix other = 2 * saddle.A;  // of the same pattern
  REQUIRE(lu.factorize(other));
  CHECK((lu.solve(saddle.A * x) - 0.5 * x).lpNorm<Eigen::Infinity>() < 1e-11);
  CHECK_FALSE(lu.factorize(Saddle(n, 0).A));  // multipliers without a constraint
}
