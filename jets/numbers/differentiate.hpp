// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "jets/numbers/dual.hpp"

namespace delf {

// Forward differentiation of a function whose number n of variables is known at run time only: f is called as f(x),
// x a std::span<const T> of n numbers of some Dual type T, and returns a T. A Dual has room for a fixed number of
// derivatives, so f is run once for every chunk of that many variables.

namespace detail {
/// Derivatives in one run: one AVX-512 register of doubles, two of AVX2.
inline constexpr int chunk = 8;
}  // namespace detail

/// g_i = ∂f/∂y_i
template <class F>
void gradient(const F& f, std::span<const double> y, std::span<double> g) {
  using Number = Dual<double, detail::chunk>;
  // One for each F, so that an f that differentiates another function in turn finds its variables as they were.
  thread_local std::vector<Number> x;
  const std::size_t n = y.size();
  x.assign(y.begin(), y.end());
  for (std::size_t first = 0; first < n; first += detail::chunk) {
    const std::size_t count = std::min<std::size_t>(detail::chunk, n - first);
    for (std::size_t b = 0; b < count; ++b) x[first + b].d[b] = 1;
    const Number value = f(std::span<const Number>(x));
    for (std::size_t b = 0; b < count; ++b) g[first + b] = value.d[b], x[first + b].d[b] = 0;
  }
}

/// H_ij = ∂²f/∂y_i∂y_j, row by row. Differentiated for j ≤ i and mirrored, so that H is symmetric to the last bit.
template <class F>
void hessian(const F& f, std::span<const double> y, std::span<double> H) {
  using Inner = Dual<double, detail::chunk>;  // by the y_j of one chunk
  using Outer = Dual<Inner, 1>;               // by one y_i
  thread_local std::vector<Outer> x;
  const std::size_t n = y.size();
  x.assign(y.begin(), y.end());
  for (std::size_t first = 0; first < n; first += detail::chunk) {
    const std::size_t count = std::min<std::size_t>(detail::chunk, n - first);
    for (std::size_t b = 0; b < count; ++b) x[first + b].value.d[b] = 1;
    for (std::size_t i = first; i < n; ++i) {
      x[i].d[0].value = 1;
      const Outer value = f(std::span<const Outer>(x));
      x[i].d[0].value = 0;
      for (std::size_t b = 0; b < count && first + b <= i; ++b)
        H[i * n + first + b] = H[(first + b) * n + i] = value.d[0].d[b];
    }
    for (std::size_t b = 0; b < count; ++b) x[first + b].value.d[b] = 0;
  }
}

}  // namespace delf
