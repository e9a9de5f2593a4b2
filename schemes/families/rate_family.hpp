// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/families/lagrangian_family.hpp"

namespace delf {

/// The rate of a Lagrangian along a motion, L̇(y, ẏ) = d/dε L(y + ε ẏ) at ε = 0, of the values y of L, then ẏ. The
/// derivatives of L alone give those of L̇, along with their own rates:
///
///     ∂L̇/∂ẏ = ∂L/∂y,   ∂L̇/∂y = d/dε ∂L/∂y
template <StencilLagrangian L>
class RateFamily final : public StencilFamily {
 public:
  explicit RateFamily(L lagrangian)
      : StencilFamily(StencilPattern({{0, 0}}), list_values(lagrangian), true),
        m_(size() / 2),
        lagrangian_(lagrangian),
        of_(std::move(lagrangian)) {}

  using StencilFamily::jacobian;
  using StencilFamily::lagrangian;
  using StencilFamily::residual;
  bool lagrangian(const StencilBatch& batch, double* values) const override {
    std::vector<Along> y(m_);
    for (int s = 0; s < batch.count; s += lanes) {
      for (int i = 0; i < m_; ++i) y[i] = along(batch, i, s);
      lagrangian_(std::span<const Along>(y), batch.cell).d[0].store(values + s);
    }
    return true;
  }
  void residual(const StencilBatch& batch, std::span<const int> equations, double* r) const override {
    if (equations.size() == 1) slopes<1>(batch, equations, r);
    else slopes<8>(batch, equations, r);
  }
  /// ∂²L̇/∂y∂ẏ = ∂²L/∂y∂y, whose rates are ∂²L̇/∂y∂y; there is no ∂²L̇/∂ẏ∂ẏ.
  [[gnu::__flatten__]] void jacobian(const StencilBatch& batch, std::span<const int> equations,
                                     std::span<const int> unknowns, double* J) const override {
    constexpr int chunk = 4;
    using Number = Dual<Dual<Along, chunk>, 1>;
    thread_local std::vector<Number> y;
    y.assign(m_, Number(0.0));
    std::fill_n(J, equations.size() * unknowns.size() * at(batch.count), 0.0);
    thread_local std::vector<int> as_equation, as_unknown;
    find(equations, as_equation), find(unknowns, as_unknown);
    for (int row = 0; row < m_; ++row)
      for (int first = 0; first < m_; first += chunk) {
        const int last = std::min(first + chunk, m_);
        if (!meets(equations, row, row + 1) || !meets(unknowns, first, last)) continue;
        y[row].d[0].value = Along(1.0);
        for (int i = first; i < last; ++i) y[i].value.d[i - first] = Along(1.0);
        for (int s = 0; s < batch.count; s += lanes) {
          for (int i = 0; i < m_; ++i) y[i].value.value = along(batch, i, s);
          const Number value = lagrangian_(std::span<const Number>(y), batch.cell);
          const auto store = [&](int equation, int unknown, Pack entry) {
            const int e = as_equation[equation], u = as_unknown[unknown];
            if (e >= 0 && u >= 0) entry.store(J + (at(e) * unknowns.size() + at(u)) * at(batch.count) + at(s));
          };
          for (int i = first; i < last; ++i) {
            const Along& entry = value.d[0].d[i - first];
            store(row, i, entry.d[0]), store(row, m_ + i, entry.value), store(m_ + row, i, entry.value);
          }
        }
        y[row].d[0].value = Along(0.0);
        for (int i = first; i < last; ++i) y[i].value.d[i - first] = Along(0.0);
      }
  }
  /// Entries proved constant in ∂²L are constant in ∂²L̇/∂y∂ẏ.
  std::optional<ConstantPart> constant_part(const Cell& cell) const override {
    const auto of = of_.constant_part(cell);
    if (!of) return std::nullopt;
    ConstantPart part{std::vector<double>(size() * size()), std::vector<double>(size()), of->is_all};
    for (int i = 0; i < m_; ++i) {
      part.r0[m_ + i] = of->r0[i];
      for (int j = 0; j < m_; ++j) part.J[(m_ + i) * size() + j] = part.J[j * size() + m_ + i] = of->J[i * m_ + j];
    }
    return part;
  }

 private:
  using Along = Dual<Pack, 1>;  // by ε
  static std::vector<VertexValue> list_values(const L& lagrangian) {
    std::vector<VertexValue> list;
    for (int i = 0; i < 2 * static_cast<int>(lagrangian.values().size()); ++i) list.push_back({0, i});
    return list;
  }
  /// y + ε ẏ of value i of a pack of stencils.
  Along along(const StencilBatch& batch, int i, int s) const {
    Along y = Pack::load(batch.y + i * batch.count + s);
    y.d[0] = Pack::load(batch.y + (m_ + i) * batch.count + s);
    return y;
  }
  /// Finds the places of values in a list; −1: not in it.
  void find(std::span<const int> list, std::vector<int>& place) const {
    place.assign(values_.size(), -1);
    for (std::size_t n = 0; n < list.size(); ++n) place[list[n]] = static_cast<int>(n);
  }
  /// True if values of L, or their rates, are in a list.
  bool meets(std::span<const int> list, int first, int last) const {
    return std::ranges::any_of(list, [&](int i) { return i % m_ >= first && i % m_ < last; });
  }
  template <int width>
  [[gnu::__flatten__]] void slopes(const StencilBatch& batch, std::span<const int> equations, double* r) const {
    using Number = Dual<Along, width>;
    thread_local std::vector<Number> y;
    for (int first = 0; first < m_; first += width) {
      const int last = std::min(first + width, m_);
      if (!meets(equations, first, last)) continue;
      y.assign(m_, Number(0.0));
      for (int i = first; i < last; ++i) y[i].d[i - first] = Along(1.0);
      for (int s = 0; s < batch.count; s += lanes) {
        for (int i = 0; i < m_; ++i) y[i].value = along(batch, i, s);
        const Number value = lagrangian_(std::span<const Number>(y), batch.cell);
        for (std::size_t e = 0; e < equations.size(); ++e) {
          const int i = equations[e] % m_;
          if (i < first || i >= last) continue;
          const Along& slope = value.d[i - first];
          (equations[e] < m_ ? slope.d[0] : slope.value).store(r + e * at(batch.count) + at(s));
        }
      }
    }
  }

  int m_;  ///< values of L
  L lagrangian_;
  LagrangianFamily<L> of_;
};

}  // namespace delf
