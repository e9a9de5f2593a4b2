// SPDX-License-Identifier: MIT
#include "jets/numbers/sinc.hpp"

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

/// Σ (−1)ⁿ x²ⁿ/(2n+1)! in 64-bit mantissas for small x, the quotients themselves beyond.
long double exact(long double x) {
  if (std::abs(x) > 1) return std::sin(x) / x;
  long double term = 1, sum = 1;
  for (int n = 1; n < 20; ++n) sum += term *= -x * x / (2 * n * (2 * n + 1));
  return sum;
}
long double exact_slope(long double x) {
  if (std::abs(x) > 1) return (std::cos(x) - std::sin(x) / x) / x;
  long double term = -x / 3, sum = term;  // 2n x²ⁿ⁻¹ (−1)ⁿ/(2n+1)!
  for (int n = 2; n < 20; ++n) sum += term *= -x * x / ((2 * n - 2) * (2 * n + 1));
  return sum;
}

}  // namespace

TEST_CASE("sinc and its slope are within round-off from 0 through the switch of series to 50") {
  Random random(6);
  double worst = 0, worst_slope = 0, worst_pack = 0;
  for (int n = 0; n < 20000; ++n) {
    const double x = random(0, 1) < 0.5 ? random(-0.6, 0.6) : random(-50, 50);
    worst = std::max(worst, static_cast<double>(std::abs(sinc(x) - exact(x))));
    worst_slope = std::max(worst_slope, static_cast<double>(std::abs(sinc_slope(x) - exact_slope(x))));
    worst_pack = std::max(
        {worst_pack, std::abs(sinc(Pack(x))[0] - sinc(x)), std::abs(sinc_slope(Pack(x))[lanes - 1] - sinc_slope(x))});
  }
  CHECK(worst < 3e-16);
  CHECK(worst_slope < 2e-15);
  CHECK(worst_pack < 3e-15);
}

TEST_CASE("series and quotient meet at the switch") {
  const double at = detail::sinc_series_below, below = std::nextafter(at, 0);
  for (const double sign : {1.0, -1.0}) {
    CHECK(std::abs(sinc(sign * at) - sinc(sign * below)) < 3e-16);
    CHECK(std::abs(sinc_slope(sign * at) - sinc_slope(sign * below)) < 2e-15);
  }
  CHECK(std::abs(detail::sinc_series(2.0) - static_cast<double>(exact(std::sqrt(2.0)))) > 1e-12);  // too far for it
}

TEST_CASE("at 0 sinc is 1 and its slope 0, for numbers, packs and duals") {
  CHECK(sinc(0.0) == 1);
  CHECK(sinc_slope(0.0) == 0);
  Pack mixed(2.0);
  mixed.v[lanes - 1] = 0;
  CHECK(sinc(mixed)[lanes - 1] == 1);
  CHECK(sinc_slope(mixed)[lanes - 1] == 0);
  CHECK(std::abs(sinc(mixed)[0] - std::sin(2.0) / 2) < 1e-15);
  const auto at_zero = sinc(Dual<double, 1>::variable(0, 0));
  CHECK((at_zero.value == 1 && at_zero.derivative(0) == 0));
}

TEST_CASE("the quotient itself loses half its digits near 0: what the series is for") {
  double worst = 0;
  for (double x = 1e-7; x < 1e-4; x *= 1.1)
    worst = std::max(worst, static_cast<double>(std::abs((std::cos(x) - std::sin(x) / x) / x - exact_slope(x))));
  CHECK(worst > 1e-11);
}
