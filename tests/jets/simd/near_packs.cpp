// SPDX-License-Identifier: MIT
#include "jets/simd/near_packs.hpp"

#include "jets/numbers/dual.hpp"
#include "tests/catch.hpp"
#include "tests/jets/simd/pack_bits.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Lanes of all packs whose bits differ.
int different(const NearPacks& a, const NearPacks& b) {
  int count = 0;
  for (int i = 0; i < NearPacks::count; ++i) count += testing::different(a.of[i], b.of[i]);
  return count;
}
NearPacks random_packs(Random& random, double bound) {
  return NearPacks::each([&](int) { return random_pack(random, bound); });
}

/// Of random arguments within the bound: lanes in which f side by side is not f of one after the other.
template <class Function>
int differences(Function f, double bound, double moved = 0) {
  Random random(3);
  int count = 0;
  for (int n = 0; n < 1000; ++n) {
    const NearPacks x = random_packs(random, bound);
    const NearPacks one_by_one = NearPacks::each([&](int i) { return f(NearPack(x.of[i] * (1 + moved))); });
    count += different(f(x), one_by_one);
  }
  return count;
}

}  // namespace

TEST_CASE("functions of NearPacks have the bits of those of each NearPack") {
  CHECK(differences([](auto x) { return sin(x); }, 3e6) == 0);
  CHECK(differences([](auto x) { return cos(x); }, 3e6) == 0);
  CHECK(differences([](auto x) { return cosm1(x); }, 3e6) == 0);
  CHECK(differences([](auto x) { return sinh(x); }, 700) == 0);
  CHECK(differences([](auto x) { return cosh(x); }, 700) == 0);
  CHECK(differences([](auto x) { return tanh(x); }, 50) == 0);
  CHECK(differences([](auto x) { return exp(x); }, 800) == 0);
  CHECK(differences([](auto x) { return tan(x); }, 1e9) == 0);
  CHECK(differences([](auto x) { return sqrt(x * x + 1.0); }, 1e9) == 0);
  CHECK(differences([](auto x) { return log(x * x + 1.0); }, 1e9) == 0);
  CHECK(differences([](auto x) { return pow(x * x + 1.0, 1.5) / (2.0 - -x); }, 1e3) == 0);
  // Near zero in all packs, in some, and in none.
  for (const double bound : {0.2, 0.26, 1.0, 30.0, 1e9}) {
    CHECK(differences([](auto x) { return sinc(x); }, bound) == 0);
    CHECK(differences([](auto x) { return sinc_slope(x); }, bound) == 0);
  }
}

TEST_CASE("functions of NearPacks show where one of the arguments is moved by a rounding or two") {
  CHECK(differences([](auto x) { return sin(x); }, 30, 4e-16) > 1000);
  CHECK(differences([](auto x) { return cosm1(x); }, 30, 4e-16) > 1000);
  CHECK(differences([](auto x) { return sinc(x); }, 0.2, 1e-14) > 1000);
}

TEST_CASE("derivatives of functions of NearPacks have the bits of those of each NearPack") {
  const auto differences_of = [](auto f) {
    Random random(8);
    int count = 0;
    for (int n = 0; n < 200; ++n) {
      const NearPacks x = random_packs(random, 10);
      const auto together = f(Dual<NearPacks, 1>::variable(x, 0));
      NearPacks values, slopes;
      for (int i = 0; i < NearPacks::count; ++i) {
        const auto one = f(Dual<NearPack, 1>::variable(x.of[i], 0));
        values.of[i] = one.value, slopes.of[i] = one.derivative(0);
      }
      count += different(together.value, values) + different(together.derivative(0), slopes);
    }
    return count;
  };
  CHECK(differences_of([](const auto& u) { return sin(2.0 * u); }) == 0);
  CHECK(differences_of([](const auto& u) { return cosm1(u); }) == 0);
  CHECK(differences_of([](const auto& u) { return exp(0.1 * u); }) == 0);
  CHECK(differences_of([](const auto& u) { return sinc(u); }) == 0);
}

TEST_CASE("NearPacks are packs that follow each other") {
  alignas(64) double row[(NearPacks::count + 1) * lanes];
  for (std::size_t i = 0; i < std::size(row); ++i) row[i] = static_cast<double>(i);
  const auto load = [&](std::ptrdiff_t at) { return Pack::load(row + at); };
  CHECK(of_packs<Pack>(lanes, load)[1] == lanes + 1);
  const NearPacks x = of_packs<NearPacks>(lanes, load);
  int seen = 0;
  for_each_pack(x, lanes, [&](std::ptrdiff_t at, Pack one) {
    CHECK(at == (1 + seen) * lanes);
    CHECK(one[lanes - 1] == static_cast<double>(at + lanes - 1));
    ++seen;
  });
  CHECK(seen == NearPacks::count);
}
