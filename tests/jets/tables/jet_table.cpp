// SPDX-License-Identifier: MIT
#include "jets/tables/jet_table.hpp"

#include <cmath>

#include "jets/discrete_lagrangian.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::for_each_map;
using delf::testing::Random;

namespace {

// (5.9) with one thing wrong in each.
constexpr auto with = [](double w, double phi, double phi_t, double phi_x) {
  return JetTable<4, 1>{
      shapes::rectangle, 1, {{{w, {phi, .25, .25, .25}, {-.5, phi_t, .5, -.5}, {-.5, -.5, phi_x, .5}}}}};
};
struct Right {
  static constexpr auto table = with(1, .25, .5, .5);
};
struct WrongWeight {
  static constexpr auto table = with(.9, .25, .5, .5);
};
struct WrongMean {
  static constexpr auto table = with(1, .35, .5, .5);
};
struct WrongVelocity {
  static constexpr auto table = with(1, .25, .4, .5);
};
struct WrongSlope {
  static constexpr auto table = with(1, .25, .5, -.5);
};
/// φ_t sees the slope in space: (y₃ − y₁)/h
struct Skew {
  static constexpr JetTable<4, 1> table{
      shapes::rectangle, 1, {{{1, {.25, .25, .25, .25}, {-1, 0, 1, 0}, {-.5, -.5, .5, .5}}}}};
};
struct NoTable {};

static_assert(JetMap<Triangle> && JetMap<TriangleVertex> && JetMap<Rectangle> && JetMap<RectangleSymmetric> &&
              JetMap<Hexagon> && JetMap<SixTuple> && JetMap<NineTuple> && JetMap<Right>);
static_assert(!JetMap<WrongWeight> && !JetMap<WrongMean> && !JetMap<WrongVelocity> && !JetMap<WrongSlope> &&
              !JetMap<Skew> && !JetMap<NoTable> && !JetMap<int>);
static_assert(is_consistent(Right::table) && !is_consistent(WrongMean::table));

/// φ(t, x) = sin(t + 0.3) cos(0.7x) + 0.2x, about (t₀, x₀)
double phi(double t, double x) { return std::sin(t + .3) * std::cos(.7 * x) + .2 * x; }
double phi_t(double t, double x) { return std::cos(t + .3) * std::cos(.7 * x); }
double phi_x(double t, double x) { return -.7 * std::sin(t + .3) * std::sin(.7 * x) + .2; }

/// |Σ_q w_q ℓ(jet_q)/1 − ℓ(jet at the middle of the stencil)| with h = k = e, ℓ = cos φ φ_t² − φ_x³.
template <class Map>
double quadrature_error(Map, double e) {
  const auto density = [](double u, double ut, double ux) { return std::cos(u) * ut * ut - ux * ux * ux; };
  constexpr const auto& map = Map::table;
  double t = 0, x = 0, sum = 0;
  for (int l = 0; l < map.vertices; ++l) {
    t += e * map.shape.vertex(l).time / map.vertices;
    x += e * map.shape.vertex(l).space / map.vertices;
  }
  for (const auto& p : map.quadrature) {
    double u = 0, ut = 0, ux = 0;
    for (int l = 0; l < map.vertices; ++l) {
      const double y = phi(e * map.shape.vertex(l).time, e * map.shape.vertex(l).space);
      const std::size_t at = l;
      u += p.phi[at] * y, ut += p.phi_t[at] * y / e, ux += p.phi_x[at] * y / e;
    }
    sum += p.weight * density(u, ut, ux);
  }
  return std::abs(sum - density(phi(t, x), phi_t(t, x), phi_x(t, x)));
}
template <class Map>
double order_of(Map map) {
  return std::log2(quadrature_error(map, 0.02) / quadrature_error(map, 0.01));
}

}  // namespace

TEST_CASE("every jet map finds value, velocity and slope of affine fields") {
  Random random(1);
  for_each_map([&]<class Map>(Map) {
    constexpr const auto& map = Map::table;
    const double a = random(-2, 2), b = random(-2, 2), c = random(-2, 2), h = 0.3, k = 0.7;
    const auto affine = [&](double t, double x) { return a + b * h * t + c * k * x; };
    for (const auto& p : map.quadrature) {
      double u = 0, ut = 0, ux = 0;
      for (int l = 0; l < map.vertices; ++l) {
        const double y = affine(map.shape.vertex(l).time, map.shape.vertex(l).space);
        const std::size_t at = l;
        u += p.phi[at] * y, ut += p.phi_t[at] * y / h, ux += p.phi_x[at] * y / k;
      }
      CHECK(std::abs(u - affine(time_offset(map.shape, p), space_offset(map.shape, p))) < 1e-14);
      CHECK(std::abs(ut - b) < 1e-14);
      CHECK(std::abs(ux - c) < 1e-14);
    }
  });
}

TEST_CASE("stencils stand for the whole area once: measure times stencils a site is 1") {
  for_each_map([]<class Map>(Map) {
    constexpr const auto& map = Map::table;
    const double stencils_a_site = map.shape.placement == Placement::brick_wall ? 0.5 : 1;
    CHECK(map.measure * stencils_a_site == 1);
    double total = 0;
    for (const auto& p : map.quadrature) total += p.weight;
    CHECK(std::abs(total - 1) < 1e-15);
  });
}

TEST_CASE("tables that are not exact on affine fields are refused") {
  CHECK(is_consistent(Right::table));
  CHECK_FALSE(is_consistent(WrongWeight::table));
  CHECK_FALSE(is_consistent(WrongMean::table));
  CHECK_FALSE(is_consistent(WrongVelocity::table));
  CHECK_FALSE(is_consistent(WrongSlope::table));
  CHECK_FALSE(is_consistent(Skew::table));
}

TEST_CASE("stencils that are alike about their middle integrate with second order") {
  CHECK(std::abs(order_of(rectangle) - 2) < 0.1);
  CHECK(std::abs(order_of(rectangle_symmetric) - 2) < 0.1);
  CHECK(std::abs(order_of(hexagon) - 2) < 0.1);
  CHECK(std::abs(order_of(six_tuple) - 2) < 0.1);
  CHECK(std::abs(order_of(nine_tuple) - 2) < 0.1);
}

TEST_CASE("the order can be seen to be less: a single triangle is of first order, only their sum is of second") {
  CHECK(std::abs(order_of(triangle) - 1) < 0.1);
  CHECK(std::abs(order_of(triangle_vertex) - 1) < 0.1);
}
