// SPDX-License-Identifier: MIT
#include "schemes/solvers/linear_solver.hpp"

#include <Eigen/Dense>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Entries = std::vector<MatrixEntry>;

Eigen::MatrixXd dense(int size, const Entries& entries) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  for (const auto& e : entries) A(e.row, e.column) += e.value;
  return A;
}

/// The matrix that is alike at every site of a circle.
Entries uniform(int N, const std::vector<BandEntry>& stencil) {
  Entries entries;
  for (int i = 0; i < N; ++i)
    for (const BandEntry& e : stencil) entries.push_back({i, ((i + e.offset) % N + N) % N, e.value});
  return entries;
}

struct Errors {
  double forward = 0;   ///< against Eigen's dense LU, relative to the largest component
  double backward = 0;  ///< |Aw − r|/(|A||w| + |r|)
};

/// Over three random right sides; d components, rows of the solver by RowLayout.
Errors errors(const LinearSolver& solver, const RowLayout& layout, int d, const Eigen::MatrixXd& A) {
  Random random(21);
  const int N = layout.sites();
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(A);
  Errors worst;
  for (int n = 0; n < 3; ++n) {
    Eigen::VectorXd r(N * d), w(N * d);
    for (int i = 0; i < N * d; ++i) r[i] = random(-1, 1);
    RowBuffer rows(layout, d);
    std::vector<double*> in_place;
    for (int a = 0; a < d; ++a) {
      Row one;
      for (int i = 0; i < N; ++i) one.push_back(r[i * d + a] * solver.right_side_scale(a));
      layout.scatter(one, rows.row(a));
      in_place.push_back(rows.row(a));
    }
    solver.solve(in_place.data());
    for (int a = 0; a < d; ++a) {
      layout.copy_overlaps(rows.row(a));
      for (int i = 0; i < N; ++i) w[i * d + a] = rows.row(a)[layout.slot(i)];
    }
    const Eigen::VectorXd exact = lu.solve(r);
    worst.forward = std::max(worst.forward, (w - exact).lpNorm<Eigen::Infinity>() / exact.lpNorm<Eigen::Infinity>());
    const double size =
        A.cwiseAbs().rowwise().sum().maxCoeff() * w.lpNorm<Eigen::Infinity>() + r.lpNorm<Eigen::Infinity>();
    worst.backward = std::max(worst.backward, (A * w - r).lpNorm<Eigen::Infinity>() / size);
  }
  return worst;
}

Errors errors_of_uniform(int N, const std::vector<BandEntry>& stencil, std::string* name = nullptr) {
  const Lattice circle = Lattice::circle(N, 1);
  const RowLayout layout(circle, 2);
  const auto solver = factor_uniform(circle, layout, stencil);
  if (name) *name = solver->name();
  return errors(*solver, layout, 1, dense(N, uniform(N, stencil)));
}

/// A random matrix with entries within `lower` and `upper` of the diagonal, the diagonal larger by `dominance`.
Entries random_band(Random& random, const Lattice& lattice, int d, int lower, int upper, double dominance) {
  Entries entries;
  const int size = lattice.sites() * d;
  for (int i = 0; i < size; ++i)
    for (int s = -lower; s <= upper; ++s) {
      if (!lattice.is_circle() && (i + s < 0 || i + s >= size)) continue;
      entries.push_back({i, ((i + s) % size + size) % size, random(-1, 1) + (s == 0 ? dominance : 0)});
    }
  return entries;
}

}  // namespace

TEST_CASE("a diagonal is divided by: one number if it is uniform") {
  std::string name;
  CHECK(errors_of_uniform(13, {{0, -3.5}}, &name).forward < 1e-15);
  CHECK(name == "division by one number");
  Random random(1);
  for (const Lattice& lattice : {Lattice::circle(11, 1), Lattice::interval(11, 1)})
    for (int d : {1, 3}) {
      const RowLayout layout(lattice, 1);
      const Entries entries = random_band(random, lattice, d, 0, 0, 2);
      const auto solver = factor(lattice, layout, d, entries);
      CHECK(solver->name() == "division by a diagonal");
      CHECK(errors(*solver, layout, d, dense(11 * d, entries)).forward < 1e-15);
    }
}

TEST_CASE("a symmetric circulant of width 1 is solved for every number of sites") {
  for (int N = 2; N <= 70; ++N)
    for (const double side : {-0.3, 0.45, -0.01}) {
      CAPTURE(N, side);
      std::string name;
      CHECK(errors_of_uniform(N, {{-1, side}, {0, 1}, {1, side}}, &name).forward < 1e-12);
      CHECK(contains(name, N >= 2 * lanes ? "two recurrences" : N > 6 ? "LU of a cyclic band" : "sparse LU"));
    }
  for (int N : {127, 128, 255, 256, 257, 500})
    CHECK(errors_of_uniform(N, {{-1, 1.2}, {0, -2.5}, {1, 1.2}}).forward < 1e-12);
}

TEST_CASE("a circulant with q near 1 is solved as well as its condition allows") {
  for (int N : {16, 17, 31, 64, 65, 200, 255})
    for (const double sign : {1.0, -1.0})
      for (const double margin : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
        CAPTURE(N, sign, margin);
        const Errors e = errors_of_uniform(N, {{-1, sign}, {0, 2 * (1 + margin)}, {1, sign}});
        CHECK(e.backward < 1e-14);
        CHECK(e.forward < 1e-15 * (10 + 10 / margin));
      }
}

TEST_CASE("circulants that do not decay, or are not symmetric, go to an LU") {
  std::string name;
  CHECK(errors_of_uniform(33, {{-1, 1}, {0, 1.5}, {1, 1}}, &name).backward < 1e-13);  // |centre| < 2|side|
  CHECK_FALSE(contains(name, "recurrences"));
  CHECK(errors_of_uniform(40, {{-1, 0.2}, {0, 1}, {1, 0.5}}, &name).forward < 1e-12);
  CHECK(contains(name, "LU of a cyclic band of width 1+1"));
  CHECK(errors_of_uniform(40, {{-2, 0.1}, {-1, -0.2}, {0, 1}, {1, 0.5}}, &name).forward < 1e-12);
  CHECK(contains(name, "LU of a cyclic band of width 2+1"));
  CHECK(errors_of_uniform(40, {{1, 0.5}, {0, 1}}, &name).forward < 1e-12);
  CHECK(contains(name, "LU of a cyclic band of width 0+1"));
}

TEST_CASE("cyclic bands of any widths are solved, symmetric or not, for one and two components") {
  Random random(2);
  for (int N : {9, 16, 23, 40})
    for (const auto& [lower, upper] : std::vector<std::pair<int, int>>{{1, 1}, {2, 1}, {0, 2}, {3, 3}, {1, 3}, {2, 0}})
      for (int d : {1, 2}) {
        CAPTURE(N, lower, upper, d);
        const Lattice circle = Lattice::circle(N, 1);
        const RowLayout layout(circle, 1);
        const Entries entries = random_band(random, circle, d, lower, upper, 5);
        const auto solver = factor(circle, layout, d, entries);
        CHECK(contains(solver->name(), N * d > 2 * (lower + upper) + 2 ? "LU of a cyclic band" : "sparse LU"));
        CHECK(errors(*solver, layout, d, dense(N * d, entries)).forward < 1e-12);
        CHECK(solver->bytes() > 0);
      }
}

TEST_CASE("bands between walls are solved") {
  Random random(3);
  for (int N : {3, 5, 16, 41})
    for (const auto& [lower, upper] : std::vector<std::pair<int, int>>{{1, 1}, {0, 1}, {2, 0}, {3, 2}})
      for (int d : {1, 2}) {
        CAPTURE(N, lower, upper, d);
        const Lattice walls = Lattice::interval(N, 1);
        const RowLayout layout(walls, 1);
        const Entries entries = random_band(random, walls, d, lower, upper, 5);
        const auto solver = factor(walls, layout, d, entries);
        CHECK(errors(*solver, layout, d, dense(N * d, entries)).forward < 1e-12);
      }
}

TEST_CASE("a band whose pivots vanish is factored with pivoting") {
  // tridiagonal (1, 0, 1): no pivot at all, but regular for even N between walls
  const Lattice walls = Lattice::interval(20, 1);
  const RowLayout layout(walls, 1);
  Entries entries;
  for (int i = 0; i + 1 < 20; ++i) entries.push_back({i, i + 1, 1.0}), entries.push_back({i + 1, i, 1.0});
  const auto solver = factor(walls, layout, 1, entries);
  CHECK(solver->name() == "sparse LU");
  CHECK(errors(*solver, layout, 1, dense(20, entries)).forward < 1e-13);
}

TEST_CASE("a singular matrix is an error, not a solution") {
  const Lattice circle = Lattice::circle(40, 1);
  const RowLayout layout(circle, 1);
  Entries zeros;
  for (int i = 0; i < 40; ++i) zeros.push_back({i, i, i == 7 ? 0.0 : 1.0});
  CHECK_THROWS_AS(factor(circle, layout, 1, zeros), NoConvergence);
  CHECK_THROWS_AS(factor_uniform(circle, layout, std::vector<BandEntry>{{0, 0}}), NoConvergence);
}
