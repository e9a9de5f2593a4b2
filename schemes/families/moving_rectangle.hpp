// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>

#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/r_adaptive.hpp"

namespace delf {

/// An action on sites that move, in closed form: of a whole step by the trapezoidal rule, and of one point of any element.
class MovingAction : public StencilFamily {
 public:
  /// The action at one point of an element, with its weight: it reads (φ, X) at both ends of a cell, then h (φ_t, X_t).
  virtual std::shared_ptr<const StencilFamily> stage(double weight) const = 0;

 protected:
  using StencilFamily::StencilFamily;
};

/// p = ∂/∂q̇ ∫ ½w² dx over the cell at row 0, w = φ̇ − γẊ, (44)
inline void moving_momentum(std::span<const double> q, std::span<const double> rates, double weight,
                            std::span<double> p) {
  using Number = Dual<double, 4>;  // by the rates of φ and X at the left, then at the right
  const auto rate = [&](int i) { return Number::variable(rates[static_cast<std::size_t>(i)], i); };
  const double size = q[3] - q[1], slope = (q[2] - q[0]) / size;
  const Number kinetic = MovingRectangle::kinetic(Number(size), rate(0) - slope * rate(1), rate(2) - slope * rate(3));
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = weight * kinetic.d[i];
}

/// A Lagrangian on sites that move, with the momenta that a start by the discrete Legendre transform needs.
template <class Lagrangian, class Base>
class MovingFamily : public Base {
 public:
  MovingFamily(const Lagrangian& lagrangian, double weight)
      : Base(lagrangian.pattern(), lagrangian.values(), true), weight_(weight), action_(lagrangian) {}

  using Base::jacobian;
  using Base::lagrangian;
  using Base::residual;
  void residual(const StencilBatch& batch, std::span<const int> equations, double* r) const override {
    action_.residual(batch, equations, r);
  }
  void jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override {
    action_.jacobian(batch, equations, unknowns, J);
  }
  bool lagrangian(const StencilBatch& batch, double* L) const override { return action_.lagrangian(batch, L); }
  std::optional<ConstantPart> constant_part(const Cell& cell) const override { return action_.constant_part(cell); }
  bool momentum(const Cell&, std::span<const double> q, std::span<const double> rates,
                std::span<double> p) const override {
    moving_momentum(q, rates, weight_, p);
    return true;
  }

 private:
  double weight_;
  LagrangianFamily<Lagrangian> action_;
};

class MovingRectangleFamily final : public MovingFamily<MovingRectangle, MovingAction> {
 public:
  explicit MovingRectangleFamily(MovingRectangle rectangle) : MovingFamily(rectangle, 1), rectangle_(rectangle) {}
  std::shared_ptr<const StencilFamily> stage(double weight) const override {
    return std::make_shared<const MovingFamily<MovingStage, StencilFamily>>(MovingStage{rectangle_, weight}, weight);
  }

 private:
  MovingRectangle rectangle_;
};

}  // namespace delf
