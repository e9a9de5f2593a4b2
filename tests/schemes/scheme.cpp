// SPDX-License-Identifier: MIT
#include "schemes/scheme.hpp"

#include <numbers>

#include "jets/discrete_lagrangian.hpp"
#include "jets/tables/hexagon_jet.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "lattice/shapes/rectangle.hpp"
#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A user's theory: ℓ = ½φ_t² − ½φ_x² − ¼(φ² − 1)²
struct MyPhiFour {
  auto operator()(const auto& j) const {
    const auto w = j.phi * j.phi - 1.0;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - 0.25 * w * w;
  }
};

/// A user's stencil: the rectangle with one quadrature point at each corner, whose jet looks along the two edges there.
/// Its equation has the five coefficients of (5.8) and N′ at the site alone: leapfrog.
struct Corners {
  static constexpr JetTable<4, 4> table{shapes::rectangle,
                                        1,
                                        {{{.25, {1, 0, 0, 0}, {-1, 1, 0, 0}, {-1, 0, 0, 1}},
                                          {.25, {0, 1, 0, 0}, {-1, 1, 0, 0}, {0, -1, 1, 0}},
                                          {.25, {0, 0, 1, 0}, {0, 0, 1, -1}, {0, -1, 1, 0}},
                                          {.25, {0, 0, 0, 1}, {0, 0, 1, -1}, {-1, 0, 0, 1}}}}};
};

/// A user's stencil with a shape of its own, of fourth order in space: Σ_m m²β_m ½[ℓ(y_i, D_m) + ℓ(y_{i+m}, D_m)] over
/// m = 1, 2 with D_m = (y_{i+m} − y_i)/mk and m²β_m = 4/3, −1/3.
struct Wide {
  static constexpr JetTable<6, 4> table{Offsets<6>{{{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}}}},
                                        1,
                                        {{{2. / 3, {1, 0, 0, 0, 0, 0}, {-1, 0, 0, 1, 0, 0}, {-1, 1, 0, 0, 0, 0}},
                                          {2. / 3, {0, 1, 0, 0, 0, 0}, {0, -1, 0, 0, 1, 0}, {-1, 1, 0, 0, 0, 0}},
                                          {-1. / 6, {1, 0, 0, 0, 0, 0}, {-1, 0, 0, 1, 0, 0}, {-.5, 0, .5, 0, 0, 0}},
                                          {-1. / 6, {0, 0, 1, 0, 0, 0}, {0, 0, -1, 0, 0, 1}, {-.5, 0, .5, 0, 0, 0}}}}};
};

double breather(double t, double x) {
  const double w = 0.6, a = std::sqrt(1 - w * w);
  return 4 * std::atan(a / w * std::cos(w * t) / std::cosh(a * x));
}

/// max |y − φ| at t = 2 from exact rows.
template <class Map>
double error(Map map, int sites, double h) {
  const auto lattice = Lattice::circle(sites, 40);
  auto evolution = Scheme{map, SineGordon{}}.on(lattice, h);
  const auto exact = [&](double t) {
    Row row;
    for (int i = 0; i < sites; ++i) row.push_back(breather(t, lattice.position(i) - 20));
    return row;
  };
  Stepper& stepper = evolution.stepper();
  stepper.start({exact(0), exact(h)});
  while (static_cast<double>(stepper.newest()) * h < 2 - h / 2) stepper.step();
  return distance(stepper.row(0), exact(static_cast<double>(stepper.newest()) * h));
}

}  // namespace

TEST_CASE("a user's theory on a shipped stencil is that of the registry") {
  const Lattice lattice = Lattice::circle(64, 20);
  const double h = 0.1;
  auto mine = Scheme{hexagon, MyPhiFour{}}.on(lattice, h);
  Problem p;
  p.theory = "phi4", p.parameters["theory.lambda"] = 1, p.lattice = lattice, p.stencil = "hexagon", p.time_step = h;
  Simulation theirs(p);
  Row y0;
  for (int i = 0; i < 64; ++i) y0.push_back(std::tanh(std::sin(2 * std::numbers::pi * i / 64)));
  mine.stepper().start({y0, y0});
  theirs.start({y0, y0});
  for (int n = 0; n < 50; ++n) mine.stepper().step(), theirs.step();
  Row row(64);
  theirs.copy_row(0, row);
  CHECK(distance(mine.stepper().row(0), row) < 1e-13);
  CHECK(mine.stepper().residual() < 1e-15);
}

TEST_CASE("a user's stencil is found to be explicit, and is of second order") {
  auto evolution = Scheme{Corners{}, SineGordon{}}.on(Lattice::circle(100, 40), 0.1);
  CHECK(evolution.plan().kind == SolveKind::explicit_);
  CHECK(evolution.stepper().report(false).solver == "division by one number");
  CHECK(std::abs(std::log2(error(Corners{}, 200, 0.1) / error(Corners{}, 400, 0.05)) - 2) < 0.1);
}

TEST_CASE("a user's stencil with a shape of its own is of fourth order in space") {
  CHECK(is_consistent(Wide::table));
  auto evolution = Scheme{Wide{}, SineGordon{}}.on(Lattice::circle(100, 40), 0.1);
  CHECK(evolution.plan().kind == SolveKind::explicit_);
  // h ∝ k²
  CHECK(std::abs(std::log2(error(Wide{}, 100, 0.05) / error(Wide{}, 200, 0.0125)) - 4) < 0.2);
  CHECK(std::abs(std::log2(error(Corners{}, 100, 0.05) / error(Corners{}, 200, 0.0125)) - 2) < 0.2);
}

TEST_CASE("a scheme hands out its Lagrangian and its family") {
  const Scheme scheme{rectangle, PhiFour{0.5}};
  CHECK(scheme.density().lambda == 0.5);
  const auto family = scheme.family();
  const std::array<double, 4> y{0.1, 0.3, -0.4, 0.2};
  const Cell cell{0.1, 0.2, 0, 0};
  const auto lagrangian = discrete_lagrangian(rectangle, PhiFour{0.5});
  CHECK(std::abs(*family->lagrangian(cell, y) - lagrangian(y, cell)) < 1e-15);
  std::array<double, 4> r;
  const auto gradient = lagrangian.gradient(y, cell);
  family->residual(cell, y, r);
  CHECK(distance(Row(r.begin(), r.end()), Row(gradient.begin(), gradient.end())) < 1e-15);
}

TEST_CASE("an evolution may be moved while its stepper is in use") {
  auto first = Scheme{rectangle, SineGordon{}}.on(Lattice::circle(32, 8), 0.1);
  Random random(91);
  first.stepper().start(random_rows(random, 2, 32, 1));
  Evolution second = std::move(first);
  second.stepper().step();
  CHECK(equation_defect(second, window_of(second)) < 2e-15);
}

namespace {

struct NoField {  // 0·φ
  auto operator()(const auto& j) const { return 0.0 * j.phi; }
};
struct NullLagrangian {  // φφ_t = ½∂_t φ²
  auto operator()(const auto& j) const { return j.phi * j.phi_t; }
};
struct NoKinetic {
  auto operator()(const auto& j) const { return -0.5 * (j.phi_x * j.phi_x + j.phi * j.phi); }
};
/// Two uncoupled fields, of which the second stands still.
struct OneOfTwo {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    return 0.5 * j.phi_t[0] * j.phi_t[0] - 0.5 * (j.phi[0] * j.phi[0] + j.phi[1] * j.phi[1]);
  }
};
/// The same, coupled; and a density of first order in time, as that of Schrödinger's equation.
struct Coupled {
  static constexpr int components = 2;
  auto operator()(const auto& j) const { return 0.5 * j.phi_t[0] * j.phi_t[0] - j.phi[0] * j.phi[0] * j.phi[1]; }
};
struct FirstOrder {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    return j.phi[0] * j.phi_t[1] - 0.5 * (j.phi_x[0] * j.phi_x[0] + j.phi_x[1] * j.phi_x[1]);
  }
};

template <class D>
std::string refusal(const D& density) {
  return message_of([&] { Scheme{rectangle, density}.on(Lattice::circle(31, 10), 0.1); });
}

}  // namespace

TEST_CASE("a density that determines no field is refused, and not for its number of sites") {
  for (const std::string& message : {refusal(NoField{}), refusal(NullLagrangian{})}) {
    CAPTURE(message);
    CHECK(contains(message, "determines no field"));
    CHECK_FALSE(contains(message, "sites;"));
    CHECK_FALSE(contains(message, "raise"));
  }
}

TEST_CASE("a density without a kinetic term determines no next row, and the field is named") {
  CHECK(contains(refusal(NoKinetic{}),
                 "no kinetic term for phi: no row determines the next; add one, such as 0.5 phi_t^2"));
  CHECK(contains(refusal(OneOfTwo{}), "no kinetic term for phi2"));
  CHECK(refused_key([&] { Scheme{rectangle, NoKinetic{}}.on(Lattice::circle(31, 10), 0.1); }) == "theory.name");
  // none is asked of a field that is coupled to one that has it, nor of what is of first order in time
  CHECK_FALSE(contains(refusal(Coupled{}), "kinetic"));
  CHECK(refusal(FirstOrder{}).empty());
}
