// SPDX-License-Identifier: MIT
#include "schemes/solvers/circulant_solver.hpp"

#include <Eigen/Sparse>
#include <limits>
#include <memory>
#include <optional>

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

/// A random right side on a circle, and how a solver's solution of it differs from Eigen's.
struct Solving {
  RowLayout layout;
  Row r;
  RowBuffer rows{layout, 2};  ///< the right side, and the work space of a solve

  explicit Solving(int N, int halo = 2) : layout(Lattice::circle(N, 1), halo) {
    Random random(static_cast<std::uint64_t>(N));
    r = random_row(random, N, 1);
  }
  double* right() { return rows.row(0); }
  double* work() { return rows.row(1); }
  void prepare(const LinearSolver& solver, int component = 0) {
    Row scaled = r;
    for (double& x : scaled) x *= solver.right_side_scale(component);
    layout.scatter(scaled, right());
    std::fill_n(work(), layout.doubles(), std::numeric_limits<double>::quiet_NaN());
  }
  void give(int from, int to) {
    std::copy(right() + layout.at(from), right() + layout.at(to), work() + layout.at(from));
  }

  void solve(const LinearSolver& solver) {
    prepare(solver);
    give(0, layout.packs());
    double* const w[]{work()};
    solver.solve(w);
  }
  /// An arc of the row, with memory of its own.
  struct Arc {
    PackRange packs;
    std::unique_ptr<Sweeps> sweeps;
    RowBuffer w;
    Pack first = 0.0;
  };
  void give(int from, int to, double* w) {
    std::copy(right() + layout.at(from), right() + layout.at(to), w + layout.at(from));
  }

  /// By strips along so many arcs. `sums`: right sides are sums that the sweep evaluates itself. True if every pack came once.
  bool sweep(const LinearSolver& solver, int strip, bool sums = false, int component = 0, int arcs = 1) {
    prepare(solver, component);
    std::vector<Arc> all;
    for (int p = 0; p < arcs; ++p) {
      const PackRange packs{layout.first_of_part(p, arcs), layout.first_of_part(p + 1, arcs)};
      all.push_back({packs, solver.sweeps(component, packs), RowBuffer(layout, 1)});
      if (!all.back().sweeps) return false;
    }
    const bool whole = all[0].sweeps->takes_whole_rows();
    constexpr int margin = 2;  // packs that an arc takes from the joint with the next one
    const int near = whole ? 0 : all[0].sweeps->near() + margin;
    for (Arc& arc : all) {
      const int end = arc.packs.first == 0 ? layout.packs() : arc.packs.first;
      give(end - near, end, arc.w.row(0));
      arc.sweeps->begin(arc.w.row(0), {end - near, end});
      if (whole) continue;
      give(arc.packs.first, arc.packs.first + near, arc.w.row(0));
      arc.sweeps->forward(nullptr, nullptr, arc.w.row(0), arc.packs.first + near);
      arc.first = arc.sweeps->first(arc.w.row(0));
    }
    RowSum sum;
    sum.add(0, 0, 1);
    const double* const table[]{right()};
    std::vector<int> seen(layout.packs());
    solution.assign(layout.doubles(), std::numeric_limits<double>::quiet_NaN());
    RowBuffer zeros(layout.doubles()), made(layout.doubles(), 2);
    RowUpdate update{zeros.row(0), zeros.row(0), made.row(0), made.row(1), 0.0, 1.0, 0.0};
    for (std::size_t p = 0; p < all.size(); ++p) {
      Arc &arc = all[p], &next = all[(p + 1) % all.size()];
      const int last = arc.packs.last - (whole ? 0 : margin);
      for (int end = arc.packs.first + near; end < last;) {
        const int begin = end;
        end = std::min(last, end + strip);
        if (!sums) give(begin, end, arc.w.row(0));
        arc.sweeps->forward(sums ? &sum : nullptr, table, arc.w.row(0), end);
        if (end == last && !whole) {
          const auto from = next.w.row(0) + layout.at(last);
          std::copy(from, from + margin * lanes, arc.w.row(0) + layout.at(last));
          arc.sweeps->end(next.first);
        }
        for (;;) {
          const PackRange ready = arc.sweeps->ready();
          if (ready.first >= ready.last) break;
          arc.sweeps->backward(arc.w.row(0), update);
          for (int v = ready.first; v < ready.last; ++v) ++seen[v];
          std::copy(made.row(1) + layout.at(ready.first), made.row(1) + layout.at(ready.last),
                    solution.data() + layout.at(ready.first));
        }
      }
    }
    std::ranges::copy(solution, work());
    return std::ranges::all_of(seen, [](int times) { return times == 1; });
  }
  std::vector<double> solution;

  /// The largest difference in any slot of any arc, relative to the largest solution.
  double off(const Circulant& A) {
    const Eigen::VectorXd w = A.solve(Eigen::Map<const Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size())));
    double worst = 0;
    for (int l = 0; l < lanes; ++l)
      for (int v = 0; v < layout.packs(); ++v) {
        const double difference = std::abs(work()[layout.at(v) + l] - w[layout.start(l) + v]);
        if (!(difference <= worst)) worst = difference;
      }
    return worst / std::max(1.0, w.lpNorm<Eigen::Infinity>());
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

/// Rows that are solved strip after strip, with arcs that overlap and without.
std::vector<int> long_sizes() { return {4096 * lanes, 4096 * lanes + 1, 4096 * lanes + lanes - 1, 5000 * lanes - 3}; }

}  // namespace

TEST_CASE("a circulant is solved as by Eigen, in every slot of every arc") {
  for (int N : sizes())
    for (double q : roots)
      for (double c : {1.3, -0.02}) {
        CAPTURE(N, q, c);
        const Circulant A = with_root(q, c);
        Solving solving(N);
        const CirculantSolver solver(solving.layout, A.centre, A.side);
        solving.solve(solver);
        const double condition = 1 / ((1 - std::abs(q)) * (1 - std::abs(q)));
        CHECK(solving.off(A) < 1e-15 * (20 + condition));
      }
}

TEST_CASE("sweeps over short rows are a whole solve, whatever the strips") {
  for (int N : {16, 17, 23, 64, 100, 255, 600, 4097})
    for (double q : roots)
      for (int strip : {1, 7, 64, 1000})
        for (bool sums : {false, true}) {
          CAPTURE(N, q, strip, sums);
          const Circulant A = with_root(q);
          Solving whole(N), swept(N);
          const CirculantSolver solver(whole.layout, A.centre, A.side), other(swept.layout, A.centre, A.side);
          whole.solve(solver);
          CHECK(other.sweeps(0, swept.layout.all())->takes_whole_rows());
          CHECK(swept.sweep(other, strip, sums));
          double worst = 0, size = 1;
          for (auto at = whole.layout.at(0); at < whole.layout.at(whole.layout.packs()); ++at) {
            worst = std::max(worst, std::abs(whole.work()[at] - swept.work()[at]));
            size = std::max(size, std::abs(whole.work()[at]));
          }
          CHECK(worst < size * 1e-15 * (4 + 4 / (1 - std::abs(q))));
        }
}

TEST_CASE("a long row is swept strip by strip and arc by arc, arcs joined by the packs near their ends alone") {
  for (int N : long_sizes())
    for (double q : {-7.0 / 9, 0.3, -1e-6, 0.9})
      for (int arcs : {1, 2, 3}) {
        CAPTURE(N, q, arcs);
        const Circulant A = with_root(q, 1.3);
        Solving solving(N);
        const CirculantSolver solver(solving.layout, A.centre, A.side);
        const auto sweeps = solver.sweeps(0, solving.layout.all());
        REQUIRE(sweeps);
        CHECK_FALSE(sweeps->takes_whole_rows());
        CHECK(sweeps->near() < solving.layout.packs() / 2);
        for (bool sums : {false, true}) {
          CHECK(solving.sweep(solver, 1024, sums, 0, arcs));
          CHECK(solving.off(A) < 1e-15 * (20 + 1 / ((1 - std::abs(q)) * (1 - std::abs(q)))));
        }
        solving.solve(solver);
        CHECK(solving.off(A) < 1e-15 * (20 + 1 / ((1 - std::abs(q)) * (1 - std::abs(q)))));
      }
}

TEST_CASE("a long row whose ends feel each other is swept as a whole") {
  Solving solving(4096 * lanes + 1);
  const Circulant A = with_root(0.999);
  const CirculantSolver solver(solving.layout, A.centre, A.side);
  CHECK(solver.sweeps(0, solving.layout.all())->takes_whole_rows());
  CHECK(solving.sweep(solver, 1024));
  CHECK(solving.off(A) < 1e-9);
}

TEST_CASE("components with matrices of their own are swept each by its own, with its scale") {
  for (int N : {16, 19, 64, 255})
    for (double q : {-7.0 / 9, 0.4}) {
      CAPTURE(N, q);
      const std::vector<Circulant> pair{with_root(q, 1.7), with_root(-q / 2, -0.3)};
      Solving solving(N);
      std::vector<std::unique_ptr<LinearSolver>> solvers;
      for (const Circulant& A : pair)
        solvers.push_back(factor_uniform(Lattice::circle(N, 1), solving.layout,
                                         std::vector<BandEntry>{{-1, A.side}, {0, A.centre}, {1, A.side}}));
      const auto solver = by_component(std::move(solvers));
      CHECK(solver->right_side_scale(0) != solver->right_side_scale(1));
      for (int a = 0; a < 2; ++a) {
        CHECK(solving.sweep(*solver, 64, false, a));
        CHECK(solving.off(pair[a]) < 5e-14);
        CHECK(solving.off(pair[1 - a]) > 0.01);
      }
    }
}

TEST_CASE("the solver of the general kind does the same: no symmetry is asked of a band") {
  for (int N : {16, 33, 255}) {
    const Circulant A{1, 0.3};
    Solving solving(N);
    const Lattice circle = Lattice::circle(N, 1);
    std::vector<MatrixEntry> entries;
    for (int i = 0; i < N; ++i)
      for (int s : {-1, 0, 1}) entries.push_back({i, circle.wrapped(i + s), s == 0 ? A.centre : A.side});
    const auto solver = factor(circle, solving.layout, 1, entries);
    solving.solve(*solver);
    solving.layout.copy_overlaps(solving.work());
    CHECK(solving.off(A) < 5e-14);
  }
}

TEST_CASE("the comparison with Eigen can fail: another matrix, another right side") {
  for (int N : {16, 255, 4096 * lanes + 1})
    for (double q : {-7.0 / 9, 0.9}) {
      CAPTURE(N, q);
      const Circulant A = with_root(q);
      Solving solving(N);
      const CirculantSolver solver(solving.layout, A.centre, A.side);
      solving.sweep(solver, 1024);
      CHECK(solving.off(with_root(q * (1 + 1e-7))) > 1e-9);
      solving.r[N / 2] += 1e-8;
      CHECK(solving.off(A) > 1e-10);
    }
}
