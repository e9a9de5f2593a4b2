// SPDX-License-Identifier: MIT
#pragma once
#include "jets/simd/near_pack.hpp"

namespace delf {

/// A NearPack whose sine, as cos x − 1, has been begun: x = nπ + r is found when it is made, so that a loop may make it
/// one pack ahead of the sine. Each of the two then waits for half of what a whole sine does, while processors see only
/// so many instructions that wait. The bits are a NearPack's. Where no sine is asked for, nothing of r is left.
struct ReducedPack : NearPack {
  Pack shifted, r, s;  ///< n + round_magic, r, r²

  ReducedPack() = default;
  ReducedPack(NearPack x) : NearPack(x) {
    const Pack whole = x;
    shifted = detail::multiple_of_pi(whole);
    r = detail::rest_of_pi(whole, shifted);
    s = r * r;
  }
  ReducedPack(Pack x) : ReducedPack(NearPack(x)) {}
  ReducedPack(double x) : ReducedPack(NearPack(x)) {}

  friend ReducedPack operator+(const ReducedPack& a, const ReducedPack& b) { return a.whole() + b.whole(); }
  friend ReducedPack operator-(const ReducedPack& a, const ReducedPack& b) { return a.whole() - b.whole(); }
  friend ReducedPack operator*(const ReducedPack& a, const ReducedPack& b) { return a.whole() * b.whole(); }
  friend ReducedPack operator/(const ReducedPack& a, const ReducedPack& b) { return a.whole() / b.whole(); }
  friend ReducedPack operator-(const ReducedPack& a) { return -a.whole(); }

  friend ReducedPack sin(const ReducedPack& x) {
    return detail::sine_near_zero(x.r, x.s, detail::sign_of_parity(x.shifted));
  }
  friend ReducedPack cosm1(const ReducedPack& x) { return detail::cosm1_near_multiple(x.s, x.shifted); }

  // These begin otherwise.
  friend ReducedPack cos(const ReducedPack& x) { return cos(x.whole()); }
  friend ReducedPack sinh(const ReducedPack& x) { return sinh(x.whole()); }
  friend ReducedPack cosh(const ReducedPack& x) { return cosh(x.whole()); }
  friend ReducedPack tan(const ReducedPack& x) { return tan(x.whole()); }
  friend ReducedPack exp(const ReducedPack& x) { return exp(x.whole()); }
  friend ReducedPack log(const ReducedPack& x) { return log(x.whole()); }
  friend ReducedPack sqrt(const ReducedPack& x) { return sqrt(x.whole()); }
  friend ReducedPack tanh(const ReducedPack& x) { return tanh(x.whole()); }
  friend ReducedPack pow(const ReducedPack& x, double p) { return pow(x.whole(), p); }
  friend ReducedPack sinc(const ReducedPack& x) { return sinc(x.whole()); }
  friend ReducedPack sinc_slope(const ReducedPack& x) { return sinc_slope(x.whole()); }

 private:
  const NearPack& whole() const { return *this; }
};

}  // namespace delf
