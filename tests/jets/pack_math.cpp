// SPDX-License-Identifier: MIT
#include "jets/pack_math.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/catch.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

Pack pack_of(const double* x) {
  Pack p;
  for (int l = 0; l < lanes; ++l) p.v[l] = x[l];
  return p;
}

/// The largest |sin x − value| and |cos x − value| over the points, against 64-bit mantissas.
double worst_error(std::vector<double> points) {
  while (points.size() % lanes != 0) points.push_back(points.back());
  long double worst = 0;
  for (std::size_t i = 0; i < points.size(); i += lanes) {
    const Pack s = sin(pack_of(&points[i])), c = cos(pack_of(&points[i]));
    for (int l = 0; l < lanes; ++l) {
      const long double x = points[i + static_cast<std::size_t>(l)];
      const long double error = std::max(std::abs(std::sin(x) - s[l]), std::abs(std::cos(x) - c[l]));
      if (!(error <= worst)) worst = error;  // a NaN too
    }
  }
  return static_cast<double>(worst);
}

std::vector<double> random_points(int count, double bound) {
  Random random(5);
  std::vector<double> points;
  for (int i = 0; i < count; ++i) points.push_back(random(-bound, bound));
  return points;
}

/// Multiples of π/4 up to |x| = 1e6, each with its neighbours: where the reduced argument is 0, or changes its n.
std::vector<double> near_multiples() {
  std::vector<double> points;
  for (int m = -1273239; m <= 1273239; m += m > -4000 && m < 4000 ? 1 : 97) {
    double x = m * (pi / 4);
    for (int i = 0; i < 3; ++i, x = std::nextafter(x, 2e6))
      if (std::abs(x) <= 1e6) points.push_back(x);
  }
  return points;
}

}  // namespace

TEST_CASE("sine and cosine of packs are within 3e-16 up to 1e6") {
  CHECK(worst_error(random_points(80000, 20)) < 3e-16);
  CHECK(worst_error(random_points(80000, 1e6)) < 3e-16);
  CHECK(worst_error(near_multiples()) < 3e-16);
  CHECK(worst_error({1e6, -1e6, std::nextafter(1e6, 0), std::nextafter(-1e6, 0)}) < 3e-16);
}

TEST_CASE("the bound can fail: a reduction by one rounded π is off by more than 1e-12 at 1e6") {
  double worst = 0;
  for (const double x : random_points(1000, 1e6)) {
    const double n = std::nearbyint(x / pi);
    worst = std::max(worst, std::abs(std::sin(x) - (std::fmod(n, 2) == 0 ? 1 : -1) * std::sin(x - n * pi)));
  }
  CHECK(worst > 1e-12);
}

TEST_CASE("beyond 1e6 a lane is as good, and does not spoil the others") {
  std::vector<double> points;
  for (const double large : {1.0000001e6, -3e7, 1e15, -1e22, 1e300})
    for (int l = 0; l < lanes; ++l)
      for (int other = 0; other < lanes; ++other) points.push_back(other == l ? large : 0.3 * other - 1);
  CHECK(worst_error(points) < 3e-16);
}

TEST_CASE("sine and cosine of NaN and infinity are NaN, in their own lane only") {
  for (const double bad : {not_a_number, inf, -inf})
    for (int l = 0; l < lanes; ++l) {
      Pack x(0.7);
      x.v[l] = bad;
      const Pack s = sin(x), c = cos(x);
      for (int other = 0; other < lanes; ++other) {
        CHECK(std::isnan(s[other]) == (other == l));
        CHECK(std::isnan(c[other]) == (other == l));
        if (other != l) CHECK(std::abs(s[other] - std::sin(0.7)) < 3e-16);
      }
    }
}

TEST_CASE("sin 0 = 0, cos 0 = 1, and sin x = x for small x to all digits") {
  CHECK(sin(Pack(0.0))[0] == 0);
  CHECK(cos(Pack(0.0))[0] == 1);
  for (double x = 1e-8; x > 1e-300; x /= 7) {
    CHECK(sin(Pack(x))[lanes - 1] == x);
    CHECK(sin(Pack(-x))[0] == -x);
  }
}

TEST_CASE("the other functions of packs are the library's, lane by lane") {
  Random random(11);
  Pack x;
  for (int l = 0; l < lanes; ++l) x.v[l] = random(0.1, 3);
  for (int l = 0; l < lanes; ++l) {
    CHECK(exp(x)[l] == std::exp(x[l]));
    CHECK(log(x)[l] == std::log(x[l]));
    CHECK(sqrt(x)[l] == std::sqrt(x[l]));
    CHECK(tan(x)[l] == std::tan(x[l]));
    CHECK(sinh(x)[l] == std::sinh(x[l]));
    CHECK(cosh(x)[l] == std::cosh(x[l]));
    CHECK(tanh(x)[l] == std::tanh(x[l]));
    CHECK(pow(x, 2.3)[l] == std::pow(x[l], 2.3));
  }
}
