// SPDX-License-Identifier: MIT
// The bits of packs of four lanes, as one number: the same whatever instructions this is compiled for.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>

#include "jets/numbers/sinc.hpp"

using namespace delf;

namespace {

std::uint64_t bits = 1469598103934665603u;

void add(double x) {
  std::uint64_t word = 0;
  std::memcpy(&word, &x, sizeof word);
  bits = (bits ^ word) * 1099511628211u;
}
void add(Pack x) {
  for (int l = 0; l < lanes; ++l) add(x[l]);
}

}  // namespace

int main() {
  static_assert(lanes == 4);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-1, 1), exponent(-20, 10);
  for (int n = 0; n < 20000; ++n) {
    Pack x, y;
    for (int l = 0; l < lanes; ++l) x.v[l] = mantissa(random) * std::exp2(exponent(random)), y.v[l] = mantissa(random);
    for (const Pack& value :
         {sin(x), cos(x), cosm1(x), cosine_beside_sine(x), exp(x), sinh(x), cosh(x), tanh(x), sqrt(abs(x)), sinc(x),
          x * y + x, x / y, max_or_nan(x, y), larger_size(abs(x), abs(y)), from_lane_above(x), from_lane_below(y)})
      add(value);
    add(sum(x)), add(max_or_nan(x)), add(detail::any_above(x, 1) ? 1.0 : 0.0);
  }
  std::printf("%016llx\n", static_cast<unsigned long long>(bits));
}
