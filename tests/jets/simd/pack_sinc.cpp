// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "jets/numbers/sinc.hpp"
#include "tests/catch.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

// d²ᵏ of the power series Σ (−1)ⁿ x²ⁿ/(2n+1)! in 64-bit mantissas for small x, the quotients themselves beyond.
long double exact(long double x, int derivative) {
  if (std::abs(x) > 2) {
    const long double f = std::sin(x) / x, slope = (std::cos(x) - f) / x;
    return derivative == 0 ? f : derivative == 1 ? slope : -f - 2 * slope / x;
  }
  long double sum = 0, factorial = 1;
  for (int n = 0; n < 20; ++n) {
    long double term = (n % 2 == 0 ? 1 : -1) / factorial;
    for (int k = 0; k < 2 * n - derivative; ++k) term *= x;
    for (int k = 0; k < derivative; ++k) term *= 2 * n - k;
    sum += term;
    factorial *= (2 * n + 2) * (2 * n + 3);
  }
  return sum;
}

/// The largest error of sinc and its first two derivatives at points −bound … bound.
double worst_error(double bound) {
  Random random(7);
  long double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    Pack x;
    for (int l = 0; l < lanes; ++l) x.v[l] = random(-bound, bound);
    const Pack y[] = {sinc(x), sinc_slope(x), sinc_curvature(x)};
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < lanes; ++l) {
        const long double error = std::abs(y[k][l] - exact(x[l], k));
        if (!(error <= worst)) worst = error;
      }
  }
  return static_cast<double>(worst);
}

}  // namespace

TEST_CASE("sinc of packs and its two derivatives are within 2.5e-16") {
  for (const double bound : {1e-3, 0.3, detail::sinc_polynomial_below, 2.0, 3.2, 50.0}) {
    CAPTURE(bound);
    CHECK(worst_error(bound) < 2.5e-16);
  }
}

TEST_CASE("beyond its interval the polynomial of sinc is no good") {
  CHECK(std::abs((detail::sine_cubic_part(Pack(9.0)) * 9.0 + 1.0)[0] - static_cast<double>(exact(3, 0))) > 1e-14);
}

TEST_CASE("a lane of sinc is the same to the last bit whatever is in the others, and NaN in its own lane only") {
  Random random(8);
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double other : {0.0, 1.0, -2.0, 1e7, inf, nan})
    for (int n = 0; n < 200; ++n) {
      const int l = n % lanes;
      const double x = random(-4, 4);
      Pack mixed(other);
      mixed.v[l] = x;
      CHECK(sinc(mixed)[l] == sinc(Pack(x))[l]);
      CHECK(sinc_slope(mixed)[l] == sinc_slope(Pack(x))[l]);
      CHECK(sinc_curvature(mixed)[l] == sinc_curvature(Pack(x))[l]);
      CHECK(sinc(Pack(-x))[l] == sinc(Pack(x))[l]);
      CHECK(sinc_slope(Pack(-x))[l] == -sinc_slope(Pack(x))[l]);
      if (lanes > 1) CHECK(std::isnan(sinc(mixed)[(l + 1) % lanes]) == !(std::abs(other) < inf));
    }
}
