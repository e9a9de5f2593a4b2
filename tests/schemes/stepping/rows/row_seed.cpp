// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_seed.hpp"

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int N = 19, halo = 2, most = 9;
constexpr double tiny_step = 1e-40;  // so many make a unit of time that little may be left by each

/// Rows of a field that is a polynomial in time, with small whole numbers for coefficients: every row and every seed is
/// exact. With a turn the sites count up, so that they go on beyond the seam.
struct Polynomial {
  int degree, components;
  double turn;

  double operator()(std::int64_t n, int i, int a) const {
    double value = 0, power = 1;
    for (int p = 0; p <= degree; ++p, power *= static_cast<double>(n))
      value += power * (p == 0 ? (turn != 0 ? i : i % 5) : p == degree ? 1 + (i + a) % 2 : (i * (p + 1) + a) % 3 - 1);
    return value;
  }
};

struct Seeded {
  Evolution evolution;
  SectionRows rows;
  RowSeed seed;
  RowBuffer candidates;
  std::vector<double*> candidate;
  std::int64_t newest;

  Seeded(const Polynomial& field, std::int64_t last, double time_step = tiny_step)
      : evolution(evolution_of(problem_of(field.components == 1 ? "sine-gordon" : "coupled-sine-gordon"),
                               "rectangle-symmetric", Lattice::circle(N, 5), 0.1)),
        rows(evolution.system(), halo, 3, most + 1, field.turn),
        seed(rows, time_step, most, {{{{Site{}, 1.0}}}}),
        candidates(rows.layout(), field.components),
        newest(last) {
    for (std::int64_t n = 0; n <= last; ++n) {
      Row row;
      for (int i = 0; i < N; ++i)
        for (int a = 0; a < field.components; ++a) row.push_back(field(n, i, a));
      rows.set_row(n, row);
      if (n > 0) rows.find_increment(n);
    }
    for (int a = 0; a < field.components; ++a) candidate.push_back(candidates.row(a));
  }

  /// The largest difference between the candidate of this order and the next row, beyond the ends of arcs too.
  double miss(const Polynomial& field, int order) {
    seed.find(newest, order, candidate.data());
    const RowLayout& layout = rows.layout();
    double worst = 0;
    for (int a = 0; a < field.components; ++a)
      for (int l = 0; l < lanes; ++l)
        for (int v = -halo; v < layout.packs() + halo; ++v) {
          const int i = layout.start(l) + v, home = (i % N + N) % N;
          const double expected = field(newest + 1, home, a) + field.turn * ((i - home) / N);
          worst = std::max(worst, std::abs(candidate[static_cast<std::size_t>(a)][layout.at(v) + l] - expected));
        }
    return worst;
  }
};

constexpr double contraction = 1e-3;

}  // namespace

TEST_CASE("a seed of order p foretells polynomials of degree p, and none above") {
  for (int components : {1, 2})
    for (double turn : {0.0, 57.0})
      for (int degree = 1; degree <= 8; ++degree) {
        const Polynomial field{degree, components, turn};
        Seeded seeded(field, 12);
        for (int order = 1; order <= most; ++order) {
          CAPTURE(components, turn, degree, order);
          if (order >= degree) CHECK(seeded.miss(field, order) == 0);
          else CHECK(seeded.miss(field, order) >= 1);
        }
      }
}

TEST_CASE("a seed of order 0 is the newest row, and near the start the order is what there are rows for") {
  const Polynomial line{1, 1, 0};
  Seeded seeded(line, 5);
  seeded.seed.find(5, 0, seeded.candidate.data());
  for (int i = 0; i < N; ++i) CHECK(seeded.candidate[0][seeded.rows.layout().slot(i)] == line(5, i, 0));
  for (std::int64_t newest : {1, 2, 3, 6}) {
    const Polynomial field{static_cast<int>(newest), 1, 0}, higher{static_cast<int>(newest) + 1, 1, 0};
    Seeded early(field, newest), beyond(higher, newest);
    CHECK(early.miss(field, most) == 0);
    CHECK(beyond.miss(higher, most) >= 1);
    early.seed.choose(newest, 1e-13, contraction);
    CHECK(early.seed.order() <= (newest == 1 ? most : newest - 1));  // find() takes what there is
  }
}

TEST_CASE("the order chosen is the lowest that spares an iteration, and below four where nothing is missed") {
  for (int degree = 1; degree <= 8; ++degree) {
    CAPTURE(degree);
    const Polynomial field{degree, 1, 0};
    Seeded seeded(field, 12);
    seeded.seed.choose(12, 1e-16, contraction);  // what is missed at all costs iterations
    CHECK(seeded.seed.order() == degree);
    seeded.seed.restart();
    seeded.seed.choose(12, 1e16, contraction);  // one iteration will do for whatever is missed
    CHECK(seeded.seed.order() == std::min(degree, 4));
    seeded.seed.restart();
    seeded.seed.choose(12, 1e-16, 0.5);  // changes that hardly shrink say nothing
    CHECK(seeded.seed.order() == most);
  }
}

TEST_CASE("outputs are extrapolated where one iteration is not enough, with what misses less of orders three and four") {
  for (int degree = 2; degree <= most + 3; ++degree) {
    CAPTURE(degree);
    Seeded seeded({degree, 1, 0}, 14);
    seeded.seed.choose(14, 1e-16, contraction);
    // Up to the highest order that there is nothing is missed.
    CHECK((seeded.seed.order_of_outputs() > 0) == (degree > most));
    if (degree > most) {
      const bool four = seeded.miss({degree, 1, 0}, 4) < seeded.miss({degree, 1, 0}, 3);
      CHECK(seeded.seed.order_of_outputs() == (four ? 4 : 3));
    }
    seeded.seed.restart();
    seeded.seed.choose(14, 1e16, contraction);  // one iteration will do for whatever is missed
    CHECK(seeded.seed.order_of_outputs() == 0);
  }
}

TEST_CASE("orders below four serve where steps leave little in a unit of time") {
  const Polynomial field{8, 1, 0};
  const auto order = [&](double time_step, double tolerance) {
    Seeded seeded(field, 12, time_step);
    seeded.seed.choose(12, tolerance, contraction);
    return seeded.seed.order();
  };
  // One iteration will do for whatever is missed; what differs is what all of them leave.
  std::vector<int> orders;
  for (double time_step = 1e-21; time_step < 1e-15; time_step *= 2) orders.push_back(order(time_step, 1e16));
  CHECK(std::ranges::is_sorted(orders, std::greater()));
  CHECK(orders.front() == 4);
  CHECK(orders.back() == 1);
  CHECK(std::ranges::count(orders, 2) + std::ranges::count(orders, 3) > 0);
  CHECK(order(1.0, 1e-16) == 8);
}

TEST_CASE("the order is looked at again only now and then, and after a restart") {
  const Polynomial field{7, 1, 0};
  Seeded seeded(field, 20);
  seeded.seed.choose(20, 1e-16, contraction);
  REQUIRE(seeded.seed.order() == 7);
  seeded.seed.choose(20, 1e16, contraction);
  CHECK(seeded.seed.order() == 7);
  seeded.seed.restart();
  seeded.seed.choose(20, 1e16, contraction);
  CHECK(seeded.seed.order() == 4);
}

TEST_CASE("the order is chosen by what the nonlinear part looks at") {
  // Neighbours' differences of a field that moves alike everywhere are constant in time: any order foretells them.
  const Argument difference{{{Site{0, 0}, -1.0}, {Site{0, 1}, 1.0}}};
  Evolution evolution = evolution_of(problem_of("sine-gordon"), "rectangle-symmetric", Lattice::circle(N, 5), 0.1);
  for (bool itself : {false, true}) {
    SectionRows rows(evolution.system(), halo, 3, most + 1, 0);
    for (std::int64_t n = 0; n <= 12; ++n) {
      Row row;
      for (int i = 0; i < N; ++i) row.push_back(i % 4 + static_cast<double>(n * n * n * n * n * n));
      rows.set_row(n, row);
      if (n > 0) rows.find_increment(n);
    }
    std::vector<Argument> looks{difference};
    if (itself) looks.push_back({{{Site{}, 1.0}}});
    RowSeed seed(rows, tiny_step, most, looks);
    seed.choose(12, 1e-16, contraction);
    CHECK(seed.order() == (itself ? 6 : 1));
    CHECK(seed.span() == 3);  // wherever the field has drifted to
  }
}

TEST_CASE("the span is that of the component that spans most") {
  for (int components : {1, 2}) {
    const Polynomial field{2, components, 0};
    Seeded seeded(field, 12);
    seeded.seed.choose(12, 1e-10, contraction);
    double span = 0;
    for (int a = 0; a < components; ++a) {
      double least = field(12, 0, a), largest = least;
      for (int i = 0; i < N; ++i)
        least = std::min(least, field(12, i, a)), largest = std::max(largest, field(12, i, a));
      span = std::max(span, largest - least);
    }
    CHECK(seeded.seed.span() == span);
  }
}

TEST_CASE("long rows are seeded from few others") {
  CHECK(RowSeed::rows_for(8, 255) == 7);
  CHECK(RowSeed::rows_for(1, 255) == 1);
  CHECK(RowSeed::rows_for(2, 255) == 1);
  CHECK(RowSeed::rows_for(100, 255) <= 11);
  CHECK(RowSeed::rows_for(8, 1000000) == 3);
  CHECK(RowSeed::rows_for(2, 1000000) == 1);
}
