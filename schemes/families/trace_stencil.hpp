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
/// Components: q the first d, coefficient j of field a (1 + j) d + a, the multipliers from `multiplier` on.
class TraceStencil {
 public:
  enum class End { lower, upper };
  /// `ends` are φ_j(0) or φ_j(1).
  TraceStencil(End end, int d, std::vector<double> ends, int multiplier) : end_(end), d_(d), multiplier_(multiplier) {
    for (std::size_t j = 0; j < ends.size(); ++j)
      if (ends[j] != 0) coefficients_.push_back({static_cast<int>(j), ends[j]});
  }

  StencilPattern pattern() const {
    return StencilPattern(end_ == End::lower ? std::vector<Site>{{0, 0}} : std::vector<Site>{{0, 0}, {1, 0}});
  }
  std::vector<VertexValue> values() const {
    const int vertex = end_ == End::lower ? 0 : 1;
    std::vector<VertexValue> list;
    for (int a = 0; a < d_; ++a) list.push_back({vertex, a});
    for (int a = 0; a < d_; ++a) list.push_back({vertex, multiplier_ + a});
    for (const auto& [j, weight] : coefficients_)
      for (int a = 0; a < d_; ++a) list.push_back({0, (1 + j) * d_ + a});
    return list;
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    const auto d = static_cast<std::size_t>(d_);
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
  std::vector<std::pair<int, double>> coefficients_;
};

}  // namespace delf
