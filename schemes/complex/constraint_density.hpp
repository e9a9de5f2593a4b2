// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <memory>
#include <span>

#include "jets/batch_density.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The constraint of a theory, L = λ G(φ) on one vertex, as a density of its d fields and λ: what a PlacedFamily takes.
class ConstraintDensity final : public BatchDensity {
 public:
  /// Of d + 1 values at one vertex, λ the last of them: see VertexConstraint.
  explicit ConstraintDensity(std::shared_ptr<const StencilFamily>);

  void value(const JetBatch&, double* l) const override;
  void gradient(const JetBatch&, double* const* g, double* l = nullptr) const override;
  void hessian(const JetBatch&, double* const* H) const override;
  void slope(const JetBatch& phi, double* const* g) const override;
  void curvature(const JetBatch& phi, double* const* d) const override;
  void place_gradient(const JetBatch&, double* l_t, double* l_x) const override;

  /// use(i, G, ∂G/∂φ) at fields[i·d + a], site after site.
  using Use = std::function<void(std::size_t i, double G, std::span<const double> slopes)>;
  void each(std::span<const double> fields, const Use&) const;

 private:
  std::shared_ptr<const StencilFamily> family_;
};

}  // namespace delf
