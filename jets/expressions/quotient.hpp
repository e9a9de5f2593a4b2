// SPDX-License-Identifier: MIT
#pragma once
#include "jets/batch_density.hpp"
#include "jets/expressions/tape.hpp"

namespace delf::expressions {

/// (N(a) − N(b))/(a − b) of a potential N(φ), and its derivatives by a and b, also where a and b are near or the same. With
/// m = (a + b)/2 and δ = a − b,
///
///     N′(m) + δ²/24 N‴(m) + δ⁴/1920 N⁽⁵⁾(m) + δ⁶/322560 N⁽⁷⁾(m)
///
/// where the last term is rounding, and the quotient itself elsewhere.
class Quotient {
 public:
  Quotient() = default;
  /// N as a node; φ is variable 0 of so many. Throws TooLarge.
  Quotient(Graph&, int potential, int variables);

  void value(const JetBatch& ab, double* q) const;
  void derivatives(const JetBatch& ab, double* by_a, double* by_b) const;

 private:
  struct Lanes;
  void each(const JetBatch& ab, const auto& put) const;

  Tape ends_, middle_;  ///< N and N′ at a and b; N′ … N⁽⁸⁾ at m
  int variables_ = 0;
};

}  // namespace delf::expressions
