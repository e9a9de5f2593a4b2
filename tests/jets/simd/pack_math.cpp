// SPDX-License-Identifier: MIT
#include "jets/simd/pack_math.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "jets/numbers/dual.hpp"
#include "lattice/index.hpp"
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
      const long double x = points[i + at(l)];
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

/// Multiples of π/4 up to |x| = 3e6, each with its neighbours: where the reduced argument is 0, or changes its n.
std::vector<double> near_multiples() {
  std::vector<double> points;
  for (int m = -3819718; m <= 3819718; m += m > -4000 && m < 4000 ? 1 : 97) {
    double x = m * (pi / 4);
    for (int i = 0; i < 3; ++i, x = std::nextafter(x, 4e6))
      if (std::abs(x) <= 3e6) points.push_back(x);
  }
  return points;
}

/// The largest |f(x) − g(x)|/|g(x)| over the points, g in 64-bit mantissas.
template <class Function, class Exact>
double worst_relative_error(std::vector<double> points, Function f, Exact g) {
  while (points.size() % lanes != 0) points.push_back(points.back());
  long double worst = 0;
  for (std::size_t i = 0; i < points.size(); i += lanes) {
    const Pack y = f(pack_of(&points[i]));
    for (int l = 0; l < lanes; ++l) {
      const long double exact = g(static_cast<long double>(points[i + at(l)]));
      const long double error = exact == 0 ? std::abs(y[l]) : std::abs(y[l] - exact) / std::abs(exact);
      if (!(error <= worst)) worst = error;
    }
  }
  return static_cast<double>(worst);
}

const auto pack_exp = [](Pack x) { return exp(x); };
const auto pack_sinh = [](Pack x) { return sinh(x); };
const auto pack_cosh = [](Pack x) { return cosh(x); };
const auto pack_tanh = [](Pack x) { return tanh(x); };
const auto exact_exp = [](long double x) { return std::exp(x); };
const auto exact_sinh = [](long double x) { return std::sinh(x); };
const auto exact_cosh = [](long double x) { return std::cosh(x); };
const auto exact_tanh = [](long double x) { return std::tanh(x); };

}  // namespace

TEST_CASE("sine and cosine of packs are within 2.5e-16 up to 3e6") {
  CHECK(worst_error(random_points(80000, 1.6)) < 2.5e-16);
  CHECK(worst_error(random_points(80000, 20)) < 2.5e-16);
  std::vector<double> dense;
  for (int i = 0; i <= 40000; ++i) dense.push_back(i * (2 / 40000.));
  CHECK(worst_error(dense) < 2.5e-16);
  CHECK(worst_error(random_points(80000, 3e6)) < 2.5e-16);
  CHECK(worst_error(near_multiples()) < 2.5e-16);
  CHECK(worst_error({3e6, -3e6, std::nextafter(3e6, 0), std::nextafter(-3e6, 0)}) < 2.5e-16);
}

TEST_CASE("the bound can fail: a reduction by one rounded π is off by more than 1e-12 at 1e6") {
  double worst = 0;
  for (const double x : random_points(1000, 1e6)) {
    const double n = std::nearbyint(x / pi);
    worst = std::max(worst, std::abs(std::sin(x) - (std::fmod(n, 2) == 0 ? 1 : -1) * std::sin(x - n * pi)));
  }
  CHECK(worst > 1e-12);
}

TEST_CASE("beyond 3e6 a lane is as good, and does not spoil the others") {
  std::vector<double> points;
  for (const double large : {3.0000001e6, -3e7, 1e15, -1e22, 1e300})
    for (int l = 0; l < lanes; ++l)
      for (int other = 0; other < lanes; ++other) points.push_back(other == l ? large : 0.3 * other - 1);
  CHECK(worst_error(points) < 2.5e-16);
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
        if (other != l) CHECK(std::abs(s[other] - std::sin(0.7)) < 2.5e-16);
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

TEST_CASE("sine is odd and cosine even, to the last bit") {
  std::vector<double> points = random_points(8000, 3e6);
  for (const double x : near_multiples()) points.push_back(x);
  bool odd = true, even = true;
  for (const double x : points) {
    const Pack p(x), m(-x);
    odd = odd && sin(m)[0] == -sin(p)[0];
    even = even && cos(m)[0] == cos(p)[0];
  }
  CHECK(odd);
  CHECK(even);
  CHECK(sin(Pack(-0.0))[0] == 0);
}

TEST_CASE("a lane is the same to the last bit whatever is in the others") {
  Random random(23);
  for (const double other : {0.0, -3.0, 700.5, 3.1e6, 1e15, -1e300, inf, not_a_number})
    for (int n = 0; n < 200; ++n) {
      const double x = n % 2 == 0 ? random(-5, 5) : random(-690, 690);
      Pack mixed(other);
      mixed.v[n % lanes] = x;
      const int l = n % lanes;
      CHECK(sin(mixed)[l] == sin(Pack(x))[l]);
      CHECK(cos(mixed)[l] == cos(Pack(x))[l]);
      CHECK(exp(mixed)[l] == exp(Pack(x))[l]);
      CHECK(sinh(mixed)[l] == sinh(Pack(x))[l]);
      CHECK(cosh(mixed)[l] == cosh(Pack(x))[l]);
      CHECK(tanh(mixed)[l] == tanh(Pack(x))[l]);
    }
}

TEST_CASE("exp of packs is within 2e-16, relative, wherever it is not denormal") {
  for (const double bound : {1e-9, 0.4, 30.0, 708.0}) {
    CHECK(worst_relative_error(random_points(40000, bound), pack_exp, exact_exp) < 2e-16);
  }
  std::vector<double> at_switches;  // odd multiples of ½ log 2 with their neighbours: where n changes
  for (int m = -2041; m <= 2047; m += 2) {
    double x = std::nextafter(m * (std::numbers::ln2 / 2), -1e3);
    for (int i = 0; i < 3; ++i, x = std::nextafter(x, 1e3)) at_switches.push_back(x);
  }
  CHECK(worst_relative_error(at_switches, pack_exp, exact_exp) < 2e-16);
  CHECK(exp(Pack(0.0))[0] == 1);
  CHECK(exp(Pack(-0.0))[0] == 1);
}

TEST_CASE("exp of packs overflows to infinity and underflows through the denormals to 0, as the library's") {
  const double highest = 0x1.62e42fefa39efp+9;  // the largest double whose exponential is finite
  CHECK(std::isfinite(exp(Pack(highest))[0]));
  for (const double x : {std::nextafter(highest, 1e3), 709.9, 710.0, 711.0, 1e4, 1e300, inf})
    CHECK(exp(Pack(x))[lanes - 1] == inf);
  for (const double x : {-745.14, -746.0, -750.0, -1e4, -1e300, -inf}) CHECK(exp(Pack(x))[lanes - 1] == 0);
  for (double x = -708.2; x > -745.1; x -= 0.37) CHECK(std::abs(exp(Pack(x))[0] - std::exp(x)) <= 0x1p-1074);
  for (int l = 0; l < lanes; ++l) {
    Pack x(0.7);
    x.v[l] = not_a_number;
    for (int other = 0; other < lanes; ++other) CHECK(std::isnan(exp(x)[other]) == (other == l));
  }
}

TEST_CASE("hyperbolic functions of packs are within 4e-16, relative, near 0 and everywhere") {
  for (const double bound : {1e-300, 1e-9, 0.01, 0.4, 1.0, 3.0, 30.0, 710.0}) {
    CAPTURE(bound);
    CHECK(worst_relative_error(random_points(40000, bound), pack_sinh, exact_sinh) < 4e-16);
    CHECK(worst_relative_error(random_points(40000, bound), pack_cosh, exact_cosh) < 4e-16);
    CHECK(worst_relative_error(random_points(40000, bound), pack_tanh, exact_tanh) < 4e-16);
  }
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double x = random(0, 30);
    CHECK(sinh(Pack(-x))[0] == -sinh(Pack(x))[0]);
    CHECK(cosh(Pack(-x))[0] == cosh(Pack(x))[0]);
    CHECK(tanh(Pack(-x))[0] == -tanh(Pack(x))[0]);
    CHECK(tanh(Pack(x))[0] <= 1);
  }
}

TEST_CASE("hyperbolic functions of packs at 0, far out, and of NaN") {
  CHECK(sinh(Pack(0.0))[0] == 0);
  CHECK(cosh(Pack(0.0))[0] == 1);
  CHECK(tanh(Pack(0.0))[0] == 0);
  CHECK(std::signbit(sinh(Pack(-0.0))[0]));
  CHECK(std::signbit(tanh(Pack(-0.0))[0]));
  for (const double x : {20.0, 25.0, 1e3, 1e300, inf}) {
    CHECK(tanh(Pack(x))[lanes - 1] == 1);
    CHECK(tanh(Pack(-x))[lanes - 1] == -1);
  }
  for (const double x : {711.0, 1e300, inf}) {
    CHECK(sinh(Pack(x))[0] == inf);
    CHECK(sinh(Pack(-x))[0] == -inf);
    CHECK(cosh(Pack(-x))[0] == inf);
  }
  for (int l = 0; l < lanes; ++l) {
    Pack x(0.7);
    x.v[l] = not_a_number;
    for (int other = 0; other < lanes; ++other) {
      CHECK(std::isnan(sinh(x)[other]) == (other == l));
      CHECK(std::isnan(cosh(x)[other]) == (other == l));
      CHECK(std::isnan(tanh(x)[other]) == (other == l));
    }
  }
}

TEST_CASE("the other functions of packs are the library's, lane by lane") {
  Random random(11);
  Pack x;
  for (int l = 0; l < lanes; ++l) x.v[l] = random(0.1, 3);
  for (int l = 0; l < lanes; ++l) {
    CHECK(log(x)[l] == std::log(x[l]));
    CHECK(sqrt(x)[l] == std::sqrt(x[l]));
    CHECK(tan(x)[l] == std::tan(x[l]));
    CHECK(pow(x, 2.3)[l] == std::pow(x[l], 2.3));
  }
  CHECK(std::isnan(sqrt(Pack(-1.0))[lanes - 1]));
}

TEST_CASE("cos x - 1 is as good as its size where x is small, and cos x - 1 itself is not") {
  for (const double x : {1e-150, 1e-9, 1e-4, 0.3, 3.0, 1e5}) {
    const long double half = std::sin(0.5L * x), exact = -2 * half * half;
    const double scalar = cosm1(x), packed = cosm1(Pack(x))[0];
    CAPTURE(x);
    CHECK(std::abs(scalar - exact) <= 4e-16L * std::abs(exact));
    CHECK(std::abs(packed - exact) <= 1e-15L * std::abs(exact) + 1e-15L * std::abs(half));
  }
  CHECK(std::cos(1e-9) - 1 == 0);
  Random random(31);
  long double worst = 0, without_its_sign = 0;
  for (int n = 0; n < 20000; ++n) {
    const double x = random(-20, 20);
    const long double half = std::sin(0.5L * x), exact = -2 * half * half;
    worst = std::max(worst, std::abs(cosm1(Pack(x))[n % lanes] - exact));
    // What leaves out where n is odd: cos r - 1 of the reduced argument.
    without_its_sign =
        std::max(without_its_sign, std::abs(std::abs(std::cos(static_cast<long double>(x))) - 1 - exact));
  }
  CHECK(worst < 6e-16L);
  CHECK(without_its_sign > 1.9L);
  const auto d = cosm1(Dual<Dual<double, 1>, 1>::variable(Dual<double, 1>::variable(0.7, 0), 0));
  CHECK(std::abs(d.d[0].value + std::sin(0.7)) < 1e-15);
  CHECK(std::abs(d.d[0].d[0] + std::cos(0.7)) < 1e-15);
}
