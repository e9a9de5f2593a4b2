// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "lattice/index.hpp"
#include "schemes/families/stencil_family.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// A planted fault which every check has to find: a family in which the residual of one value, and its row of the
/// Jacobian with it, has the wrong sign. The Lagrangian is left alone, and the family still says that it is
/// variational. There is no row kernel, so that nothing goes past the fault.
class WrongSign final : public StencilFamily {
 public:
  WrongSign(std::shared_ptr<const StencilFamily> right, int value)
      : StencilFamily(right->pattern(), right->values(), right->is_variational()),
        right_(std::move(right)),
        value_(at(value)) {
    placed_ = right_->is_placed();
    if (right_->listed() != nullptr) listed_ = {right_, right_->listed()};
  }

  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    right_->residual(cell, y, r);
    r[value_] = -r[value_];
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    right_->jacobian(cell, y, J);
    for (double& entry : J.subspan(value_ * y.size(), y.size())) entry = -entry;
  }
  std::optional<double> lagrangian(const Cell& cell, std::span<const double> y) const override {
    return right_->lagrangian(cell, y);
  }

 private:
  std::shared_ptr<const StencilFamily> right_;
  std::size_t value_;
};

/// A system with such a fault in its first family; in every family of several values where stencils do not repeat, so that
/// every region has one.
std::unique_ptr<LatticeSystem> with_wrong_sign(const LatticeSystem&);

}  // namespace delf
