// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "jets/stencil_lagrangian.hpp"
#include "schemes/families/stencil_family.hpp"
#include "tests/jets/random.hpp"

namespace delf::testing {

/// A stencil Lagrangian of which nothing is special: 3 to 9 of the offsets with times 0 … 2 and spaces −1 … 1, in any
/// order and on at least two rows, with one component and
///
///     L = hk (Σ_{i≤j} q_ij yⁱyʲ + Σ_m c_m Π_{i ∈ m} yⁱ),
///
/// m some cubic and quartic monomials with coefficients c_m that are small. The same seed gives the same L everywhere.
struct RandomStencil {
  struct Monomial {
    double coefficient = 0;
    std::vector<int> factors;  ///< indices i; one that occurs p times is (yⁱ)ᵖ
  };

  StencilPattern shape;
  std::vector<double> quadratic;  ///< q_ij for j = i … n−1, one i after the other
  std::vector<Monomial> monomials;

  explicit RandomStencil(std::uint64_t seed) {
    Random random(seed);
    do shape = StencilPattern(random_offsets(random));
    while (!on_two_rows());
    const int n = shape.size();
    for (int pairs = n * (n + 1) / 2; pairs > 0; --pairs) quadratic.push_back(random(-1, 1));
    for (int count = random.pick(3, 6); count > 0; --count) {
      Monomial m{random(-0.1, 0.1), {}};
      for (int degree = random.pick(3, 4); degree > 0; --degree) m.factors.push_back(random.pick(0, n - 1));
      monomials.push_back(m);
    }
  }

  StencilPattern pattern() const { return shape; }
  std::vector<VertexValue> values() const { return values_at_every_vertex(shape, 1); }

  template <class T>
  T operator()(std::span<const T> y, const Cell& cell) const {
    T sum(0.0);
    std::size_t pair = 0;
    for (std::size_t i = 0; i < y.size(); ++i)
      for (std::size_t j = i; j < y.size(); ++j) sum += quadratic[pair++] * (y[i] * y[j]);
    for (const Monomial& m : monomials) {
      T product(m.coefficient);
      for (const int i : m.factors) product *= y[i];
      sum += product;
    }
    return (cell.time_step * cell.space_step) * sum;
  }

 private:
  /// The first few of the nine offsets, shuffled.
  static std::vector<Site> random_offsets(Random& random) {
    std::vector<Site> offsets;
    for (int time = 0; time <= 2; ++time)
      for (int space = -1; space <= 1; ++space) offsets.push_back({time, space});
    for (int i = 8; i > 0; --i) std::swap(offsets[i], offsets[random.pick(0, i)]);
    offsets.resize(random.pick(3, 9));
    return offsets;
  }
  bool on_two_rows() const {
    for (const Site& offset : shape.vertices)
      if (offset.time != shape.vertices.front().time) return true;
    return false;
  }
};

}  // namespace delf::testing
