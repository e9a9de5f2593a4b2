// SPDX-License-Identifier: MIT
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "schemes/families/residual_family.hpp"
#include "schemes/scheme.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/families/vu_quoc_li.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Sine-Gordon with a term that is nothing, and of which nothing is known: its functions are asked at every value.
struct AlwaysAsked {
  SineGordon theory;
  auto operator()(const auto& j) const { return theory(j) + 0.0 * sin(1e9 * j.phi); }
  template <class T>
  T difference_quotient(const T& a, const T& b) const {
    return theory.difference_quotient(a, b) + 0.0 * sin(1e9 * (a + b));
  }
};

struct Run {
  std::vector<Row> rows;
  std::vector<double> residuals;
  std::string end;
};

/// Steps from two rows of size `size`, looked at now and then.
Run run_of(Evolution& evolution, double size, double off = 0, int steps = 400) {
  const int N = evolution.system().lattice().sites();
  std::vector<Row> start(2);
  for (int i = 0; i < N; ++i)
    for (int n = 0; n < 2; ++n)
      start[static_cast<std::size_t>(n)].push_back(size * std::sin(6.3 * i / N + 0.01 * n) + 0.3 * std::cos(i) + off);
  Stepper& stepper = evolution.stepper();
  stepper.start(start);
  Run run;
  try {
    for (int n = 0; n < steps; ++n) {
      const bool looked_at = n % 3 == 0;
      stepper.step(looked_at);
      if (!looked_at) continue;
      run.rows.push_back(stepper.row(0));
      run.residuals.push_back(stepper.residual());
    }
  } catch (const Error& error) {
    run.end = error.what();
  }
  return run;
}

template <class Map>
Run run_of(Map map, const auto& density, int sites, double courant, double size, double off = 0, int steps = 400) {
  const Lattice ring = Lattice::circle(sites, 0.2 * sites);
  Evolution evolution = Scheme{map, density}.on(ring, courant * ring.space_step());
  return run_of(evolution, size, off, steps);
}
template <template <class> class Stencil, class D>
Run comparator_run(const D& density, int sites, double size) {
  const Lattice ring = Lattice::circle(sites, 0.2 * sites);
  const double h = 0.25 * ring.space_step();
  Evolution evolution{
      ring, {std::make_shared<ResidualFamily<Stencil<D>>>(Stencil<D>{density}, h, ring.space_step())}, h, {}};
  return run_of(evolution, size);
}

void check_same(const Run& a, const Run& b) {
  REQUIRE(a.rows.size() == b.rows.size());
  CHECK(a.rows == b.rows);
  CHECK(a.residuals == b.residuals);
  CHECK(a.end == b.end);
}

}  // namespace

TEST_CASE("explicit steps have the same bits whether or not their functions are asked") {
  const SineGordon theory{1.2};
  for (const double size : {1.0, 500.0})
    check_same(run_of(triangle_vertex, theory, 255, 0.5, size),
               run_of(triangle_vertex, AlwaysAsked{theory}, 255, 0.5, size));
}

TEST_CASE("and in rows of any number of packs") {
  const SineGordon theory{1.2};
  for (int packs = 1; packs <= 24; ++packs) {
    const int sites = std::max(4, packs * lanes - 1);
    CAPTURE(sites);
    check_same(run_of(triangle_vertex, theory, sites, 0.5, 1.0, 0, 30),
               run_of(triangle_vertex, AlwaysAsked{theory}, sites, 0.5, 1.0, 0, 30));
  }
}

TEST_CASE("an unstable field outgrows what is near, and overflows as it would have") {
  const SineGordon theory{1.2};
  const Run near = run_of(triangle_vertex, theory, 100, 1.2, 1.0),
            asked = run_of(triangle_vertex, AlwaysAsked{theory}, 100, 1.2, 1.0);
  check_same(near, asked);
  CHECK(contains(near.end, "no longer finite"));
  double largest = 0;
  for (double y : near.rows.back()) largest = std::max(largest, std::abs(y));
  CHECK(largest > 1e100);
}

TEST_CASE("implicit steps have the same bits whether or not their functions are asked") {
  const SineGordon theory{1.2};
  // At 450 and more times 31, values are beyond what is near with a seed of order 4, and not without.
  for (const double size : {1.0, 3e4}) {
    CAPTURE(size);
    check_same(run_of(rectangle, theory, 99, 0.25, size), run_of(rectangle, AlwaysAsked{theory}, 99, 0.25, size));
    check_same(run_of(triangle, theory, 99, 0.25, size), run_of(triangle, AlwaysAsked{theory}, 99, 0.25, size));
    check_same(comparator_run<VuQuocLi>(theory, 99, size), comparator_run<VuQuocLi>(AlwaysAsked{theory}, 99, size));
  }
}

TEST_CASE("where a step in one loop is given up for large fields, its rows are those of two loops") {
  const SineGordon theory{1.2};
  for (const double off : {0.0, 1e6 * 6.283185307179586}) {
    CAPTURE(off);
    const Run near = run_of(triangle, theory, 900, 0.25, 1.0, off),
              asked = run_of(triangle, AlwaysAsked{theory}, 900, 0.25, 1.0, off);
    REQUIRE(near.rows.size() == asked.rows.size());
    double worst = 0;
    for (std::size_t r = 0; r < near.rows.size(); ++r)
      for (std::size_t i = 0; i < near.rows[r].size(); ++i)
        worst = std::max(worst, std::abs(near.rows[r][i] - asked.rows[r][i]));
    CHECK(worst <= 1e-12 * (1 + off));
    for (double residual : near.residuals) CHECK(residual < 1e-14 * (1 + off));
  }
}
