// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// An end of a broken time element (jets/tables/time_element.hpp), tied to the vertex there by a multiplier:
///
///     lower end   λ_n · (Σ_j φ_j(0) x_n^j − q_n)                  λ_n = p_n
///     upper end   μ_{n+1} · (Σ_j φ_j(1) x_n^j − q_{n+1})          μ_{n+1} = −p_{n+1}
///
/// Components: q the first d, coefficient j of field a (1 + j) d + a, the multipliers from `multiplier` on. Or some of
/// them, where d counts the fields at all nodes of a cell of space.
class TraceStencil {
 public:
  enum class End { lower, upper };
  /// The components first … first + count − 1 of the d. Those at a node inside a cell are anchored where there is one.
  struct Part {
    int first = 0, count = 0;
    bool in_cell = false;
  };
  /// `ends` are φ_j(0) or φ_j(1).
  TraceStencil(End end, int d, std::vector<double> ends, int multiplier)
      : TraceStencil(end, d, std::move(ends), multiplier, {0, d}) {}
  TraceStencil(End end, int d, std::vector<double> ends, int multiplier, Part part)
      : end_(end), d_(d), multiplier_(multiplier), part_(part) {
    for (std::size_t j = 0; j < ends.size(); ++j)
      if (ends[j] != 0) coefficients_.push_back({static_cast<int>(j), ends[j]});
  }

  StencilPattern pattern() const {
    std::vector<Site> vertices{{0, 0}};
    if (end_ == End::upper) vertices.push_back({1, 0});
    if (part_.in_cell) vertices.push_back({0, 1});
    return StencilPattern(vertices);
  }
  std::vector<VertexValue> values() const {
    const int vertex = end_ == End::lower ? 0 : 1;
    std::vector<VertexValue> list;
    for (int a = 0; a < part_.count; ++a) list.push_back({vertex, part_.first + a});
    for (int a = 0; a < part_.count; ++a) list.push_back({vertex, multiplier_ + part_.first + a});
    for (const auto& [j, weight] : coefficients_)
      for (int a = 0; a < part_.count; ++a) list.push_back({0, (1 + j) * d_ + part_.first + a});
    return list;
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    const auto d = static_cast<std::size_t>(part_.count);
    T L(0.0);
    for (std::size_t a = 0; a < d; ++a) {
      T gap = -y[a];
      for (std::size_t n = 0; n < coefficients_.size(); ++n) gap += coefficients_[n].second * y[(2 + n) * d + a];
      L += y[d + a] * gap;
    }
    return L;
  }

 private:
  End end_;
  int d_, multiplier_;
  Part part_;
  std::vector<std::pair<int, double>> coefficients_;
};

}  // namespace delf
