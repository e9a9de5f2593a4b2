// SPDX-License-Identifier: MIT
#include "jets/fibre.hpp"

#include <array>
#include <limits>

#include "tests/catch.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {
constexpr double pi = std::numbers::pi;
}

TEST_CASE("wrap is the representative in −π to π, whatever multiple of 2π is added") {
  Random random(2);
  for (int n = 0; n < 2000; ++n) {
    const double x = random(-pi, pi) * 0.999999, turns = random.pick(-50, 50);
    CHECK(std::abs(wrap(x) - x) < 1e-15);
    CHECK(std::abs(wrap(x + 2 * pi * turns) - x) < 1e-13);
    CHECK(std::abs(wrap(random(-1e3, 1e3))) <= pi);
  }
  CHECK(wrap(0) == 0);
  CHECK(std::abs(std::abs(wrap(pi)) - pi) < 1e-15);
  CHECK(std::isnan(wrap(std::numeric_limits<double>::infinity())));
}

TEST_CASE("lifting to the first vertex undoes a reduction modulo 2π of neighbouring values") {
  Random random(4);
  for (int n = 0; n < 2000; ++n) {
    std::array<double, 6> y, lifted;
    y[0] = random(-30, 30);
    for (std::size_t l = 1; l < 6; ++l) y[l] = y[0] + random(-0.89, 0.89) * pi;
    for (std::size_t l = 0; l < 6; ++l) lifted[l] = std::remainder(y[l], 2 * pi) + 2 * pi * random.pick(-3, 3);
    const double first = lifted[0];
    lift_to_first_vertex(lifted);
    CHECK(lifted[0] == first);
    for (std::size_t l = 1; l < 6; ++l) CHECK(std::abs((lifted[l] - lifted[0]) - (y[l] - y[0])) < 1e-13);
  }
}

TEST_CASE("what is not lifted differs from its neighbour by a turn: the reduction is seen") {
  std::array<double, 2> y{3.1, -3.1};  // neighbours across π
  CHECK(std::abs(y[1] - y[0]) > 6);
  lift_to_first_vertex(y);
  CHECK(std::abs(y[1] - y[0] - (2 * pi - 6.2)) < 1e-14);
}

TEST_CASE("a wrapped difference above 0.9π is refused, one below is not") {
  for (const double sign : {1.0, -1.0}) {
    std::array<double, 3> fine{1, 1 + sign * 0.899 * pi, 1}, wide{1, 1, 1 + sign * 0.901 * pi};
    CHECK_NOTHROW(lift_to_first_vertex(fine));
    CHECK_THROWS_AS(lift_to_first_vertex(wide), NotFinite);
    std::array<double, 2> other_way{1, 1 + sign * 1.101 * pi};  // 0.899π the other way round
    CHECK_NOTHROW(lift_to_first_vertex(other_way));
  }
  std::array<double, 2> nan{1, std::numeric_limits<double>::quiet_NaN()},
      inf{1, std::numeric_limits<double>::infinity()};
  CHECK_THROWS_AS(lift_to_first_vertex(nan), NotFinite);
  CHECK_THROWS_AS(lift_to_first_vertex(inf), NotFinite);
}
