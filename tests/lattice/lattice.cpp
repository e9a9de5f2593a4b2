// SPDX-License-Identifier: MIT
#include "lattice/lattice.hpp"

#include <limits>
#include <string>

#include "lattice/error.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

template <class Make>
std::string rejected_key(Make make) {
  try {
    make();
  } catch (const BadInput& error) {
    return error.key();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a circle of N sites has x_i = iL/N, an interval that holds both walls x_i = iL/(N − 1)") {
  const Lattice circle = Lattice::circle(256, 40), interval = Lattice::interval(101, 40);
  CHECK(circle.position(64) == 10);
  CHECK(circle.space_step() * 256 == 40);
  CHECK(interval.position(0) == 0);
  CHECK(interval.position(100) == 40);
  CHECK(interval.space_step() * 100 == Approx(40));
}

TEST_CASE("an index stands for the site that is a multiple of N away") {
  const Lattice circle = Lattice::circle(7, 1);
  for (int i = -30; i < 30; ++i) {
    CHECK(circle.wrapped(i) >= 0);
    CHECK(circle.wrapped(i) < 7);
    CHECK((circle.wrapped(i) - i) % 7 == 0);
  }
}

TEST_CASE("only fixed walls of an interval are fixed") {
  const Lattice lattice = Lattice::interval(5, 1, Wall::fixed, Wall::natural);
  CHECK(lattice.is_fixed(0));
  for (int i = 1; i < 5; ++i) CHECK_FALSE(lattice.is_fixed(i));
  for (int i = 0; i < 5; ++i) CHECK_FALSE(Lattice::circle(5, 1).is_fixed(i));
}

TEST_CASE("a lattice needs two sites and a positive, finite length") {
  CHECK(rejected_key([] { Lattice::circle(1, 1); }) == "lattice.sites");
  CHECK(rejected_key([] { Lattice::circle(9, 0); }) == "lattice.length");
  CHECK(rejected_key([] { Lattice::interval(9, -1); }) == "lattice.length");
  CHECK(rejected_key([] { Lattice::interval(9, std::numeric_limits<double>::infinity()); }) == "lattice.length");
  CHECK(rejected_key([] { Lattice::interval(9, std::numeric_limits<double>::quiet_NaN()); }) == "lattice.length");
  CHECK(rejected_key([] { Lattice::circle(2, 1); }) == "accepted");
}
