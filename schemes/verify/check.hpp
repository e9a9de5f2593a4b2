// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace delf {

/// The rest of a sum that ought to be zero, beside the sum of the absolute values of its terms.
struct Balance {
  double sum = 0, absolute = 0;
  std::int64_t count = 0;  ///< terms that are not zero

  void add(double term) {
    sum += term;
    absolute += std::abs(term);
    count += term != 0;
  }
  /// The rest relative to its terms; not a number if a term was none.
  double relative() const { return absolute == 0 ? 0.0 : std::abs(sum) / absolute; }
};

/// True if a value is the worst so far; nothing is worse than one that is not a number.
inline bool worse(double value, double than) { return !(value <= than) && !std::isnan(than); }

/// Adds Ωⁱ(V, W) = −Σ_m ∂rⁱ/∂yᵐ (Vᵐ Wⁱ − Wᵐ Vⁱ) of one stencil, every product a term of its own: where V and W have
/// grown nearly parallel their differences are rounding, and only the products tell how large that may be.
inline void add_form(Balance& balance, std::size_t i, std::span<const double> jacobian, std::span<const double> V,
                     std::span<const double> W) {
  const std::size_t size = V.size();
  for (std::size_t m = 0; m < size; ++m) {
    const double entry = jacobian[i * size + m];
    if (entry == 0 || m == i) continue;  // of m = i both products are the same
    balance.add(-entry * V[m] * W[i]);
    balance.add(entry * W[m] * V[i]);
  }
}

/// A statement that was checked. `value` is the largest found, and `value · normaliser` what it was before it was made
/// relative; a value that is not a number is a failure.
struct Check {
  std::string name;
  std::string region;  ///< where the value is: "staircase of 31 sites, rows 812 … 819, local V, W"
  double value = 0;
  double tolerance = 0;
  double normaliser = 1;     ///< what `value` is relative to
  std::int64_t count = 0;    ///< terms of the sum that `value` is of
  std::int64_t samples = 0;  ///< how many such sums were tried
  std::string failure = {};  ///< what a failure means and where it is, in words; for those that passed it is not read

  bool passed() const { return value <= tolerance; }
  /// One more sample: true if it is the worst so far, and what the check tells from now on.
  bool take(const Balance& balance, const std::string& where) {
    if (samples++ > 0 && !worse(balance.relative(), value)) return false;
    value = balance.relative(), normaliser = balance.absolute, count = balance.count, region = where;
    return true;
  }
};

/// A quantity that is measured because no theorem promises it: there is nothing to pass.
struct Measured {
  std::string name;
  std::string region;
  double value = 0;
  double normaliser = 1;
  std::int64_t count = 0;
  double order = std::numeric_limits<double>::quiet_NaN();  ///< of value in h, if it was measured
  std::string remark = {};
};

}  // namespace delf
