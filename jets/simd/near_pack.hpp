// SPDX-License-Identifier: MIT
#pragma once
#include "jets/numbers/sinc.hpp"

namespace delf {

/// A Pack whose functions take for granted that no lane lies beyond what their polynomials reach: none is asked, which
/// is a tenth of a sine. In reach results are those of a Pack, to the bit; beyond they are any number. Of what is made of
/// them, in a sum of two products compilers fuse the one or the other: that may differ by a rounding. Loops evaluate
/// densities with these while |φ| ≤ near_below(density) (jets/structure.hpp).
struct NearPack : Pack {
  using Pack::Pack;
  constexpr NearPack(Pack x) : Pack(x) {}

  friend NearPack operator+(NearPack a, NearPack b) { return {a.v + b.v}; }
  friend NearPack operator-(NearPack a, NearPack b) { return {a.v - b.v}; }
  friend NearPack operator*(NearPack a, NearPack b) { return {a.v * b.v}; }
  friend NearPack operator/(NearPack a, NearPack b) { return {a.v / b.v}; }
  friend NearPack operator-(NearPack a) { return {-a.v}; }

  friend NearPack sin(NearPack x) { return detail::sine_in_reach<Pack>(x); }
  friend NearPack cos(NearPack x) { return detail::cosine_in_reach<Pack>(x); }
  friend NearPack cosm1(NearPack x) { return detail::cosm1_in_reach<Pack>(x); }
  friend NearPack sinh(NearPack x) { return detail::sinh_in_reach(x); }
  friend NearPack cosh(NearPack x) { return detail::hyperbolic(abs(static_cast<Pack>(x))).cosh; }

  // These ask nothing, or ask what a bound on φ does not answer.
  friend NearPack tan(NearPack x) { return tan(static_cast<Pack>(x)); }
  friend NearPack exp(NearPack x) { return exp(static_cast<Pack>(x)); }
  friend NearPack log(NearPack x) { return log(static_cast<Pack>(x)); }
  friend NearPack sqrt(NearPack x) { return sqrt(static_cast<Pack>(x)); }
  friend NearPack tanh(NearPack x) { return tanh(static_cast<Pack>(x)); }
  friend NearPack pow(NearPack x, double p) { return pow(static_cast<Pack>(x), p); }
  friend NearPack sinc(NearPack x) { return sinc(static_cast<Pack>(x)); }
  friend NearPack sinc_slope(NearPack x) { return sinc_slope(static_cast<Pack>(x)); }
};

}  // namespace delf
