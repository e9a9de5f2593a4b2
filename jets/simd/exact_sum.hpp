// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

/// a + b − sum, where sum is a + b rounded: exact, for numbers and packs of any sizes (Møller 1965, Knuth 4.2.2).
template <class T>
T rounding_of_sum(const T& a, const T& b, const T& sum) {
  const T of_b = sum - a;
  return (a - (sum - of_b)) + (b - of_b);
}

/// A sum in two numbers, high + low, takes one more term: rounding is lost at the size of the low part alone.
template <class T>
void add_exactly(T& high, T& low, const T& term) {
  const T sum = high + term;
  low += rounding_of_sum(high, term, sum);
  high = sum + low;
  low -= high - sum;
}

}  // namespace delf
