// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numbers>

#include "lattice/index.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/stepping/rows/site_slots.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

bool starts_even(const RowLayout& layout) {
  for (int l = 0; l < lanes; ++l)
    if (layout.start(l) % 2 != 0) return false;
  return true;
}

}  // namespace

TEST_CASE("the arcs of a brick wall start at even sites, cover the row, and each pack holds one parity") {
  for (int N = 2; N <= 140; N += 2)
    for (int halo = 1; halo <= 3; ++halo) {
      CAPTURE(N, halo);
      const Lattice circle = Lattice::circle(N, 1);
      const RowLayout layout(circle, halo, 2);
      CHECK(starts_even(layout));
      CHECK(layout.packs() % 2 == 0);
      CHECK(layout.packs() * lanes >= N);
      RowBuffer row(layout, 1);
      layout.scatter(numbered(N), row.row(0), 1000);
      bool right = true;
      for (int l = 0; l < lanes; ++l) {
        const int next = l + 1 < lanes ? layout.start(l + 1) : N;
        right = right && layout.start(l) >= 0 && layout.start(l) + layout.packs() <= N &&
                layout.start(l) + layout.packs() >= next && layout.start(l) <= next;
        for (int v = -halo; v < layout.packs() + halo; ++v) {
          const int i = layout.start(l) + v, home = circle.wrapped(i);
          right = right && row.row(0)[layout.at(v) + l] == home + 1000 * ((i - home) / N) && (i - v) % 2 == 0;
        }
      }
      CHECK(right);
    }
}

TEST_CASE("every site of a brick wall has its slot, and all of its slots are known") {
  for (int N = 2; N <= 140; N += 2) {
    CAPTURE(N);
    const RowLayout layout(Lattice::circle(N, 1), 2, 2);
    check_site_slots(layout, N);

    RowBuffer row(layout, 1);
    Row back(at(N), -1);
    layout.scatter(numbered(N), row.row(0));
    layout.gather(row.row(0), back);
    CHECK(back == numbered(N));
    for (int i = 0; i < N; ++i)
      for (int slot : layout.slots_of(i)) row.row(0)[slot] = slot == layout.slot(i) ? i : -1;
    layout.copy_overlaps(row.row(0));
    for (int i = 0; i < N; ++i)
      for (int slot : layout.slots_of(i)) CHECK(row.row(0)[slot] == i);
  }
}

TEST_CASE("arcs that are not aligned start at odd sites too") {
  int odd = 0;
  for (int N = 2; N <= 140; N += 2) odd += starts_even(RowLayout(Lattice::circle(N, 1), 1)) ? 0 : 1;
  CHECK(odd > 30);
}

TEST_CASE("a brick wall's steps solve the equations of its hexagons, site by site") {
  for (const std::string theory : {"sine-gordon", "phi4", "coupled-sine-gordon", "sine-gordon-impurity"})
    for (int N : {4, 6, 8, 10, 14, 16, 18, 30, 34, 62, 64, 66, 130, 254, 256}) {
      CAPTURE(theory, N);
      const double k = 0.25;
      Evolution evolution = evolution_of(problem_of(theory), "hexagon", Lattice::circle(N, N * k), 0.1);
      Stepper& stepper = evolution.stepper();
      REQUIRE(stepper.layout());
      CHECK(starts_even(*stepper.layout()));
      Random random(41);
      stepper.start(random_rows(random, stepper.starting_rows(), N * evolution.system().components(), 1));
      for (int n = 0; n < 5; ++n) {
        stepper.step();
        CHECK(equation_defect(evolution, window_of(evolution)) < 1e-14);
        CHECK(stepper.residual() < 1e-14);
      }
      Window wrong = window_of(evolution);
      wrong.rows.back()[1] += 1e-10;
      CHECK(equation_defect(evolution, wrong) > 1e-13);
    }
}

TEST_CASE("a brick wall with a winding too") {
  for (int N : {8, 18, 66, 254}) {
    CAPTURE(N);
    Problem p = problem_of("sine-gordon");
    p.lattice = Lattice::circle(N, N * 0.25);
    p.stencil = "hexagon";
    p.time_step = 0.1;
    p.winding = 1;
    const double monodromy = 2 * std::numbers::pi;
    Simulation simulation(p);
    Random random(4);
    std::vector<Row> rows = random_rows(random, simulation.starting_rows(), N, 0.1);
    for (Row& row : rows)
      for (int i = 0; i < N; ++i) row[i] += monodromy * i / N;
    simulation.start(rows);
    for (int n = 0; n < 5; ++n) simulation.step();
    const Evolution& evolution = simulation.evolution();
    CHECK(equation_defect(evolution, window_of(evolution, monodromy)) < 1e-14);
    CHECK(equation_defect(evolution, window_of(evolution, 1.01 * monodromy)) > 1e-6);
  }
}
