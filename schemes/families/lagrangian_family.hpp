// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "jets/numbers/differentiate.hpp"
#include "jets/numbers/structure.hpp"
#include "jets/stencil_lagrangian.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// A discrete Lagrangian on the values of a stencil: rⁱ = ∂L/∂yⁱ and its Jacobian ∂²L/∂yⁱ∂yʲ by differentiation, for a
/// pack of stencils at once.
template <StencilLagrangian L>
class LagrangianFamily final : public StencilFamily {
 public:
  explicit LagrangianFamily(L lagrangian)
      : StencilFamily(lagrangian.pattern(), lagrangian.values(), true), lagrangian_(std::move(lagrangian)) {
    placed_ = delf::is_placed<L>();
    require_good_values();
    if constexpr (requires { lagrangian_.columns(); }) {
      sums_ = lagrangian_.columns();
      reads_low_ = sums_vanish_ = true;
      first_.assign(values_.size(), -1);
      for (const std::vector<int>& column : sums_)
        for (const int i : column) first_[i] = column.front();
    }
  }

  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    gradient(in(cell), y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    hessian(in(cell), y, J);
  }
  std::optional<double> lagrangian(const Cell& cell, std::span<const double> y) const override {
    return lagrangian_(y, cell);
  }

  bool is_flux() const override {
    return requires { L::is_flux; };
  }

  bool lagrangian(const StencilBatch& batch, double* values) const override {
    std::vector<double> y(values_.size());
    for (int s = 0; s < batch.count; ++s) {
      Cell cell = batch.cell;
      cell.x = batch.x[s];
      for (int i = 0; i < size(); ++i) y[i] = batch.y[i * batch.count + s];
      values[s] = lagrangian_(std::span<const double>(y), cell);
    }
    return true;
  }

  using StencilFamily::residual;
  void residual(const StencilBatch& batch, std::span<const int> equations, double* r) const override {
    if (placed_) return StencilFamily::residual(batch, equations, r);
    // Most batches need one sweep.
    if (equations.size() == 1) slopes<1>(batch, equations, r);
    else if (equations.size() <= 4) slopes<4>(batch, equations, r);
    else slopes<8>(batch, equations, r);
  }
  /// A sweep of second derivatives for each value of the shorter list, by four of the longer one: ∂²L is symmetric.
  [[gnu::__flatten__]] void jacobian(const StencilBatch& batch, std::span<const int> equations,
                                     std::span<const int> unknowns, double* J) const override {
    if (placed_) return StencilFamily::jacobian(batch, equations, unknowns, J);
    constexpr int chunk = 4;
    using Number = Dual<Dual<Pack, chunk>, 1>;
    thread_local std::vector<Number> y;
    y.assign(values_.size(), Number(0.0));
    const std::size_t U = unknowns.size();
    const bool by_unknown = U < equations.size();
    const std::span<const int> rows = by_unknown ? unknowns : equations, columns = by_unknown ? equations : unknowns;
    for (std::size_t first = 0; first < columns.size(); first += chunk) {
      const std::size_t last = std::min(first + chunk, columns.size());
      for (std::size_t m = first; m < last; ++m) y[columns[m]].value.d[m - first] = Pack(1.0);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        y[rows[i]].d[0].value = Pack(1.0);
        for (int s = 0; s < batch.count; s += lanes) {
          for (int n = 0; n < size(); ++n) y[n].value.value = Pack::load(batch.y + n * batch.count + s);
          const Number value = lagrangian_(std::span<const Number>(y), batch.cell);
          for (std::size_t m = first; m < last; ++m)
            value.d[0].d[m - first].store(J + (by_unknown ? m * U + i : i * U + m) * at(batch.count) + at(s));
        }
        y[rows[i]].d[0].value = Pack(0.0);
      }
      for (std::size_t m = first; m < last; ++m) y[columns[m]].value.d[m - first] = Pack(0.0);
    }
  }
  /// The second derivatives that the form of L alone proves constant.
  std::optional<ConstantPart> constant_part(const Cell& cell) const override {
    if (placed_ || size() > Abstract::most_variables) return std::nullopt;
    std::vector<Abstract> y;
    for (int i = 0; i < size(); ++i) y.push_back(Abstract::variable(i));
    const Abstract form = lagrangian_(std::span<const Abstract>(y), cell);
    const std::vector<double> zero(values_.size(), 0.0);
    ConstantPart part{std::vector<double>(zero.size() * zero.size()), std::vector<double>(zero.size()), true};
    jacobian(cell, zero, part.J);
    residual(cell, zero, part.r0);
    for (int i = 0; i < size(); ++i)
      for (int m = 0; m < size(); ++m) {
        double& value = part.J[i * size() + m];
        const auto has = [&](const auto& bits) { return (bits[i] >> m & 1u) != 0; };
        if (has(form.varying)) part.is_all = false;
        if (has(form.varying) || !has(form.nonzero)) value = 0;
        if (!std::isfinite(value)) return std::nullopt;
      }
    for (double& value : part.r0)
      if (!part.is_all) value = 0;
      else if (!std::isfinite(value)) return std::nullopt;
    return part;
  }

 private:
  /// ∂L/∂y of some values for every pack of stencils, `width` of them a sweep.
  template <std::size_t width>
  [[gnu::__flatten__]] void slopes(const StencilBatch& batch, std::span<const int> equations, double* r) const {
    using Number = Dual<Pack, static_cast<int>(width)>;
    thread_local std::vector<Number> y;
    y.assign(values_.size(), Number(0.0));
    for (std::size_t first = 0; first < equations.size(); first += width) {
      const std::size_t last = std::min(first + width, equations.size());
      for (std::size_t e = first; e < last; ++e) y[equations[e]].d[e - first] = Pack(1.0);
      for (int s = 0; s < batch.count; s += lanes) {
        for (int i = 0; i < size(); ++i) y[i].value = load(batch, i, s);
        const Number value = lagrangian_(std::span<const Number>(y), batch.cell);
        for (std::size_t e = first; e < last; ++e) value.d[e - first].store(r + e * at(batch.count) + at(s));
      }
      for (std::size_t e = first; e < last; ++e) y[equations[e]].d[e - first] = Pack(0.0);
    }
  }
  /// Value i of a pack of stencils, counted from the first of its column: L depends on such differences alone.
  Pack load(const StencilBatch& batch, int i, int s) const {
    const auto of = [&](const double* values, int n) { return Pack::load(values + n * batch.count + s); };
    const int from = batch.low == nullptr ? -1 : first_[i];
    if (from < 0) return of(batch.y, i);
    return (of(batch.y, i) - of(batch.y, from)) + (of(batch.low, i) - of(batch.low, from));
  }
  /// L as a function of y alone.
  auto in(const Cell& cell) const {
    return [this, &cell]<class T>(std::span<const T> y) -> T { return lagrangian_(y, cell); };
  }

  void require_good_values() const {
    const auto refuse = [](const std::string& why) { throw BadInput("lattice.stencil", "lattice.stencil: " + why); };
    if (values_.empty()) refuse("a stencil Lagrangian reads no values and has no equations; list them in values()");
    for (auto value = values_.begin(); value != values_.end(); ++value) {
      const std::string named = "values() of a stencil Lagrangian names component " + std::to_string(value->component) +
                                " at vertex " + std::to_string(value->vertex);
      if (value->vertex < 0 || value->vertex >= pattern_.size())
        refuse(named + ", but its pattern has " + std::to_string(pattern_.size()) +
               " vertices; count them from 0, or add the vertex to pattern()");
      if (value->component < 0) refuse(named + "; count components from 0");
      // Twice the same value: each of the two residuals would be only a part of ∂L/∂y.
      if (std::find(values_.begin(), value, *value) != value) refuse(named + " twice; name it once");
    }
  }

  L lagrangian_;
  std::vector<int> first_;  ///< [i]: the first value of its column; −1: in none
};

}  // namespace delf
