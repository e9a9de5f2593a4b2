// SPDX-License-Identifier: MIT
#include "jets/batch_density.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace delf {
namespace {

/// ℓ is even in some variables if it is quadratic in them, and entries that couple them to others cancel: (φ_t − φ_x)(φ_t + φ_x).
bool is_even_form(const BatchDensity& density, Reflection r) {
  const int m = density.variables();
  const auto is_reflected = [&](int a) {
    return a < m && (Abstract::variable(a, a / density.components()).odd >> static_cast<int>(r) & 1) != 0;
  };
  for (int a = 0; a < m; ++a) {
    if (!is_reflected(a)) continue;
    if (density.constant_gradient()[a] != 0) return false;
    for (int b = 0; b < m + 2; ++b) {  // t and x are the last
      if (density.is_zero(a, b)) continue;
      if (b >= m || !density.is_constant(a, b)) return false;
      if (!is_reflected(b) && density.constant_hessian()[a * m + b] != 0) return false;
    }
  }
  return true;
}

}  // namespace

/// Constant entries are the same wherever they are taken: at zero, or where the density has a value if it has none there.
void BatchDensity::find_constants() {
  const std::size_t m = variables();
  std::vector<Pack> jet(m + 1, Pack(0.0)), H(m * m), g(m);
  std::vector<const double*> slots(m);
  std::vector<double*> entries(m * m), gradient_rows(m);
  for (std::size_t a = 0; a < m; ++a) {
    slots[a] = reinterpret_cast<const double*>(&jet[a]);
    gradient_rows[a] = reinterpret_cast<double*>(&g[a]);
    for (std::size_t b = 0; b < m; ++b) entries[a * m + b] = reinterpret_cast<double*>(&H[a * m + b]);
  }
  const JetBatch batch{lanes, slots.data(), 0, reinterpret_cast<const double*>(&jet[m])};
  const auto kept = [&](std::size_t a, std::size_t b) {
    return is_constant(static_cast<int>(a), static_cast<int>(b)) ? H[a * m + b][0] : 0.0;
  };
  for (const bool at_zero : {true, false}) {
    for (std::size_t a = 0; a < m && !at_zero; ++a) jet[a] = Pack(1 + 0.25 * static_cast<double>(a));
    // While no constants are known, every entry of the Hessian is evaluated.
    constant_hessian_.clear();
    hessian(batch, entries.data());
    gradient(batch, gradient_rows.data());
    constant_hessian_.assign(m * m, 0.0);
    constant_gradient_.assign(m, 0.0);
    bool finite = true;
    for (std::size_t a = 0; a < m; ++a)
      for (std::size_t b = 0; b < m; ++b) {
        constant_hessian_[a * m + b] = kept(a, b);
        finite = finite && std::isfinite(kept(a, b));
      }
    for (std::size_t a = 0; a < m; ++a) {
      constant_gradient_[a] = g[a][0];
      for (std::size_t b = 0; b < m; ++b) constant_gradient_[a] -= constant_hessian_[a * m + b] * jet[b][0];
      finite = finite && std::isfinite(constant_gradient_[a]);
    }
    if (finite) break;
  }
  for (int r = 0; r <= static_cast<int>(Reflection::in_time); ++r)
    if (is_even_form(*this, static_cast<Reflection>(r)))
      structure_.of_density.even |= static_cast<std::uint8_t>(1u << r);
}

}  // namespace delf
