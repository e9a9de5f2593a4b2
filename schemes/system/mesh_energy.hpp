// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "lattice/space/mesh_space.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The energy of one row of a mesh, with the lumped masses A_i of its points,
///
///     E = Σ_i A_i [φ_t·∂ℓ/∂φ_t − ℓ](φ_i, φ_t,i) − Σ_cells [V(φ, ∇φ) − V(φ, 0)],
///
/// for densities ℓ = T(φ_t) + V(φ, ∇φ).
class MeshEnergy {
 public:
  MeshEnergy(std::shared_ptr<const BatchDensity>, const MeshSpace&);

  /// The energy of fields and their rates, both [i·d + a], at a time.
  double operator()(std::span<const double> values, std::span<const double> rates, double t) const;
  /// At the half step between two rows, with the rates (y − before)/h that join them: the mean of both rows' energies. It is
  /// what the rows of the usual method keep.
  double between(std::span<const double> before, std::span<const double> y, double h, double t) const;
  /// The rates of momenta p_i = A_i ∂ℓ/∂φ_t, [i·d + a]; not numbers where there are none.
  std::vector<double> rates(std::span<const double> values, std::span<const double> momenta, double t) const;

 private:
  double of_cells(std::span<const double> values, double t) const;

  std::shared_ptr<const BatchDensity> density_;
  std::vector<double> masses_, places_;  ///< A_i, x_i
  std::vector<std::shared_ptr<const StencilFamily>> cells_;
};

}  // namespace delf
