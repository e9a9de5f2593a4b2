// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "jets/batch_density.hpp"

namespace delf {

/// ℓ̃(j) = ℓ(j + c) with a constant jet c, c[slot·d + a]: what a point of an action reads beside the values of its stencil, as
/// at a wall whose slope is kept.
class ShiftedDensity final : public BatchDensity {
 public:
  ShiftedDensity(std::shared_ptr<const BatchDensity> of, std::vector<double> by);

  void value(const JetBatch&, double* l) const override;
  void gradient(const JetBatch&, double* const* g, double* l = nullptr) const override;
  void hessian(const JetBatch&, double* const* H) const override;
  void slope(const JetBatch& phi, double* const* g) const override;
  void curvature(const JetBatch& phi, double* const* d) const override;
  void place_gradient(const JetBatch&, double* l_t, double* l_x) const override;

 private:
  struct Inner;

  std::shared_ptr<const BatchDensity> of_;
  std::vector<double> by_;
};

}  // namespace delf
