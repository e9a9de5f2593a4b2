// SPDX-License-Identifier: MIT
#include "schemes/solvers/row_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/stepping/rows/site_slots.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Checks every slot of a row: lane l, pack v holds site start(l) + v, 1000 higher for every time round the circle, or
/// the nearest wall beyond an interval.
void check_slots(const Lattice& lattice, int halo) {
  const int N = lattice.sites();
  CAPTURE(N, halo, lattice.is_circle());
  const RowLayout layout(lattice, halo);
  RowBuffer row(layout, 1);
  layout.scatter(numbered(N), row.row(0), 1000);
  bool right = true;
  for (int l = 0; l < lanes; ++l)
    for (int v = -halo; v < layout.packs() + halo; ++v) {
      const int i = layout.start(l) + v;
      const double expected =
          lattice.is_circle() ? lattice.wrapped(i) + 1000 * ((i - lattice.wrapped(i)) / N) : std::clamp(i, 0, N - 1);
      right = right && row.row(0)[layout.at(v) + l] == expected;
    }
  CHECK(right);
}

}  // namespace

TEST_CASE("every site has its slot, alone in the arc of a lane, and arcs cover the row") {
  for (int N = 2; N <= 70; ++N)
    for (const Lattice& lattice : {Lattice::circle(N, 1), Lattice::interval(N, 1)}) {
      const RowLayout layout(lattice, 2);
      CAPTURE(N);
      CHECK(layout.packs() == (N + lanes - 1) / lanes);
      CHECK(layout.doubles() == delf::at((layout.packs() + 4) * lanes));
      check_site_slots(layout, N);
    }
}

TEST_CASE("scattered rows are gathered again") {
  for (int N = 2; N <= 70; ++N) {
    const RowLayout layout(Lattice::circle(N, 1), 1);
    RowBuffer row(layout, 1);
    std::vector<double> back(N, -1);
    layout.scatter(numbered(N), row.row(0), 3.5);
    layout.gather(row.row(0), back);
    CHECK(back == numbered(N));
    for (int i = 0; i < N; ++i) CHECK(row.row(0)[layout.slot(i)] == i);
  }
}

TEST_CASE("halos repeat the sites across the ends of arcs, with a turn for every time round, and walls") {
  for (int N = 2; N <= 70; ++N)
    for (int halo = 1; halo <= 3; ++halo) {
      check_slots(Lattice::circle(N, 1), halo);
      check_slots(Lattice::interval(N, 1), halo);
    }
}

TEST_CASE("a neighbour's slot is one pack away") {
  for (int N : {2, 3, 7, 8, 9, 16, 63, 64, 65}) {
    const Lattice circle = Lattice::circle(N, 1);
    const RowLayout layout(circle, 2);
    RowBuffer row(layout, 1);
    layout.scatter(numbered(N), row.row(0));
    for (int i = 0; i < N; ++i)
      for (int s = -2; s <= 2; ++s) CHECK(row.row(0)[layout.slot(i) + s * lanes] == circle.wrapped(i + s));
  }
}

TEST_CASE("a halo that was not filled shows: the neighbour is the one before") {
  const RowLayout layout(Lattice::circle(9, 1), 1);
  RowBuffer row(layout, 1);
  layout.scatter(numbered(9), row.row(0));
  row.row(0)[layout.slot(8)] = 80;
  CHECK(row.row(0)[layout.slot(0) - lanes] == 8);
  layout.fill_halo(row.row(0));
  CHECK(row.row(0)[layout.slot(0) - lanes] == 80);
}

TEST_CASE("packs beside a row are found from the row alone") {
  const auto same = [](Pack a, Pack b) {
    for (int l = 0; l < lanes; ++l)
      if (a[l] != b[l]) return false;
    return true;
  };
  for (int N : {61, 64, 66, 127, 128}) {
    constexpr int halo = 2;
    const RowLayout layout(Lattice::circle(N, 1), halo);
    CAPTURE(N);
    REQUIRE(layout.finds_halos_by_packs());
    RowBuffer filled(layout, 1), bare(layout, 1);
    layout.scatter(numbered(N), filled.row(0));
    const auto first = layout.at(0), end = layout.at(layout.packs());
    for (std::size_t s = 0; s < layout.doubles(); ++s) bare.row(0)[s] = std::nan("");
    for (auto s = first; s < end; ++s) bare.row(0)[s] = filled.row(0)[s];
    CHECK(same(layout.before_first(bare.row(0)), Pack::load(filled.row(0) + first - lanes)));
  }
}

TEST_CASE("copy_overlaps makes every slot of a site equal to its own") {
  for (int N : {2, 3, 5, 9, 17, 61}) {
    const RowLayout layout(Lattice::circle(N, 1), 1);
    RowBuffer row(layout, 1);
    for (std::size_t s = 0; s < layout.doubles(); ++s) row.row(0)[s] = -1;
    for (int i = 0; i < N; ++i) row.row(0)[layout.slot(i)] = i;
    layout.copy_overlaps(row.row(0));
    for (int i = 0; i < N; ++i)
      for (int slot : layout.slots_of(i)) CHECK(row.row(0)[slot] == i);
  }
}

TEST_CASE("rows are zero at first and lie at cache lines") {
  const RowLayout layout(Lattice::circle(13, 1), 1);
  RowBuffer rows(layout, 5);
  CHECK(rows.rows() == 5);
  for (int r = 0; r < 5; ++r) {
    CHECK(reinterpret_cast<std::uintptr_t>(rows.row(r)) % 64 == 0);
    for (std::size_t s = 0; s < layout.doubles(); ++s) CHECK(rows.row(r)[s] == 0);
  }
  CHECK(RowBuffer(layout, 0).bytes() == 0);
}
