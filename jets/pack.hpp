// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
#include <cstring>

namespace delf {

#if defined(__AVX512F__)
inline constexpr int lanes = 8;
#elif defined(__AVX__)
inline constexpr int lanes = 4;
#else
inline constexpr int lanes = 2;
#endif

/// `lanes` doubles that are worked on at once: a thin wrapper over the compiler's vector extension. Densities see it
/// (inside a Dual) as just another number. Mathematical functions are in jets/pack_math.hpp.
struct Pack {
  using Vector = double __attribute__((vector_size(sizeof(double) * lanes)));
  Vector v;

  Pack() = default;
  constexpr Pack(Vector vector) : v(vector) {}
  constexpr Pack(double x) : v(Vector{} + x) {}

  /// From and to memory aligned to a whole pack.
  static Pack load(const double* p) { return Pack{*reinterpret_cast<const Aliased*>(p)}; }
  void store(double* p) const { *reinterpret_cast<Aliased*>(p) = v; }

  double operator[](int lane) const { return v[lane]; }

  friend Pack operator+(Pack a, Pack b) { return {a.v + b.v}; }
  friend Pack operator-(Pack a, Pack b) { return {a.v - b.v}; }
  friend Pack operator*(Pack a, Pack b) { return {a.v * b.v}; }
  friend Pack operator/(Pack a, Pack b) { return {a.v / b.v}; }
  friend Pack operator-(Pack a) { return {-a.v}; }
  Pack& operator+=(Pack b) { v += b.v; return *this; }
  Pack& operator-=(Pack b) { v -= b.v; return *this; }
  Pack& operator*=(Pack b) { v *= b.v; return *this; }

 private:
  using Aliased = double __attribute__((vector_size(sizeof(double) * lanes), may_alias));
};

inline Pack abs(Pack a) {
  return {a.v < 0 ? -a.v : a.v};
}
/// The larger of two; a NaN in either stays a NaN, so that a maximum over a row shows it.
inline Pack max_or_nan(Pack a, Pack b) {
  const Pack::Vector larger = a.v > b.v ? a.v : b.v;
  return {a.v == a.v ? larger : a.v};
}
inline double sum(Pack a) {
  double s = 0;
  for (int l = 0; l < lanes; ++l) s += a[l];
  return s;
}
inline double max_or_nan(Pack a) {
  double m = a[0];
  for (int l = 1; l < lanes; ++l) m = (a[l] > m || a[l] != a[l]) ? a[l] : m;
  return m;
}

}  // namespace delf
