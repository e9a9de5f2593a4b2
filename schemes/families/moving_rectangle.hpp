// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/r_adaptive.hpp"

namespace delf {

/// MovingRectangle with the momenta that a start by the discrete Legendre transform needs.
class MovingRectangleFamily final : public StencilFamily {
 public:
  explicit MovingRectangleFamily(MovingRectangle rectangle)
      : StencilFamily(rectangle.pattern(), rectangle.values(), true), action_(rectangle) {}

  using StencilFamily::jacobian;
  using StencilFamily::lagrangian;
  using StencilFamily::residual;
  void residual(const StencilBatch& batch, std::span<const int> equations, double* r) const override {
    action_.residual(batch, equations, r);
  }
  void jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override {
    action_.jacobian(batch, equations, unknowns, J);
  }
  bool lagrangian(const StencilBatch& batch, double* L) const override { return action_.lagrangian(batch, L); }
  std::optional<ConstantPart> constant_part(const Cell& cell) const override { return action_.constant_part(cell); }

  /// p = ∂/∂q̇ ∫ ½w² dx over the cell at row 0, w = φ̇ − γẊ, (44)
  bool momentum(const Cell&, std::span<const double> q, std::span<const double> rates,
                std::span<double> p) const override {
    using Number = Dual<double, 4>;  // by the rates of φ and X at the left, then at the right
    const auto rate = [&](int i) { return Number::variable(rates[static_cast<std::size_t>(i)], i); };
    const double size = q[3] - q[1], slope = (q[2] - q[0]) / size;
    const Number kinetic = MovingRectangle::kinetic(Number(size), rate(0) - slope * rate(1), rate(2) - slope * rate(3));
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = kinetic.d[i];
    return true;
  }

 private:
  LagrangianFamily<MovingRectangle> action_;
};

}  // namespace delf
