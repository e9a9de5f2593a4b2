// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "schemes/families/stencil_family.hpp"

namespace delf {

/// A residual stencil that comes from no Lagrangian, for a wave equation of d components, whose equation is that of the
/// vertex `centre`:
///
///     E = Σ_l (by_xx[l]/k² − by_tt[l]/h² + by_t[l]/h) y_l + Σ weight Q(y_above, y_below),    Q(a, b) = (N(a) − N(b))/(a − b)
///
struct DirectResidual {
  StencilPattern pattern;
  int centre = 0;
  std::vector<double> by_tt, by_xx, by_t;
  struct Quotient {
    int above, below;  ///< vertices; the same one for N′ there
    double weight;
  };
  /// Each the first one moved by some sites: a row of it is evaluated once.
  std::vector<Quotient> quotients;
};

/// A direct residual at every site. Multiplied by hk, so that its size is that of a discrete Lagrangian's gradient.
class ResidualFamily final : public StencilFamily {
 public:
  /// Throws BadInput if the density declares no difference quotient.
  ResidualFamily(DirectResidual, std::shared_ptr<const BatchDensity>);

  using StencilFamily::jacobian;
  using StencilFamily::residual;
  void residual(const StencilBatch&, std::span<const int> equations, double* r) const override;
  void jacobian(const StencilBatch&, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override;
  std::optional<ConstantPart> constant_part(const Cell&) const override;

  const SourceTerms* sources() const override { return &sources_; }
  void evaluate_sources(int group, const JetBatch& inputs, double* const* g) const override;
  void differentiate_sources(int group, const JetBatch& inputs, double* const* d) const override;

 private:
  bool is_linear() const { return density_->nonlinearity() == Nonlinearity::none; }
  /// (by_xx/k² − by_tt/h² + by_t/h) hk at vertex l.
  double linear(const Cell&, int l) const;

  DirectResidual stencil_;
  std::shared_ptr<const BatchDensity> density_;
  int d_;
  SourceTerms sources_;
};

}  // namespace delf
