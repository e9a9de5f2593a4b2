// SPDX-License-Identifier: MIT
#include "schemes/solvers/circulant_solver.hpp"

#include <Eigen/Sparse>

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// a S⁻ + b + a S⁺
struct Circulant {
  double centre, side;
  Eigen::VectorXd solve(const Eigen::VectorXd& r) const {
    const int N = static_cast<int>(r.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < N; ++i) {
      entries.emplace_back(i, i, centre);
      entries.emplace_back(i, (i + 1) % N, side);
      entries.emplace_back(i, (i + N - 1) % N, side);
    }
    Eigen::SparseMatrix<double> A(N, N);
    A.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Eigen::SparseMatrix<double>> lu;
    lu.compute(A);
    return lu.solve(r);
  }
};
/// c (1 − q S⁻)(1 − q S⁺)
Circulant with_root(double q, double c = 1) { return {c * (1 + q * q), -c * q}; }

/// v += w, y += v at every site of some components, and the rows that a solver makes of it.
struct Advance {
  RowLayout layout;
  int d;
  std::vector<Row> r, v_before, y_before;
  RowBuffer right{layout, d}, before{layout, 2 * d}, after{layout, 2 * d}, work{layout, d};
  double largest = 0, change = 0;
  RowLook look;           ///< of every component
  bool in_place = false;  ///< v is made from itself

  Advance(int N, int components) : layout(Lattice::circle(N, 1), 2), d(components) {
    Random random(static_cast<std::uint64_t>(N));
    for (int a = 0; a < d; ++a) {
      r.push_back(random_row(random, N, 1));
      v_before.push_back(random_row(random, N, 1));
      y_before.push_back(random_row(random, N, 10));
    }
  }
  /// Right sides are sums of shifted rows: here half a row and half the same, and the row before as a difference.
  void run(const LinearSolver& solver, double fault = 0) {
    std::vector<RowSum> sums(static_cast<std::size_t>(d));
    std::vector<const RowSum*> right_sides;
    std::vector<RowIncrement> rows;
    std::vector<double*> w;
    std::vector<const double*> bases;
    RowSum::Rows read;
    for (int a = 0; a < d; ++a) {
      const auto at = static_cast<std::size_t>(a);
      layout.scatter(r[at], right.row(a));
      layout.scatter(v_before[at], before.row(2 * a));
      layout.scatter(y_before[at], before.row(2 * a + 1));
      double* const v = in_place ? before.row(2 * a) : after.row(2 * a);
      rows.push_back({before.row(2 * a), before.row(2 * a + 1), v, after.row(2 * a + 1), look});
      w.push_back(work.row(a));
      bases.push_back(right.row(a));
    }
    read.row = bases.data();
    for (int a = 0; a < d; ++a) {
      RowSum& sum = sums[static_cast<std::size_t>(a)];
      sum.add(a, 0, 1 + fault);
      sum.add_difference(a, 1, 0.25);
      sum.add_difference(a, -1, -0.5);
      sum.scale(solver.right_side_scale(a));
      sum.bind(read);
      right_sides.push_back(&sum);
    }
    const RowChange all = solver.advance(layout, d, right_sides.data(), rows.data(), w.data());
    largest = all.largest;
    change = all.change;
  }
  /// The largest look by hand, across the ends of arcs too.
  double largest_look(const RowLook& at_what) const {
    double most = 0;
    for (int a = 0; a < d; ++a)
      for (int v = 0; v < layout.packs(); ++v)
        for (int l = 0; l < lanes; ++l) {
          double sum = 0;
          for (int p = 0; p < at_what.parts; ++p) {
            const auto slot = layout.at(v + p) + l;
            sum += at_what.weights[p] * (after.row(2 * a + 1)[slot] - at_what.expected[slot]);
          }
          most = std::max(most, std::abs(sum));
        }
    return most;
  }
  /// The largest difference from v + w and y + v + w, relative to the largest w, and of the largest |y| reported.
  double off(const std::vector<Circulant>& matrices) {
    const int N = layout.sites();
    double worst = 0, most = 0, size = 1;
    for (int a = 0; a < d; ++a) {
      const auto at = static_cast<std::size_t>(a);
      Eigen::VectorXd sum(N);
      for (int i = 0; i < N; ++i) {
        const double here = r[at][static_cast<std::size_t>(i)];
        sum[i] = here + 0.25 * (r[at][static_cast<std::size_t>((i + 1) % N)] - here) -
                 0.5 * (r[at][static_cast<std::size_t>((i + N - 1) % N)] - here);
      }
      const Eigen::VectorXd w = matrices[at].solve(sum);
      size = std::max(size, w.lpNorm<Eigen::Infinity>());
      for (int i = 0; i < N; ++i) {
        const double v = v_before[at][static_cast<std::size_t>(i)] + w[i];
        const double y = y_before[at][static_cast<std::size_t>(i)] + v;
        const int slot = layout.slot(i);
        const double* const v_new = in_place ? before.row(2 * a) : after.row(2 * a);
        for (double difference : {v_new[slot] - v, after.row(2 * a + 1)[slot] - y})
          if (!(std::abs(difference) <= worst)) worst = std::abs(difference);
        most = std::max(most, std::abs(y));
      }
    }
    if (!(std::abs(largest - most) <= worst)) worst = std::abs(largest - most);
    return worst / size;
  }
};

std::vector<int> sizes() {
  std::vector<int> all;
  for (int N = 16; N <= 80; ++N) all.push_back(N);
  for (int N = 87; N <= 600; N += 19) all.push_back(N);
  all.insert(all.end(), {127, 128, 129, 254, 255, 256, 257, 511, 512, 513});
  return all;
}
const std::vector<double> roots{-7.0 / 9, 7.0 / 9, 0.3, -0.3, 1e-3, -1e-6, 0.97, -0.97, 0.999, -0.999};

}  // namespace

TEST_CASE("a circulant advances a row as Eigen's solution and two sums do") {
  for (int N : sizes())
    for (double q : roots)
      for (double c : {1.3, -0.02}) {
        CAPTURE(N, q, c);
        const Circulant A = with_root(q, c);
        Advance advance(N, 1);
        const CirculantSolver solver(advance.layout, A.centre, A.side);
        advance.run(solver);
        const double condition = 1 / ((1 - std::abs(q)) * (1 - std::abs(q)));
        CHECK(advance.off({A}) < 1e-15 * (20 + condition));
      }
}

TEST_CASE("advancing is solving and adding, to rounding, and v may be made from itself") {
  for (int N : {16, 17, 23, 64, 100, 255, 600})
    for (double q : roots) {
      CAPTURE(N, q);
      const Circulant A = with_root(q);
      Advance advance(N, 1), again(N, 1);
      again.in_place = true;
      const CirculantSolver solver(advance.layout, A.centre, A.side);
      advance.run(solver);
      const CirculantSolver other(again.layout, A.centre, A.side);
      again.run(other);
      CHECK(again.largest == advance.largest);
      Row sum(static_cast<std::size_t>(N));
      for (int i = 0; i < N; ++i) {
        const auto r = [&](int n) { return advance.r[0][static_cast<std::size_t>((n + N) % N)]; };
        sum[static_cast<std::size_t>(i)] = r(i) + 0.25 * (r(i + 1) - r(i)) - 0.5 * (r(i - 1) - r(i));
      }
      RowBuffer row(advance.layout, 1);
      advance.layout.scatter(sum, row.row(0));
      const double* const from[]{row.row(0)};
      double* const to[]{row.row(0)};
      solver.solve(from, to);
      double worst = 0, size = 1;
      for (int i = 0; i < N; ++i) {
        const int slot = advance.layout.slot(i);
        const double w = row.row(0)[slot], v = advance.v_before[0][static_cast<std::size_t>(i)] + w;
        size = std::max(size, std::abs(w));
        worst =
            std::max({worst, std::abs(advance.after.row(0)[slot] - v),
                      std::abs(advance.after.row(1)[slot] - (advance.y_before[0][static_cast<std::size_t>(i)] + v))});
        CHECK(again.before.row(0)[slot] == advance.after.row(0)[slot]);
        CHECK(again.after.row(1)[slot] == advance.after.row(1)[slot]);
      }
      CHECK(worst < size * 1e-15 * (20 + 1 / (1 - std::abs(q))));
    }
}

TEST_CASE("what a row turned out to be is compared with what was expected while it is made") {
  const std::vector<RowLook> looks{{nullptr, 1, {1}}, {nullptr, 2, {0.75, -0.25}}, {nullptr, 3, {0.5, -2, 0.125}}};
  for (int N : {16, 17, 24, 64, 255, 256})
    for (int parts = 1; parts <= 3; ++parts)
      for (int d : {1, 2}) {
        CAPTURE(N, parts, d);
        if (parts > RowLayout(Lattice::circle(N, 1), 2).packs()) continue;
        Advance advance(N, d);
        Random random(3);
        RowBuffer expected(advance.layout, 1);
        advance.layout.scatter(random_row(random, N, 10), expected.row(0));
        advance.look = looks[static_cast<std::size_t>(parts - 1)];
        advance.look.expected = expected.row(0);
        const Circulant A = with_root(-0.6, 1.7);
        const std::vector<BandEntry> band{{-1, A.side}, {0, A.centre}, {1, A.side}}, number{{0, -4.5}},
            lopsided{{-1, 0.2}, {0, 1.7}, {1, 0.3}};
        for (const auto& stencil : {band, number, lopsided}) {
          std::vector<std::unique_ptr<LinearSolver>> solvers;
          for (int a = 0; a < d; ++a)
            solvers.push_back(factor_uniform(Lattice::circle(N, 1), advance.layout, stencil));
          const auto solver = by_component(std::move(solvers));
          CAPTURE(solver->name());
          advance.run(*solver);
          CHECK(advance.change == Approx(advance.largest_look(advance.look)).epsilon(1e-13));
          if (parts == 1) continue;
          RowLook reversed = advance.look;
          std::reverse(reversed.weights, reversed.weights + parts);
          CHECK(std::abs(advance.change - advance.largest_look(reversed)) > 1e-6 * advance.change);
        }
      }
}

TEST_CASE("what the next step looks at is found while a row is made, and compared with what was expected of it") {
  const std::vector<RowLook> looks{{nullptr, 1, {0.5}}, {nullptr, 2, {0.75, -0.25}}, {nullptr, 3, {0.5, -2, 0.125}}};
  for (int N : {24, 25, 64, 255, 256})
    for (const RowLook& look : looks) {
      Advance advance(N, 1);
      const RowLayout& layout = advance.layout;
      CAPTURE(N, look.parts);
      Random random(3);
      RowBuffer expected(layout, 1), found(layout, 1);
      const Circulant A = with_root(-0.6, 1.7);
      const std::vector<BandEntry> band{{-1, A.side}, {0, A.centre}, {1, A.side}}, number{{0, -4.5}},
          lopsided{{-1, 0.2}, {0, 1.7}, {1, 0.3}};
      for (const auto& stencil : {band, number, lopsided}) {
        const auto solver = factor_uniform(Lattice::circle(N, 1), layout, stencil);
        CAPTURE(solver->name());
        layout.scatter(random_row(random, N, 10), expected.row(0));
        std::copy_n(expected.row(0), layout.doubles(), found.row(0));
        advance.look = look;
        advance.look.argument = found.row(0);
        advance.run(*solver);
        const double* const y = advance.after.row(1);
        RowBuffer again(layout, 1);  // with the halos and overlaps that it should have
        Row sites(static_cast<std::size_t>(N));
        layout.gather(y, sites);
        layout.scatter(sites, again.row(0));
        for (std::size_t s = 0; s < layout.doubles(); ++s) CHECK(y[s] == Approx(again.row(0)[s]).epsilon(1e-14));
        double worst = 0, change = 0;
        for (int v = 0; v < layout.packs(); ++v)
          for (int l = 0; l < lanes; ++l) {
            const auto slot = layout.at(v) + l;
            double m = 0;
            for (int p = 0; p < look.parts; ++p) m += look.weights[p] * y[slot + p * lanes];
            worst = std::max(worst, std::abs(found.row(0)[slot] - m));
            change = std::max(change, std::abs(m - expected.row(0)[slot]));
          }
        CHECK(worst < 1e-13);
        CHECK(advance.change == Approx(change).epsilon(1e-13));
        CHECK(change > 1);
      }
    }
}

TEST_CASE("two components with matrices of their own are advanced together, each with its scale") {
  for (int N : {16, 19, 64, 255})
    for (double q : {-7.0 / 9, 0.4}) {
      const Circulant first = with_root(q, 1.7), second = with_root(-q / 2, -0.3), number{-4.5, 0};
      for (const auto& pair : {std::vector{first, second}, {first, number}, {number, second}}) {
        CAPTURE(N, q, pair[0].centre, pair[1].centre);
        Advance advance(N, 2);
        std::vector<std::unique_ptr<LinearSolver>> solvers;
        for (const Circulant& A : pair) {
          std::vector<BandEntry> stencil{{0, A.centre}};
          if (A.side != 0) stencil.insert(stencil.end(), {{-1, A.side}, {1, A.side}});
          solvers.push_back(factor_uniform(Lattice::circle(N, 1), advance.layout, stencil));
        }
        const auto solver = by_component(std::move(solvers));
        CHECK(solver->right_side_scale(0) != solver->right_side_scale(1));
        advance.run(*solver);
        CHECK(advance.off(pair) < 5e-14);
        CHECK(advance.off({pair[1], pair[0]}) > 0.01);
      }
    }
}

TEST_CASE("the solver of the general kind advances alike: no symmetry, a band of two") {
  for (int N : {16, 33, 255}) {
    const Circulant A{1, 0.3};
    Advance by_default(N, 1);
    const Lattice circle = Lattice::circle(N, 1);
    std::vector<LatticeSystem::Entry> entries;
    for (int i = 0; i < N; ++i)
      for (int s : {-1, 0, 1}) entries.push_back({i, circle.wrapped(i + s), s == 0 ? A.centre : A.side});
    const auto solver = factor(circle, by_default.layout, 1, entries);
    by_default.run(*solver);
    CHECK(by_default.off({A}) < 5e-14);
  }
}

TEST_CASE("the comparison with Eigen can fail: another matrix, another right side") {
  for (int N : {16, 255})
    for (double q : {-7.0 / 9, 0.97}) {
      const Circulant A = with_root(q);
      Advance advance(N, 1);
      const CirculantSolver solver(advance.layout, A.centre, A.side);
      advance.run(solver);
      CHECK(advance.off({with_root(q * (1 + 1e-7))}) > 1e-9);
      advance.run(solver, 1e-8);
      CHECK(advance.off({A}) > 1e-10);
    }
}

TEST_CASE("a NaN in a right side shows in the largest value") {
  for (int where : {0, 9, 31})
    for (int a = 0; a < 2; ++a) {
      Advance ill = Advance(32, 2);
      ill.r[static_cast<std::size_t>(a)][static_cast<std::size_t>(where)] = std::nan("");
      std::vector<std::unique_ptr<LinearSolver>> own;
      for (double side : {0.5, -0.3}) own.push_back(std::make_unique<CirculantSolver>(ill.layout, 2.0, side));
      ill.run(*by_component(std::move(own)));
      CHECK(std::isnan(ill.largest));
    }
}
