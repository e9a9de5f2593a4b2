// SPDX-License-Identifier: MIT
#include <Eigen/Dense>
#include <limits>

#include "schemes/solvers/lane_band_solver.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Entries = std::vector<LatticeSystem::Entry>;

/// Full blocks within s sites, uniform in (−1, 1), the diagonal larger by `dominance` times the width of a row.
Entries random_blocks(Random& random, const Lattice& lattice, int d, int s, double dominance) {
  Entries entries;
  const int N = lattice.sites();
  for (int i = 0; i < N; ++i)
    for (int k = -s; k <= s; ++k) {
      if (!lattice.is_circle() && (i + k < 0 || i + k >= N)) continue;
      for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b) {
          const double extra = k == 0 && a == b ? dominance * (2 * s + 1) * d : 0;
          entries.push_back({i * d + a, lattice.wrapped(i + k) * d + b, random(-1, 1) + extra});
        }
    }
  return entries;
}

/// The scalar matrix that is alike at every site; what would reach beyond a wall is left out.
Entries tridiagonal(const Lattice& lattice, double left, double centre, double right) {
  Entries entries;
  for (int i = 0; i < lattice.sites(); ++i)
    for (const auto& [k, value] : {std::pair(-1, left), std::pair(0, centre), std::pair(1, right)})
      if (lattice.is_circle() || (i + k >= 0 && i + k < lattice.sites()))
        entries.push_back({i, lattice.wrapped(i + k), value});
  return entries;
}

Eigen::MatrixXd dense(int size, const Entries& entries) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  for (const auto& e : entries) A(e.row, e.column) += e.value;
  return A;
}

/// Rows in lanes whose halos are NaN: a solver that reads them is found out.
struct Rows {
  Rows(const RowLayout& layout, int d) : buffer(layout, d) {
    for (int a = 0; a < d; ++a) {
      std::fill_n(buffer.row(a), layout.doubles(), std::numeric_limits<double>::quiet_NaN());
      in.push_back(buffer.row(a)), out.push_back(buffer.row(a));
    }
  }
  void set(const RowLayout& layout, const Eigen::VectorXd& sites) {
    const int d = buffer.rows();
    for (int l = 0; l < lanes; ++l)
      for (int v = 0; v < layout.packs(); ++v)
        for (int a = 0; a < d; ++a)
          out[static_cast<std::size_t>(a)][layout.at(v) + l] = sites[(layout.start(l) + v) * d + a];
  }
  Eigen::VectorXd get(const RowLayout& layout) const {
    const int d = buffer.rows();
    Eigen::VectorXd sites(layout.sites() * d);
    for (int i = 0; i < sites.size(); ++i) sites[i] = in[static_cast<std::size_t>(i % d)][layout.slot(i / d)];
    return sites;
  }
  bool slots_are_finite(const RowLayout& layout) const {
    for (const double* row : in)
      for (std::ptrdiff_t at = layout.at(0); at < layout.at(layout.packs()); ++at)
        if (!std::isfinite(row[at])) return false;
    return true;
  }
  bool halos_are_untouched(const RowLayout& layout) const {
    for (const double* row : in)
      for (std::ptrdiff_t at = 0; at < static_cast<std::ptrdiff_t>(layout.doubles()); ++at)
        if ((at < layout.at(0) || at >= layout.at(layout.packs())) && !std::isnan(row[at])) return false;
    return true;
  }

  RowBuffer buffer;
  std::vector<const double*> in;
  std::vector<double*> out;
};

Eigen::VectorXd random_vector(Random& random, int size) {
  Eigen::VectorXd v(size);
  for (double& x : v) x = random(-1, 1);
  return v;
}

struct Errors {
  double forward = 0;   ///< against Eigen's dense LU, relative to the largest component
  double backward = 0;  ///< |Aw − r|/(|A||w| + |r|), maximum norms
};

Errors errors(const LinearSolver& solver, const RowLayout& layout, int d, const Entries& entries) {
  Random random(5);
  const int size = layout.sites() * d;
  const Eigen::MatrixXd A = dense(size, entries);
  const Eigen::VectorXd r = random_vector(random, size), exact = A.partialPivLu().solve(r);
  Rows from(layout, d), to(layout, d);
  from.set(layout, r);
  solver.solve(from.in.data(), to.out.data());
  CHECK(to.slots_are_finite(layout));
  CHECK(to.halos_are_untouched(layout));
  const Eigen::VectorXd w = to.get(layout);
  const double norm = A.cwiseAbs().rowwise().sum().maxCoeff();
  const auto largest = [](const Eigen::VectorXd& v) { return v.lpNorm<Eigen::Infinity>(); };
  return {largest(w - exact) / largest(exact), largest(A * w - r) / (norm * largest(w) + largest(r))};
}

Lattice lattice_of(bool circle, int N) { return circle ? Lattice::circle(N, 1) : Lattice::interval(N, 1); }

}  // namespace

TEST_CASE("a dominant band is solved by lanes: circle and interval, every width, every number of sites that fits") {
  Random random(1);
  for (const bool circle : {true, false})
    for (int d : {1, 2, 3, 5})
      for (int s : {1, 2, 3}) {
        const int least = lanes * (2 * s + 1);
        std::vector<int> sites{least - 1, least, least + 1, least + lanes - 1, least + lanes, least + lanes + 3};
        if (d < 3) sites.insert(sites.end(), {100, 128, 255, 300});
        for (const int N : sites) {
          CAPTURE(circle, d, s, N);
          const Lattice lattice = lattice_of(circle, N);
          const RowLayout layout(lattice, 1);
          const Entries entries = random_blocks(random, lattice, d, s, 1);
          const auto solver = LaneBandSolver::factor(lattice, layout, d, entries);
          REQUIRE((solver != nullptr) == (N >= least));
          if (!solver) continue;
          CHECK(errors(*solver, layout, d, entries).forward < 1e-14);
          const std::string width = std::to_string(d * (s + 1) - 1);
          CHECK(solver->name() == "LU of a " + std::string(circle ? "cyclic " : "") + "band of width " + width + "+" +
                                      width + " by lanes");
          CHECK(solver->bytes() > 0);
        }
      }
}

TEST_CASE("a band that is merely nonsingular is solved accurately by lanes, or not at all") {
  Random random(2);
  int solved = 0, all = 0;
  for (const bool circle : {true, false})
    for (int d : {1, 2, 3})
      for (int s : {1, 2})
        for (const int N : {lanes * (2 * s + 1) + 2, 64, 97})
          for (int n = 0; n < 4; ++n) {
            CAPTURE(circle, d, s, N, n);
            const Lattice lattice = lattice_of(circle, N);
            const RowLayout layout(lattice, 1);
            const Entries entries = random_blocks(random, lattice, d, s, 0);
            const auto solver = LaneBandSolver::factor(lattice, layout, d, entries);
            ++all;
            if (!solver) continue;
            ++solved;
            CHECK(errors(*solver, layout, d, entries).backward < 1e-12);
          }
  CAPTURE(solved, all);
  CHECK(solved > all / 4);
}

TEST_CASE("spikes that do not decay go through all lanes") {
  for (const bool circle : {true, false})
    for (const int N : {3 * lanes, 3 * lanes + 1, 64, 255})
      for (const double centre : {2.5, 2.0001, 1.2}) {  // q^32 = 1e−10, nearly 1, and oscillating
        CAPTURE(circle, N, centre);
        const Lattice lattice = lattice_of(circle, N);
        const RowLayout layout(lattice, 1);
        const Entries entries = tridiagonal(lattice, -1, centre, -1);
        const auto solver = LaneBandSolver::factor(lattice, layout, 1, entries);
        REQUIRE(solver);
        // where the matrix oscillates, arcs alone may be nearly singular
        CHECK(errors(*solver, layout, 1, entries).backward < (centre < 2 ? 1e-12 : 1e-14));
      }
}

TEST_CASE("spikes are stored as far as they matter") {
  const Lattice circle = Lattice::circle(200 * lanes, 1);
  const RowLayout layout(circle, 1);
  const auto fast = LaneBandSolver::factor(circle, layout, 1, tridiagonal(circle, -1, 10, -1));
  const auto slow = LaneBandSolver::factor(circle, layout, 1, tridiagonal(circle, -1, 2.001, -1));
  REQUIRE(fast);
  REQUIRE(slow);
  // three packs per slot, and two spikes of 19 ln 10/arcosh 5 = 19.1 slots: 8 bytes to a lane
  CHECK(fast->bytes() < 8 * lanes * (3 * 200 + 2 * 20 + 40 + 4 * lanes));
  CHECK(slow->bytes() > 8 * lanes * 5 * 200);
}

TEST_CASE("coefficients may differ from site to site, in units too, and come in parts") {
  Random random(3);
  for (const bool circle : {true, false})
    for (int d : {1, 2}) {
      const int N = 10 * lanes + 3;
      const Lattice lattice = lattice_of(circle, N);
      const RowLayout layout(lattice, 2);
      Entries entries;
      for (auto e : random_blocks(random, lattice, d, 1, 1)) {
        if (e.row / d == 0 || e.row / d == N - 1) e.value = e.row == e.column ? 1 : 0;  // rows of walls
        if (e.row / d % 2 == 1) e.value *= 1e8;
        if (e.column % d == 1) e.value *= 1e-9;
        const double part = random(-1, 1) * e.value;
        entries.push_back({e.row, e.column, part});
        entries.push_back({e.row, e.column, e.value - part});
      }
      const auto solver = LaneBandSolver::factor(lattice, layout, d, entries);
      REQUIRE(solver);
      CHECK(trial(*solver, layout, d, entries).residual < 1e-14);
      CHECK(errors(*solver, layout, d, entries).backward < 1e-14);
    }
}

TEST_CASE("sites that do not meet are solved by lanes all the same") {
  Random random(4);
  const Lattice circle = Lattice::circle(5 * lanes, 1);
  const RowLayout layout(circle, 1);
  Entries entries;
  for (int i = 0; i < 5 * lanes; ++i)
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) entries.push_back({2 * i + a, 2 * i + b, random(-1, 1) + (a == b ? 3 : 0)});
  const auto solver = LaneBandSolver::factor(circle, layout, 2, entries);
  REQUIRE(solver);
  CHECK(errors(*solver, layout, 2, entries).forward < 1e-15);
}

TEST_CASE("arcs that overlap by two sites are solved") {
  Random random(6);
  for (const bool circle : {true, false})
    for (int d : {1, 2})
      for (int s : {1, 2})
        for (int N = lanes * 6; N <= lanes * 8; N += 2) {
          CAPTURE(circle, d, s, N);
          const Lattice lattice = lattice_of(circle, N);
          const RowLayout layout(lattice, 1, 2);
          const Entries entries = random_blocks(random, lattice, d, s, 1);
          const auto solver = LaneBandSolver::factor(lattice, layout, d, entries);
          REQUIRE(solver);
          CHECK(errors(*solver, layout, d, entries).forward < 1e-14);
        }
}

TEST_CASE("solving by lanes may overwrite the right side, and needs no halo") {
  Random random(7);
  for (int d : {1, 2, 3, 4, 5})
    for (int s : {1, 2, 3}) {
      CAPTURE(d, s);
      const Lattice circle = Lattice::circle(8 * lanes - 1, 1);
      const RowLayout layout(circle, 0);
      const auto solver = LaneBandSolver::factor(circle, layout, d, random_blocks(random, circle, d, s, 1));
      REQUIRE(solver);
      Rows rows(layout, d), to(layout, d);
      rows.set(layout, random_vector(random, circle.sites() * d));
      solver->solve(rows.in.data(), to.out.data());
      solver->solve(rows.in.data(), rows.out.data());
      CHECK(rows.get(layout) == to.get(layout));
    }
}

TEST_CASE("a singular matrix is not solved by lanes") {
  for (const bool circle : {true, false})
    for (const int N : {4 * lanes, 4 * lanes + 1, 300}) {
      CAPTURE(circle, N);
      const Lattice lattice = lattice_of(circle, N);
      const RowLayout layout(lattice, 1);
      Entries laplacian = tridiagonal(lattice, -1, 2, -1);
      if (!circle) laplacian.push_back({0, 0, -1.0}), laplacian.push_back({N - 1, N - 1, -1.0});
      CHECK(LaneBandSolver::factor(lattice, layout, 1, laplacian) == nullptr);
      Entries pair = tridiagonal(lattice, 0, 1, 0);  // two rows alike, off the arcs' ends and across them
      for (const int i : {1, layout.start(1) - 1}) {
        Entries entries = pair;
        entries.push_back({i, i + 1, 1.0}), entries.push_back({i + 1, i, 1.0});
        CHECK(LaneBandSolver::factor(lattice, layout, 1, entries) == nullptr);
      }
      Entries hole = tridiagonal(lattice, 0.1, 1, 0.1);
      std::erase_if(hole, [&](const LatticeSystem::Entry& e) { return e.row == N / 2; });
      CHECK(LaneBandSolver::factor(lattice, layout, 1, hole) == nullptr);
    }
}

TEST_CASE("a matrix that needs pivots is not solved by lanes, but within a block they are found") {
  Random random(8);
  const Lattice walls = Lattice::interval(6 * lanes, 1);
  const RowLayout layout(walls, 1);
  CHECK(LaneBandSolver::factor(walls, layout, 1, tridiagonal(walls, 1, 0, 1)) == nullptr);
  CHECK(LaneBandSolver::factor(walls, layout, 1, tridiagonal(walls, 1, 1e-9, 1)) == nullptr);
  Entries swapped;
  for (const auto& e : random_blocks(random, walls, 2, 1, 1)) swapped.push_back({e.row ^ 1, e.column, e.value});
  const auto solver = LaneBandSolver::factor(walls, layout, 2, swapped);
  REQUIRE(solver);
  CHECK(errors(*solver, layout, 2, swapped).forward < 1e-14);
}

TEST_CASE("a band that is too wide, or wraps onto itself, is not solved by lanes") {
  Random random(9);
  const Lattice circle = Lattice::circle(64 * lanes, 1);
  const RowLayout layout(circle, 1);
  CHECK(LaneBandSolver::factor(circle, layout, 11, random_blocks(random, circle, 11, 3, 1)) == nullptr);
  Entries far = tridiagonal(circle, -1, 4, -1);
  far.push_back({3, 3 + 32 * lanes, 0.1});
  CHECK(LaneBandSolver::factor(circle, layout, 1, far) == nullptr);
  // d = 1 with a reach that no compiled case has
  const Entries wide = random_blocks(random, circle, 1, 11, 1);
  const auto solver = LaneBandSolver::factor(circle, layout, 1, wide);
  REQUIRE(solver);
  CHECK(trial(*solver, layout, 1, wide).residual < 1e-14);
}

TEST_CASE("the trial of a solver finds a wrong entry anywhere") {
  Random random(10);
  for (const bool circle : {true, false})
    for (int d : {1, 3}) {
      const int N = 5 * lanes + 1;
      const Lattice lattice = lattice_of(circle, N);
      const RowLayout layout(lattice, 1);
      const Entries entries = random_blocks(random, lattice, d, 1, 1);
      const auto solver = LaneBandSolver::factor(lattice, layout, d, entries);
      REQUIRE(solver);
      CHECK(trial(*solver, layout, d, entries).residual < 1e-14);
      CHECK(trial(*solver, layout, d, entries).growth < 10);
      double least = 1;
      for (std::size_t e = 0; e < entries.size(); ++e) {
        Entries wrong = entries;
        wrong[e].value += 1e-6;
        least = std::min(least, trial(*solver, layout, d, wrong).residual);
      }
      CHECK(least > 1e-12);
    }
}
