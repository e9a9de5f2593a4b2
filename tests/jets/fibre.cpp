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
