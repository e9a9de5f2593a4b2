// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "schemes/theories/wave_map.hpp"
#include "tests/catch.hpp"
#include "tests/verification/by_name.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

Lattice circle(int N) { return Lattice::circle(N, 2 * std::numbers::pi); }

ByName great_circle(const std::string& stencil, int N) {
  Problem p;
  p.theory = "wave-map", p.stencil = stencil, p.lattice = circle(N), p.time_step = 0.5 * p.lattice.space_step();
  StateRequest request;
  request.name = "great-circle";
  return {p, request};
}

/// max ||u|² − 1|, u of three components out of `stride`
double off_sphere(const std::vector<double>& y, std::size_t stride) {
  double most = 0;
  for (std::size_t i = 0; i < y.size(); i += stride)
    most = std::max(most, std::abs(y[i] * y[i] + y[i + 1] * y[i + 1] + y[i + 2] * y[i + 2] - 1));
  return most;
}

/// The wave map's density and nothing that keeps it on the sphere.
struct Free {
  static constexpr int components = 3;
  auto operator()(const auto& j) const { return WaveMap{}(j); }
};

/// A sphere in a field that pulls along its third axis: only turns about that one leave it as it is.
struct Pulled {
  static constexpr int components = 3;
  double pull = 0.3;
  auto operator()(const auto& j) const { return WaveMap{}(j) - (0.5 * pull) * (j.phi[2] * j.phi[2]); }
  auto constraint(const auto& u) const { return WaveMap{}.constraint(u); }
};

/// Constraint and momenta over a run. They start at 0, for the angle's wave carries none: changes are absolute.
void stays(const std::string& stencil, int steps) {
  ByName run = great_circle(stencil, 32);
  const auto first = run.simulation().monitors().conserved;
  REQUIRE(first.size() == 3);
  double constraint = 0, drift = 0, sphere = 0;
  for (int n = 10; n <= steps; n += 10) {
    const auto now = run.to(n).simulation().monitors();
    constraint = std::max(constraint, now.constraint);
    sphere = std::max(sphere, off_sphere(run.newest(), 3));
    for (std::size_t a = 0; a < 3; ++a) drift = std::max(drift, std::abs(now.conserved[a] - first[a]));
  }
  CAPTURE(stencil, constraint, sphere, drift);
  CHECK(constraint < 2e-14);
  CHECK(sphere < 2e-14);
  CHECK(drift < 1e-11);
}

}  // namespace

TEST_CASE("a wave map stays on its sphere and keeps its three momenta over 10000 steps", "[slow]") {
  stays("triangle-vertex", 10000);
  stays("rectangle", 10000);
}

// On the symmetric rectangle, h = k/2, this run ends at step 416 (N = 32), 848 (64), 937 (31), by the growth of what the
// tests below measure.
TEST_CASE("a wave map stays on its sphere and keeps its three momenta on every stencil") {
  stays("triangle-vertex", 1000);
  stays("rectangle", 1000);
  stays("rectangle-symmetric", 400);
}

TEST_CASE("a wave on a great circle is followed to second order") {
  for (const char* stencil : {"triangle-vertex", "rectangle", "rectangle-symmetric"}) {
    const auto error = [&](int N) { return great_circle(stencil, N).to(5 * N / 8).error(); };  // t = 1.96
    const double e1 = error(32), e2 = error(64), e3 = error(128);
    const double coarse = std::log2(e1 / e2), fine = std::log2(e2 / e3);
    CAPTURE(stencil, e1, e2, e3, coarse, fine);
    CHECK(std::abs(coarse - 2) < 0.3);
    CHECK(std::abs(fine - 2) < 0.1);
  }
}

TEST_CASE("the check can fail: without the constraint the same density leaves the sphere and the great circle") {
  std::vector<double> errors;
  for (const int N : {64, 128}) {
    const ByName wave = great_circle("rectangle", N);
    auto evolution = Scheme{rectangle, Free{}}.on(circle(N), std::numbers::pi / N);
    evolution.stepper().start({wave.exact_row(0), wave.exact_row(1)});
    while (evolution.stepper().newest() < 5 * N / 8) evolution.stepper().step();
    const std::vector<double> y = evolution.stepper().row(0), exact = wave.exact_row(5 * N / 8);
    double most = 0;
    for (std::size_t n = 0; n < y.size(); ++n) most = std::max(most, std::abs(y[n] - exact[n]));
    errors.push_back(most);
    CHECK(off_sphere(y, 3) > 0.1);
  }
  CHECK(std::abs(std::log2(errors[0] / errors[1])) < 0.3);
}

TEST_CASE("the momenta stay because rotations leave the density invariant: pulled along an axis, only that one stays") {
  const int N = 32;
  const ByName wave = great_circle("triangle-vertex", N);
  for (const double pull : {0.0, 0.3}) {
    auto evolution = Scheme{triangle_vertex, Pulled{pull}}.on(circle(N), std::numbers::pi / N);
    std::vector<std::vector<double>> rows;
    for (const int r : {0, 1}) {
      rows.emplace_back();
      const std::vector<double> u = wave.exact_row(r);
      for (std::size_t i = 0; i < u.size(); i += 3)
        rows.back().insert(rows.back().end(), {u[i], u[i + 1], u[i + 2], 0});
    }
    evolution.stepper().start(rows);
    const auto momentum = [&](const LinearSymmetry& s) {
      return noether_charge(evolution.system(), evolution.stepper().window(2), evolution.stepper().newest(), s);
    };
    const auto symmetries = WaveMap::symmetries();
    double first[3], drift[3] = {0, 0, 0};
    for (std::size_t a = 0; a < 3; ++a) first[a] = momentum(symmetries[a]);
    for (int n = 0; n < 100; ++n) {
      evolution.stepper().step();
      for (std::size_t a = 0; a < 3; ++a) drift[a] = std::max(drift[a], std::abs(momentum(symmetries[a]) - first[a]));
    }
    CAPTURE(pull, drift[0], drift[1], drift[2]);
    CHECK(drift[2] < 1e-12);
    CHECK((pull == 0 ? drift[0] < 1e-12 : drift[0] > 1e-2));
    CHECK((pull == 0 ? drift[1] < 1e-12 : drift[1] > 1e-2));
    CHECK(off_sphere(evolution.stepper().row(0), 4) < 2e-14);
  }
}

TEST_CASE("the multiplier's equation determines a component of the field, and one of the field's the multiplier") {
  const auto matched = [](const SolvePlan& plan) {
    const Slab slab = plan.slab(5);
    REQUIRE(slab.matched);
    int sites_where_constraint_gives_field = 0, sites_where_field_gives_multiplier = 0;
    for (std::size_t n = 0; n < slab.unknowns.size(); ++n) {
      sites_where_constraint_gives_field += slab.equations[n].component == 3 && slab.unknowns[n].component < 3;
      sites_where_field_gives_multiplier += slab.equations[n].component < 3 && slab.unknowns[n].component == 3;
    }
    return std::pair{sites_where_constraint_gives_field, sites_where_field_gives_multiplier};
  };
  const auto kept = Scheme{triangle_vertex, WaveMap{}}.on(circle(32), std::numbers::pi / 32);
  CHECK(matched(kept.plan()) == std::pair{32, 32});
  CHECK_FALSE(kept.plan().own);
  // the check can fail: without the constraint every equation of the field gives the field
  const auto free = Scheme{triangle_vertex, Free{}}.on(circle(32), std::numbers::pi / 32);
  CHECK(matched(free.plan()) == std::pair{0, 0});
  CHECK(free.plan().own);
}

namespace {

/// The field turns about the third axis, u = (cos ωt, sin ωt, 0), which every scheme keeps; with it (−1)ⁱ · 1e-10 along
/// that axis. How large that is after some steps.
template <JetMap Map>
double staggered_after(Map map, int N, double courant, double turn, int steps) {
  const double h = courant * circle(N).space_step();
  auto evolution = Scheme{map, WaveMap{}}.on(circle(N), h);
  std::vector<std::vector<double>> rows;
  for (const int n : {0, 1}) {
    rows.emplace_back();
    for (int i = 0; i < N; ++i) {
      const double staggered = (i % 2 == 0 ? 1e-10 : -1e-10) * (n == 0 ? 1 : -1);
      const double w = std::sqrt(1 - staggered * staggered), angle = turn * n * h;
      rows.back().insert(rows.back().end(), {w * std::cos(angle), w * std::sin(angle), staggered, 0});
    }
  }
  evolution.stepper().start(rows);
  while (evolution.stepper().newest() < steps) evolution.stepper().step();
  return std::abs(evolution.stepper().row(0)[2]);
}

}  // namespace

TEST_CASE("off a great circle the symmetric rectangle has a staggered wave that grows as its root says, k or not") {
  const double turn = 1;
  for (const int N : {32, 64})
    for (const double courant : {0.125, 0.25, 0.5}) {
      // −z = e^s with sinh(s/2) = sin(ωh/2)/(h/k)
      const double h = courant * circle(N).space_step();
      const double s = 2 * std::asinh(std::sin(turn * h / 2) / courant);
      const int steps = static_cast<int>(4 / s);
      const double measured = std::log(staggered_after(rectangle_symmetric, N, courant, turn, steps) /
                                       staggered_after(rectangle_symmetric, N, courant, turn, steps - 1));
      CAPTURE(N, courant, measured, s, measured / h);
      CHECK(measured == Approx(s).epsilon(0.01));
      CHECK(measured / h == Approx(turn / courant).epsilon(0.05));  // per unit time: faster for shorter steps
    }
  // the check can fail: other stencils have no such wave
  CHECK(staggered_after(rectangle_symmetric, 32, 0.25, turn, 40) > 1e-8);
  for (int steps = 30; steps <= 40; ++steps) CHECK(staggered_after(rectangle, 32, 0.25, turn, steps) < 1e-9);
}

TEST_CASE("a run that the staggered wave ends says so, and does not advise a shorter step") {
  // 1e-3 of the wave: there from the start, so that the run ends soon
  const int N = 16;
  const double h = 0.125 * circle(N).space_step();
  auto evolution = Scheme{rectangle_symmetric, WaveMap{}}.on(circle(N), h);
  std::vector<std::vector<double>> rows;
  for (const int n : {0, 1}) {
    rows.emplace_back();
    for (int i = 0; i < N; ++i) {
      const double staggered = 1e-3 * (i % 2 == 0 ? 1 : -1) * (n == 0 ? 1 : -1);
      const double w = std::sqrt(1 - staggered * staggered);
      const double angle = 0.3 * std::cos(2 * std::numbers::pi * i / N) + n * h;
      rows.back().insert(rows.back().end(), {w * std::cos(angle), w * std::sin(angle), staggered, 0});
    }
  }
  evolution.stepper().start(rows);
  std::string message;
  try {
    for (int n = 0; n < 2000; ++n) evolution.stepper().step();
  } catch (const NoConvergence& stop) {
    message = stop.what();
  }
  CAPTURE(message);
  CHECK(message.find("theta = pi, z = -1") != std::string::npos);
  CHECK(message.find("lattice.stencil = rectangle") != std::string::npos);
  CHECK(message.find("reduce") == std::string::npos);
}
