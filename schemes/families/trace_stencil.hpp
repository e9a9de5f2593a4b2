// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "jets/simd/exact_sum.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// An end of a broken time element (jets/tables/time_element.hpp), tied to the vertex there by a multiplier:
///
///     lower end   λ_n · (Σ_j φ_j(0) x_n^j − q_n)                  λ_n = p_n
///     upper end   μ_{n+1} · (Σ_j φ_j(1) x_n^j − q_{n+1})          μ_{n+1} = −p_{n+1}
///
/// Components: value a of the vertex is `trace` + a, coefficient j of field a (1 + j) d + a, the multipliers follow each
/// other from `multiplier` on. The vertex's value is the field itself, or a trace q⁻, q⁺ of it.
class TraceStencil {
 public:
  enum class End { lower, upper };
  /// `ends` are φ_j(0) or φ_j(1).
  TraceStencil(End end, int d, std::vector<double> ends, int multiplier, int trace = 0)
      : end_(end), d_(d), trace_(trace) {
    for (std::size_t j = 0; j < ends.size(); ++j)
      if (ends[j] != 0) coefficients_.push_back({static_cast<int>(j), ends[j]});
    for (int a = 0; a < d; ++a) tied_.push_back({a, multiplier + a});
    // Σ_j φ_j = 1: what rounding leaves of it every step would take from the momentum. The smallest one has it.
    double rest = -1, low = 0;
    for (const auto& [j, weight] : coefficients_) add_exactly(rest, low, weight);
    const auto smallest =
        std::ranges::min_element(coefficients_, {}, [](const auto& entry) { return std::abs(entry.second); });
    if (std::abs(rest) < 1e-12) smallest->second -= rest + low;
  }
  /// Some fields alone, each with the component of its multiplier.
  TraceStencil(End end, int d, const std::vector<double>& ends, std::vector<std::pair<int, int>> tied)
      : TraceStencil(end, d, ends, 0) {
    tied_ = std::move(tied);
  }
  /// The stencil in a lattice of space, with `fields` at each node of the unit cell, d at all nodes of a row: values
  /// are read at their nodes, as the element reads them. Those at nodes inside a cell of space are where there is a
  /// cell: not at the right end of an interval.
  TraceStencil(End end, int d, const std::vector<double>& ends, std::vector<std::pair<int, int>> tied, int fields,
               bool in_cell)
      : TraceStencil(end, d, ends, std::move(tied)) {
    fields_ = fields, in_cell_ = in_cell;
  }

  /// The stencil with a node for every value, and component = node · d + a, as in the tables of fluxes.
  TraceStencil with_own_nodes() && {
    fields_ = d_, own_nodes_ = true;
    return std::move(*this);
  }

  StencilPattern pattern() const { return StencilPattern(read().vertices); }
  std::vector<VertexValue> values() const { return read().values; }
  /// The numbers of the values of one field: they enter by their differences alone, for Σ_j φ_j = 1.
  std::vector<std::vector<int>> columns() const {
    const std::size_t d = tied_.size();
    std::vector<std::vector<int>> columns;
    for (std::size_t a = 0; a < d; ++a) {
      columns.push_back({static_cast<int>(a)});
      for (std::size_t n = 0; n < coefficients_.size(); ++n) columns.back().push_back(static_cast<int>((2 + n) * d + a));
    }
    return columns;
  }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    const std::size_t d = tied_.size();
    T L(0.0);
    for (std::size_t a = 0; a < d; ++a) {
      T gap = -y[a];
      for (std::size_t n = 0; n < coefficients_.size(); ++n) gap += coefficients_[n].second * y[(2 + n) * d + a];
      L += y[d + a] * gap;
    }
    return L;
  }

 private:
  struct Reads {
    std::vector<Site> vertices;
    std::vector<VertexValue> values;
  };
  Reads read() const {
    const int row = end_ == End::lower ? 0 : 1;
    Reads reads{{{0, 0}}, {}};
    if (row == 1) reads.vertices.push_back({1, 0});
    if (in_cell_) reads.vertices.push_back({0, 1});
    const auto add = [&](int time, int place, int component) {
      const Site site{time, 0, fields_ > 0 ? (own_nodes_ ? component : place) / fields_ : 0};
      const auto at = std::ranges::find(reads.vertices, site) - reads.vertices.begin();
      if (at == std::ssize(reads.vertices)) reads.vertices.push_back(site);
      reads.values.push_back({static_cast<int>(at), component});
    };
    for (const auto& [a, multiplier] : tied_) add(row, a, trace_ + a);
    for (const auto& [a, multiplier] : tied_) add(row, a, multiplier);
    for (const auto& [j, weight] : coefficients_)
      for (const auto& [a, multiplier] : tied_) add(0, (1 + j) * d_ + a, (1 + j) * d_ + a);
    return reads;
  }

  End end_;
  int d_, trace_;
  std::vector<std::pair<int, double>> coefficients_;
  std::vector<std::pair<int, int>> tied_;  ///< fields, with the components of their multipliers
  int fields_ = 0;                         ///< at a node; 0: all values are read at the vertex
  bool in_cell_ = false, own_nodes_ = false;
};

}  // namespace delf
