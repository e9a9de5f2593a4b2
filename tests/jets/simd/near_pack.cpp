// SPDX-License-Identifier: MIT
#include "jets/simd/near_pack.hpp"

#include "jets/simd/reduced_pack.hpp"

#include "tests/catch.hpp"
#include "tests/jets/simd/pack_bits.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Of random arguments within the bound: lanes in which f of `Near` is not that of Packs.
template <class Near, class Function>
int differences(Function f, double bound) {
  Random random(3);
  int count = 0;
  for (int n = 0; n < 4000; ++n) {
    const Pack x = random_pack(random, bound);
    count += different(f(Near(x)), f(x));
  }
  return count;
}

}  // namespace

TEMPLATE_TEST_CASE("in reach functions of NearPacks have the bits of those of Packs", "", NearPack, ReducedPack) {
  CHECK(differences<TestType>([](auto x) { return sin(x); }, 3e6) == 0);
  CHECK(differences<TestType>([](auto x) { return cos(x); }, 3e6) == 0);
  CHECK(differences<TestType>([](auto x) { return cosm1(x); }, 3e6) == 0);
  CHECK(differences<TestType>([](auto x) { return sinh(x); }, 700) == 0);
  CHECK(differences<TestType>([](auto x) { return cosh(x); }, 700) == 0);
}

TEMPLATE_TEST_CASE("beyond it they have not: nothing is asked", "", NearPack, ReducedPack) {
  CHECK(differences<TestType>([](auto x) { return sin(x); }, 1e18) > 1000);
  CHECK(differences<TestType>([](auto x) { return cos(x); }, 1e18) > 1000);
  CHECK(differences<TestType>([](auto x) { return cosm1(x); }, 1e18) > 1000);
  CHECK(differences<TestType>([](auto x) { return sinh(x); }, 1e4) > 1000);
  CHECK(differences<TestType>([](auto x) { return cosh(x); }, 1e4) > 1000);
}

TEMPLATE_TEST_CASE("functions that ask for other reasons, or nothing, are those of Packs anywhere", "", NearPack,
                   ReducedPack) {
  CHECK(differences<TestType>([](auto x) { return exp(x); }, 800) == 0);
  CHECK(differences<TestType>([](auto x) { return tanh(x); }, 50) == 0);
  CHECK(differences<TestType>([](auto x) { return tan(x); }, 1e9) == 0);
  CHECK(differences<TestType>([](auto x) { return sinc(x); }, 1e9) == 0);
  CHECK(differences<TestType>([](auto x) { return sinc_slope(x); }, 1e9) == 0);
  CHECK(differences<TestType>([](auto x) { return sqrt(x * x + 1.0); }, 1e9) == 0);
  CHECK(differences<TestType>([](auto x) { return log(x * x + 1.0); }, 1e9) == 0);
  CHECK(differences<TestType>([](auto x) { return pow(x * x + 1.0, 1.5) / (2.0 - -x); }, 1e3) == 0);
}

TEST_CASE("the sine of a ReducedPack is that of what it was made of, not of what it is now") {
  ReducedPack x = 1.0;
  x.r = 0.5, x.s = 0.25;
  CHECK(different(sin(x), sin(Pack(1.0))) == lanes);
  CHECK(different(sin(x + 0.0), sin(Pack(1.0))) == 0);
}

TEMPLATE_TEST_CASE("derivatives of functions of NearPacks have the bits of those of Packs", "", NearPack, ReducedPack) {
  const auto differences_of = [](auto f) {
    Random random(8);
    int count = 0;
    for (int n = 0; n < 500; ++n) {
      const Pack x = random_pack(random, 10);
      const auto near = f(Dual<TestType, 1>::variable(x, 0));
      const auto any = f(Dual<Pack, 1>::variable(x, 0));
      count += different(near.value, any.value) + different(near.derivative(0), any.derivative(0));
    }
    return count;
  };
  CHECK(differences_of([](const auto& u) { return sin(2.0 * u); }) == 0);
  CHECK(differences_of([](const auto& u) { return cos(u); }) == 0);
  CHECK(differences_of([](const auto& u) { return cosm1(u); }) == 0);
  CHECK(differences_of([](const auto& u) { return exp(0.1 * u); }) == 0);
  CHECK(differences_of([](const auto& u) { return sinc(u); }) == 0);
  CHECK(differences_of([](const auto& u) { return sinh(u); }) == 0);
  CHECK(differences_of([](const auto& u) { return cosh(u); }) == 0);
}

TEMPLATE_TEST_CASE("products of them have the bits of those of Packs, and show an argument moved by a few roundings", "",
                   NearPack, ReducedPack) {
  const auto f = [](const auto& u) {
    return sin(2.0 * u) * cosm1(u) * exp(0.1 * u) / (2.0 + cos(u)) * sinc(u) * cosh(u);
  };
  const auto values_that_differ = [&](double moved) {
    Random random(8);
    int count = 0;
    for (int n = 0; n < 500; ++n) {
      const Pack x = random_pack(random, 10);
      const auto near = f(Dual<TestType, 1>::variable(x, 0));
      const auto any = f(Dual<Pack, 1>::variable(x * (1 + moved), 0));
      count += different(near.value, any.value);
    }
    return count;
  };
  CHECK(values_that_differ(0) == 0);
  CHECK(values_that_differ(1e-15) > 0);
}

// Of a sum of two products, as this one is, and as the derivative of every product is, compilers fuse the one or the
// other, and not the same in both.
TEMPLATE_TEST_CASE("what is made of them, and its derivative, is the same but for which product of a sum is fused", "",
                   NearPack, ReducedPack) {
  const auto f = [](const auto& u) {
    return sin(2.0 * u) * cosm1(u) + exp(0.1 * u) / (2.0 + cos(u)) - sinc(u) * cosh(u);
  };
  const auto largest_difference = [&](double moved) {
    Random random(8);
    Pack largest(0.0);
    for (int n = 0; n < 500; ++n) {
      const Pack x = random_pack(random, 10);
      const Pack size = 10.0 + 2.0 * cosh(x);  // Σ |terms| of f and of f′ is no more
      const auto near = f(Dual<TestType, 1>::variable(x, 0));
      const auto any = f(Dual<Pack, 1>::variable(x * (1 + moved), 0));
      const Pack value = near.value, slope = near.derivative(0);
      largest = largest_magnitude(largest, (value - any.value) / size);
      largest = largest_magnitude(largest, (slope - any.derivative(0)) / size);
    }
    return max_or_nan(largest);
  };
  CHECK(largest_difference(0) < 4e-16);
  CHECK(largest_difference(1e-15) > 4e-16);
}
