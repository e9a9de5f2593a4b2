// SPDX-License-Identifier: MIT
#include "jets/discrete_lagrangian.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::for_each_map;
using delf::testing::for_each_theory;
using delf::testing::Random;

namespace {

const Cell cell{0.1, 0.25, 0.4, 0.6};
constexpr double h = 0.1, k = 0.25;

/// The largest differences of the gradient to central differences (of fourth order) of L, and of the Hessian to those
/// of the gradient, relative to the largest entry.
struct Defects {
  double gradient = 0, hessian = 0, asymmetry = 0;
};
template <class L>
Defects against_differences(const L& lagrangian, double range) {
  Random random(9);
  Defects worst;
  constexpr double e = 1e-3;
  for (int n = 0; n < 5; ++n) {
    auto y = random.array<at(L::size)>(-range, range);
    const auto gradient = lagrangian.gradient(y, cell);
    const auto hessian = lagrangian.hessian(y, cell);
    double g = 0, H = 0;
    for (double x : gradient) g = std::max(g, std::abs(x));
    for (double x : hessian) H = std::max(H, std::abs(x));
    for (std::size_t i = 0; i < y.size(); ++i) {
      const auto shifted = [&](double s) {
        auto z = y;
        z[i] += s;
        return z;
      };
      const auto slope = [&](auto&& f) { return (8 * (f(e) - f(-e)) - (f(2 * e) - f(-2 * e))) / (12 * e); };
      const double by_value = slope([&](double s) { return lagrangian(shifted(s), cell); });
      worst.gradient = std::max(worst.gradient, std::abs(gradient[i] - by_value) / g);
      for (std::size_t j = 0; j < y.size(); ++j) {
        const double by_gradient = slope([&](double s) { return lagrangian.gradient(shifted(s), cell)[j]; });
        worst.hessian = std::max(worst.hessian, std::abs(hessian[j * y.size() + i] - by_gradient) / H);
        worst.asymmetry =
            std::max(worst.asymmetry, std::abs(hessian[j * y.size() + i] - hessian[i * y.size() + j]) / H);
      }
    }
  }
  return worst;
}

/// max |L − printed| over random values; L as in the paper is divided by the area hk.
template <class Map, class D, class Printed>
double against_print(Map map, const D& density, Printed printed) {
  const auto lagrangian = discrete_lagrangian(map, density);
  Random random(10);
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    const auto y = random.array<at(lagrangian.size)>(-3, 3);
    worst = std::max(worst, std::abs(lagrangian(y, cell) - h * k * printed(y)));
  }
  return worst;
}

double squared(double x) { return x * x; }
double N(double y) { return 1.44 * (std::cos(y) - 1); }  // sine-Gordon, m = 1.2

/// −√(1 − φ_t² + φ_x²): nonlinear in the derivatives.
struct BornInfeld {
  auto operator()(const auto& j) const { return -sqrt(1.0 - j.phi_t * j.phi_t + j.phi_x * j.phi_x); }
};
struct TwoComponents {
  static constexpr int components = 2;
  static constexpr bool placed = true;
  auto operator()(const auto& j) const {
    return 0.5 * j.phi_t[0] * j.phi_t[0] + j.phi_t[1] * j.phi_t[0] - exp(0.1 * j.phi_x[1]) * (2.0 + sin(j.x)) +
           cos(j.phi[0] - j.phi[1] + j.t);
  }
};

/// ℓ = t + 10x
struct Where {
  static constexpr bool placed = true;
  auto operator()(const auto& j) const { return j.t + 10.0 * j.x + 0.0 * j.phi; }
};

}  // namespace

TEST_CASE("gradient and Hessian agree with finite differences, for every theory on every stencil") {
  for_each_theory([](const auto& theory) {
    for_each_map([&](auto map) {
      const Defects worst = against_differences(discrete_lagrangian(map, theory), 2);
      CHECK(worst.gradient < 1e-9);
      CHECK(worst.hessian < 1e-9);
      CHECK(worst.asymmetry < 1e-15);
    });
  });
}

TEST_CASE("gradient and Hessian agree with finite differences where derivatives and components couple") {
  const Defects square_root = against_differences(discrete_lagrangian(rectangle, BornInfeld{}), 0.02);
  CHECK(square_root.gradient < 1e-6);
  CHECK(square_root.hessian < 1e-6);
  const Defects two = against_differences(discrete_lagrangian(rectangle, TwoComponents{}), 1);
  CHECK(two.gradient < 1e-8);
  CHECK(two.hessian < 1e-8);
}

TEST_CASE("the triangle's L is that above (5.8), times hk") {
  const auto printed = [](const auto& y) {
    return squared((y[1] - y[0]) / h) / 2 - squared((y[2] - y[1]) / k) / 2 + N((y[0] + y[1] + y[2]) / 3);
  };
  CHECK(against_print(triangle, SineGordon{1.2}, printed) < 1e-13);
  CHECK(against_print(triangle_vertex, SineGordon{1.2}, printed) > 1e-4);
  CHECK(against_print(triangle_vertex, SineGordon{1.2}, [&](const auto& y) {
          return printed(y) - N((y[0] + y[1] + y[2]) / 3) + N(y[0]);  // footnote 3
        }) < 1e-13);
}

TEST_CASE("the rectangle's L is (5.9) with the kinetic term on both vertical edges, times hk") {
  const auto potential = [](const auto& y) {
    return -squared((y[3] - y[0]) / (2 * k) + (y[2] - y[1]) / (2 * k)) / 2 + N((y[0] + y[1] + y[2] + y[3]) / 4);
  };
  CHECK(against_print(rectangle, SineGordon{1.2}, [&](const auto& y) {
          return squared((y[1] - y[0]) / h) / 4 + squared((y[2] - y[3]) / h) / 4 + potential(y);
        }) < 1e-13);
  CHECK(against_print(rectangle_symmetric, SineGordon{1.2}, [&](const auto& y) {  // above (5.12)
          return squared((y[1] - y[0]) / (2 * h) + (y[2] - y[3]) / (2 * h)) / 2 + potential(y);
        }) < 1e-13);
}

TEST_CASE("the hexagon's L is the mean of ℓ over its four corners of a brick, times 2hk") {
  CHECK(against_print(hexagon, SineGordon{1.2}, [](const auto& y) {
          const double d[]{(y[3] - y[0]) / h, (y[4] - y[1]) / h, (y[5] - y[2]) / h};
          const double g[]{(y[1] - y[0] + y[4] - y[3]) / (2 * k), (y[2] - y[1] + y[5] - y[4]) / (2 * k)};
          const double kinetic = (squared(d[0]) + 2 * squared(d[1]) + squared(d[2])) / 8;
          return 2 * (kinetic - (squared(g[0]) + squared(g[1])) / 4 + N((y[0] + y[1] + y[2] + y[3] + y[4] + y[5]) / 6));
        }) < 1e-12);
}

TEST_CASE("the comparison can fail: one sign of a Lagrangian wrong") {
  CHECK(against_print(rectangle_symmetric, SineGordon{1.2}, [](const auto& y) {
          return squared((y[1] - y[0]) / (2 * h) + (y[2] - y[3]) / (2 * h)) / 2 +
                 squared((y[3] - y[0]) / (2 * k) + (y[2] - y[1]) / (2 * k)) / 2 + N((y[0] + y[1] + y[2] + y[3]) / 4);
        }) > 0.1);
}

TEST_CASE("a negative time step makes the measure negative, and the velocities") {
  // L(−h; y read backwards in time) = −L(h; y)
  const auto lagrangian = discrete_lagrangian(rectangle, SineGordon{1.2});
  Cell back = cell;
  back.time_step = -cell.time_step;
  const std::array<double, 4> y{0.1, 0.4, -0.3, 0.9}, reversed{y[1], y[0], y[3], y[2]};
  CHECK(std::abs(lagrangian(reversed, back) + lagrangian(y, cell)) < 1e-15);
}

TEST_CASE("a placed density is asked at the quadrature points") {
  // the points of the hexagon: all at the middle of the brick, (½h, k) from its anchor
  const auto hexagons = discrete_lagrangian(hexagon, Where{});
  CHECK(std::abs(hexagons(std::array<double, 6>{}, cell) - 2 * h * k * (cell.t + h / 2 + 10 * (cell.x + k))) < 1e-15);
  const auto triangles = discrete_lagrangian(triangle, Where{});
  CHECK(std::abs(triangles(std::array<double, 3>{}, cell) - h * k * (cell.t + 2 * h / 3 + 10 * (cell.x + k / 3))) <
        1e-15);
}
