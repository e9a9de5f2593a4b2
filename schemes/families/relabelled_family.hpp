// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "schemes/families/stencil_family.hpp"

namespace delf {

/// A family on other components: component c of the given one is `components[c]` here. A constraint of the fields, say, at
/// a node inside the cell.
class RelabelledFamily final : public StencilFamily {
 public:
  RelabelledFamily(std::shared_ptr<const StencilFamily> family, const std::vector<int>& components)
      : StencilFamily(family->pattern(), family->values(), family->is_variational()), family_(std::move(family)) {
    for (VertexValue& value : values_) value.component = components[static_cast<std::size_t>(value.component)];
    for (int i = 0; i < size(); ++i) varied_.push_back(family_->is_varied(i));
    placed_ = family_->is_placed();
  }

  void residual(const StencilBatch& batch, std::span<const int> equations, double* r) const override {
    family_->residual(batch, equations, r);
  }
  void jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override {
    family_->jacobian(batch, equations, unknowns, J);
  }
  bool lagrangian(const StencilBatch& batch, double* L) const override { return family_->lagrangian(batch, L); }
  std::optional<ConstantPart> constant_part(const Cell& cell) const override { return family_->constant_part(cell); }
  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    family_->residual(cell, y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    family_->jacobian(cell, y, J);
  }
  std::optional<double> lagrangian(const Cell& cell, std::span<const double> y) const override {
    return family_->lagrangian(cell, y);
  }

 private:
  std::shared_ptr<const StencilFamily> family_;
};

}  // namespace delf
