// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "jets/numbers/differentiate.hpp"
#include "jets/stencil_lagrangian.hpp"
#include "lattice/error.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// A discrete Lagrangian on the values of a stencil: rⁱ = ∂L/∂yⁱ and its Jacobian ∂²L/∂yⁱ∂yʲ by differentiation.
template <StencilLagrangian L>
class LagrangianFamily final : public StencilFamily {
 public:
  explicit LagrangianFamily(L lagrangian)
      : StencilFamily(lagrangian.pattern(), lagrangian.values(), true), lagrangian_(std::move(lagrangian)) {
    placed_ = delf::is_placed<L>();
    require_good_values();
  }

  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    gradient(at(cell), y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    hessian(at(cell), y, J);
  }
  std::optional<double> lagrangian(const Cell& cell, std::span<const double> y) const override {
    return lagrangian_(y, cell);
  }

 private:
  /// L as a function of y alone.
  auto at(const Cell& cell) const {
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
};

}  // namespace delf
