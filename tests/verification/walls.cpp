// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "lattice/index.hpp"
#include "schemes/scheme.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/verification/experiment.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A solution that the walls allow.
struct Solution {
  const char* name;
  const char* theory;
  Wall left, right;
  double length, until;
};
constexpr Wall fixed = Wall::fixed, natural = Wall::natural;
const char* const stencils_with_walls[] = {"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric"};

// φ = X(x) cos ωt, X the second standing mode: sin or cos of a multiple of x, with a node or a crest at each wall.
constexpr Solution nodes{"plane-wave", "klein-gordon", fixed, fixed, 10, 4};
constexpr Solution crests{"plane-wave", "klein-gordon", natural, natural, 10, 4};
constexpr Solution crest_node{"plane-wave", "klein-gordon", natural, fixed, 10, 4};
constexpr Solution node_crest{"plane-wave", "klein-gordon", fixed, natural, 10, 4};
// A breather centred at a wall is even there, φ_x = 0; a pair of kinks is odd, φ = 0. The other wall is far away.
constexpr Solution half_breather{"breather", "sine-gordon", natural, fixed, 20, 6};
constexpr Solution breathers_other_half{"breather", "sine-gordon", fixed, natural, 20, 6};
constexpr Solution half_pair{"kink-kink", "sine-gordon", fixed, fixed, 30, 6};

double error_at(const SchemeName& scheme, const Solution& solution, int cells, Start how) {
  const Lattice lattice = Lattice::interval(cells + 1, solution.length, solution.left, solution.right);
  const Problem p = problem_for(scheme, solution.theory, lattice, 0.5);
  StateRequest request;
  request.name = solution.name, request.theory = solution.theory;
  if (request.name == "plane-wave") request.values["initial.wavenumber"] = 2;
  else request.values["initial.position"] = solution.right == natural ? solution.length : 0;
  if (request.name == "breather") request.values["initial.frequency"] = 0.6;
  if (request.name == "kink-kink") request.values["initial.speed"] = 0.5, request.values["initial.separation"] = 6;
  const int steps = static_cast<int>(std::lround(solution.until / p.time_step));
  return final_error(p, *make_state(request, lattice), steps, how);
}

double measured_order(const SchemeName& scheme, const Solution& solution, Start how) {
  return order(error_at(scheme, solution, 640, how), error_at(scheme, solution, 1280, how), 2);
}

bool second(double p) { return 1.9 <= p && p <= 2.1; }

/// The distance after 400 steps between an interval and the circle twice as long of which it is one half, with data
/// that are even (natural walls) or odd (fixed walls) about both its ends.
double from_mirror_image(const SchemeName& scheme, Wall wall) {
  const int M = 40;
  const double sign = wall == natural ? 1 : -1, q = std::numbers::pi / 10;
  const Lattice half = Lattice::interval(M + 1, 10, wall, wall), whole = Lattice::circle(2 * M, 20);
  Row y0(M + 1), y1(M + 1), z0(2 * M), z1(2 * M);
  for (std::size_t i = 0; i <= M; ++i) {
    const double x = half.position(static_cast<int>(i));
    y0[i] = wall == natural ? 2 * std::cos(2 * q * x) + std::cos(q * x) : 3 * std::sin(2 * q * x);
    if (wall == fixed && (i == 0 || i == M)) y0[i] = 0;
    y1[i] = 0.99 * y0[i];
    z0[i] = y0[i], z1[i] = y1[i];
    if (i > 0 && i < M) z0[2 * M - i] = sign * y0[i], z1[2 * M - i] = sign * y1[i];
  }
  Simulation a(problem_for(scheme, "sine-gordon", half, 0.5)), b(problem_for(scheme, "sine-gordon", whole, 0.5));
  a.start({y0, y1});
  b.start({z0, z1});
  for (int n = 2; n <= 400; ++n) a.step(), b.step();
  Row image = newest(b, whole);
  image.resize(M + 1);
  return distance(newest(a, half), image);
}

}  // namespace

TEST_CASE("fixed walls are of second order for every scheme on an interval") {
  for (const Solution& solution : {nodes, half_pair})
    for (const char* scheme : {"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric", "vu-quoc-li", "guo"})
      for (const Start how : {Start::exact, Start::centred}) {
        const bool comparator = std::string(scheme) == "vu-quoc-li" || std::string(scheme) == "guo";
        const SchemeName name = comparator ? SchemeName{"", scheme} : SchemeName{scheme};
        const double p = measured_order(name, solution, how);
        CAPTURE(solution.name, scheme, how == Start::exact, p);
        CHECK(second(p));
      }
}

TEST_CASE("natural walls are of second order") {
  for (const Solution& solution : {crests, crest_node, node_crest, half_breather, breathers_other_half})
    for (const char* stencil : stencils_with_walls)
      for (const Start how : {Start::exact, Start::centred}) {
        const double p = measured_order({stencil}, solution, how);
        CAPTURE(solution.name, stencil, how == Start::exact, p);
        CHECK(second(p));
      }
}

namespace {

/// φ = A₀(x) + A_L(x), each a solution of sine-Gordon that one wall allows, and constant far from it: a breather, even
/// about its wall, where that is natural; a pair of kinks, odd but for 2π, where it is fixed. Their sum solves the
/// equation but for the product of their tails, below 1e-10 at L = 30.
class BothWalls final : public State {
 public:
  explicit BothWalls(const Lattice& lattice) {
    for (const bool left : {true, false}) {
      StateRequest request;
      const bool is_natural = (left ? lattice.left() : lattice.right()) == natural;
      request.name = is_natural ? "breather" : "kink-kink", request.theory = "sine-gordon";
      request.values["initial.position"] = left ? 0 : lattice.length();
      if (is_natural) request.values["initial.frequency"] = 0.6;
      else request.values["initial.speed"] = 0.5, request.values["initial.separation"] = 6;
      parts_.push_back(make_state(request, lattice));
    }
  }
  void at(double t, double x, std::span<FieldPoint> out) const override {
    out[0] = {};
    for (const auto& part : parts_) {
      FieldPoint p;
      part->at(t, x, {&p, 1});
      out[0] = {out[0].phi + p.phi, out[0].phi_t + p.phi_t, out[0].phi_x + p.phi_x};
    }
  }
  bool exact() const override { return true; }
  std::string description() const override { return "a solution at each wall"; }

 private:
  std::vector<std::unique_ptr<State>> parts_;
};

constexpr std::pair<Wall, Wall> pairs_of_walls[] = {
    {fixed, fixed}, {fixed, natural}, {natural, fixed}, {natural, natural}};

/// h = k/2, until t = 6.
double error_at_both_walls(const char* stencil, Wall left, Wall right, int cells) {
  const Lattice lattice = Lattice::interval(cells + 1, 30, left, right);
  const Problem p = problem_for({stencil}, "sine-gordon", lattice, 0.5);
  return final_error(p, BothWalls(lattice), static_cast<int>(std::lround(6 / p.time_step)));
}

/// The order on the finest two of some lattices, each with twice as many cells as the one before.
void check_second_order(const char* stencil, Wall left, Wall right, std::initializer_list<int> cells) {
  std::vector<double> orders;
  double before = 0;
  for (const int count : cells) {
    const double error = error_at_both_walls(stencil, left, right, count);
    if (before != 0) orders.push_back(order(before, error, 2));
    before = error;
  }
  CAPTURE(stencil, left == natural, right == natural, orders, before);
  CHECK(second(orders.back()));
}

}  // namespace

TEST_CASE("every stencil that walls allow is of second order between all pairs of fixed and natural walls") {
  for (const auto& [left, right] : pairs_of_walls)
    for (const char* stencil : stencils_with_walls) check_second_order(stencil, left, right, {320, 640});
}

// The table of tests/README.md.
TEST_CASE("the order between all pairs of walls stays two up to 2561 sites", "[slow]") {
  for (const auto& [left, right] : pairs_of_walls)
    for (const char* stencil : stencils_with_walls) check_second_order(stencil, left, right, {320, 640, 1280, 2560});
}

TEST_CASE("between natural walls tables are of second order with the terms of the walls, and of first without") {
  // (5.9) as printed, φ_t on the left edge alone
  const StencilTable printed = stencil_table(
      JetTable<4, 1>{shapes::rectangle, 1, {{{1, {.25, .25, .25, .25}, {-1, 1, 0, 0}, {-.5, -.5, .5, .5}}}}});
  const auto order_of = [](const StencilTable& table, bool with_terms) {
    const auto error = [&](int cells) {
      const Lattice lattice = Lattice::interval(cells + 1, 30, natural, natural);
      const BothWalls state(lattice);
      const double h = 0.5 * lattice.space_step();
      const Scheme scheme{table, SineGordon{}};
      Evolution evolution = with_terms ? scheme.on(lattice, h) : Evolution(lattice, {scheme.family()}, h);
      evolution.stepper().start({values(state, 0, lattice), values(state, h, lattice)});
      while (evolution.stepper().newest() < std::lround(6 / h)) evolution.stepper().step();
      return distance(evolution.stepper().row(0), values(state, 6, lattice));
    };
    return order(error(320), error(640), 2);
  };
  for (const StencilTable& table : {stencil_table(Triangle::table), stencil_table(TriangleVertex::table), printed}) {
    const double with = order_of(table, true), without = order_of(table, false);
    CAPTURE(table.pattern.size(), table.points[0][JetSlot::phi].size(), with, without);
    CHECK(second(with));
    CHECK(without < 1.3);
  }
}

TEST_CASE("between all pairs of walls the energy stays to second order too") {
  for (const auto& [left, right] : pairs_of_walls)
    for (const char* stencil : stencils_with_walls) {
      const auto error = [&, left = left, right = right](int cells) {
        const Lattice lattice = Lattice::interval(cells + 1, 30, left, right);
        const Problem p = problem_for({stencil}, "sine-gordon", lattice, 0.5);
        Simulation simulation(p);
        start(simulation, p, BothWalls(lattice), Start::exact);
        const double first = simulation.monitors().energy;
        double most = 0;
        while (simulation.newest() < std::lround(6 / p.time_step)) {
          simulation.step();
          most = std::max(most, std::abs(simulation.monitors().energy - first) / first);
        }
        return most;
      };
      const double p = order(error(160), error(320), 2);
      CAPTURE(stencil, left == natural, right == natural, p);
      CHECK(second(p));
    }
}

TEST_CASE("to rectangles a natural wall is a mirror, and a fixed wall one that changes the sign") {
  for (const SchemeName& scheme : {SchemeName{"rectangle"}, SchemeName{"rectangle-symmetric"}})
    for (const Wall wall : {natural, fixed}) {
      CAPTURE(scheme.text(), wall == natural);
      CHECK(from_mirror_image(scheme, wall) < 1e-11);
    }
}

TEST_CASE("the mirror can fail: triangles are not symmetric under reflection") {
  CHECK(from_mirror_image({"triangle"}, natural) > 1e-3);
}

namespace {

/// Of spacetime elements of degree 2, started by the discrete Legendre transform.
double element_error_at(const Solution& solution, int cells) {
  Problem p;
  p.theory = solution.theory, p.method = "spacetime";
  p.lattice = Lattice::interval(cells + 1, solution.length, solution.left, solution.right);
  p.time_step = 0.5 * p.lattice.space_step();
  StateRequest request;
  request.name = solution.name, request.theory = solution.theory, request.values["initial.wavenumber"] = 2;
  const auto state = make_state(request, p.lattice);
  Simulation simulation(p);
  const std::size_t sites = p.lattice.sites(), C = simulation.components().size();
  std::vector<double> row(sites * C), velocity(sites * C), at_node(sites);
  for (std::size_t c = 0; c < C; ++c) {
    const Lattice shifted = p.lattice.shifted(simulation.components()[c].at.space * p.lattice.space_step());
    state->values(0, shifted, at_node);
    for (std::size_t i = 0; i < sites; ++i) row[i * C + c] = at_node[i];
    state->velocities(0, shifted, at_node);
    for (std::size_t i = 0; i < sites; ++i) velocity[i * C + c] = at_node[i];
  }
  simulation.start_legendre(row, velocity);
  const auto steps = static_cast<std::int64_t>(std::lround(solution.until / p.time_step));
  while (simulation.newest() < steps) simulation.step();
  std::vector<double> newest(sites), exact(sites);
  simulation.copy_row(0, newest);
  state->values(static_cast<double>(steps) * p.time_step, p.lattice, exact);
  double error = 0;
  for (std::size_t i = 0; i < sites; ++i) error = std::max(error, std::abs(newest[i] - exact[i]));
  return error;
}

}  // namespace

TEST_CASE(
    "fixed and natural walls are of fourth order for elements of degree 2, whose nodes inside the first cell move") {
  for (const Solution& solution : {nodes, crests, crest_node, node_crest}) {
    const double order = std::log2(element_error_at(solution, 20) / element_error_at(solution, 40));
    CAPTURE(solution.name, solution.left == natural, solution.right == natural, order);
    CHECK(order > 3.8);
    CHECK(order < 4.2);
  }
}
