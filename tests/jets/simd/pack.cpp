// SPDX-License-Identifier: MIT
#include "jets/simd/pack.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/catch.hpp"

using namespace delf;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// x, x + step, x + 2 step, … in the lanes.
Pack ramp(double x, double step) {
  alignas(64) double values[lanes];
  for (int l = 0; l < lanes; ++l) values[l] = x + l * step;
  return Pack::load(values);
}
Pack with(Pack p, int lane, double x) {
  p.v[lane] = x;
  return p;
}

}  // namespace

static_assert(sizeof(Pack) == lanes * sizeof(double));

TEST_CASE("a pack is loaded and stored lane by lane") {
  alignas(64) double from[3 * lanes], to[3 * lanes] = {};
  for (int i = 0; i < 3 * lanes; ++i) from[i] = 0.1 * i - 1;
  Pack::load(from + lanes).store(to + 2 * lanes);
  for (int l = 0; l < lanes; ++l) {
    CHECK(Pack::load(from)[l] == from[l]);
    CHECK(to[2 * lanes + l] == from[lanes + l]);
    CHECK(to[lanes + l] == 0);
    CHECK(Pack(2.5)[l] == 2.5);
    CHECK(std::signbit(Pack(-0.0)[l]));
  }
}

TEST_CASE("arithmetic on packs is that of numbers") {
  const Pack a = ramp(-1.3, 0.7), b = ramp(2.1, 0.3);
  Pack added = a, taken = a, times = a;
  added += b, taken -= b, times *= b;
  double total = 0;
  for (int l = 0; l < lanes; ++l) {
    CHECK((a + b)[l] == a[l] + b[l]);
    CHECK((a - b)[l] == a[l] - b[l]);
    CHECK((a * b)[l] == a[l] * b[l]);
    CHECK((a / b)[l] == a[l] / b[l]);
    CHECK((-a)[l] == -a[l]);
    CHECK((2.0 * a - 1.0)[l] == 2.0 * a[l] - 1.0);
    CHECK((added[l] == a[l] + b[l] && taken[l] == a[l] - b[l] && times[l] == a[l] * b[l]));
    CHECK(abs(a)[l] == std::abs(a[l]));
    total += a[l];
  }
  CHECK(std::abs(sum(a) - total) < 1e-15);
}

TEST_CASE("max_or_nan is the larger, and a NaN in any lane of either stays one") {
  const Pack a = ramp(-1, 0.5), b = ramp(1, -0.5);
  for (int l = 0; l < lanes; ++l) CHECK(max_or_nan(a, b)[l] == std::max(a[l], b[l]));
  CHECK(max_or_nan(a) == a[lanes - 1]);
  CHECK(max_or_nan(b) == b[0]);
  for (int l = 0; l < lanes; ++l) {
    for (const Pack& m : {max_or_nan(with(a, l, not_a_number), b), max_or_nan(a, with(b, l, not_a_number))})
      for (int other = 0; other < lanes; ++other) CHECK(std::isnan(m[other]) == (other == l));
    CHECK(std::isnan(max_or_nan(with(a, l, not_a_number))));
    CHECK(std::isnan(abs(with(a, l, not_a_number))[l]));
  }
}

TEST_CASE("the largest magnitude has no sign, and a NaN in either stays one") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (int l = 0; l < lanes; ++l) {
    for (double b : {-3.0, 3.0, -0.5, 0.5, -0.0, 0.0, -infinity, infinity, -1e-310, 2.0, -2.0}) {
      CHECK(largest_magnitude(Pack(2.0), with(Pack(0.25), l, b))[l] == std::max(2.0, std::abs(b)));
      CHECK_FALSE(std::signbit(largest_magnitude(Pack(0.0), with(Pack(0.25), l, b))[l]));
    }
    for (double sign : {1.0, -1.0}) {
      const Pack nan = with(Pack(7.0), l, std::copysign(not_a_number, sign));
      for (const Pack& m : {largest_magnitude(Pack(2.0), nan), largest_magnitude(abs(nan), Pack(9.0)),
                            largest_magnitude(Pack(infinity), nan)})
        for (int other = 0; other < lanes; ++other) CHECK(std::isnan(m[other]) == (other == l));
    }
  }
}

TEST_CASE("the maximum over lanes is found wherever it is") {
  for (int l = 0; l < lanes; ++l) {
    CHECK(max_or_nan(with(ramp(-1, -0.5), l, 3)) == 3);
    CHECK(max_or_nan(with(Pack(-7.0), l, -6)) == -6);
    CHECK(max_or_nan(with(Pack(-std::numeric_limits<double>::infinity()), l, -1e300)) == -1e300);
    for (int other = 0; other < lanes; ++other)
      CHECK(std::isnan(
          max_or_nan(with(with(Pack(1.0), l, std::numeric_limits<double>::infinity()), other, not_a_number))));
  }
}

TEST_CASE("abs clears the sign, that of -0 too") {
  CHECK_FALSE(std::signbit(abs(Pack(-0.0))[lanes - 1]));
  CHECK(abs(Pack(-std::numeric_limits<double>::infinity()))[0] == std::numeric_limits<double>::infinity());
}

TEST_CASE("a running maximum over a row shows a NaN wherever it was, and a plain maximum loses it") {
  const Pack bad = with(Pack(0.5), lanes / 2, not_a_number);
  Pack careful(0.0), plain(0.0);
  for (const Pack& p : {Pack(1.0), bad, Pack(2.0)}) {
    careful = max_or_nan(abs(p), careful);
    plain = Pack{p.v > plain.v ? p.v : plain.v};
  }
  CHECK(std::isnan(max_or_nan(careful)));
  CHECK(max_or_nan(plain) == 2);
}
