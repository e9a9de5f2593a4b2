// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/space/mesh_space.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// What flows in at points, as a density of what they hold, ℓ = Σ_a f_a(t) φ_a, with an f for each point: the place x of a
/// jet is the number of its point. Of one point alone, or with the same f for all, x is not read.
class FluxDensity final : public BatchDensity {
 public:
  FluxDensity(std::vector<std::shared_ptr<const GivenInTime>> fluxes, int components);

  void value(const JetBatch&, double* l) const override;
  void gradient(const JetBatch&, double* const* g, double* l = nullptr) const override;
  void hessian(const JetBatch&, double* const* H) const override;
  void slope(const JetBatch& phi, double* const* g) const override;
  void curvature(const JetBatch& phi, double* const* d) const override;
  void place_gradient(const JetBatch&, double* l_t, double* l_x) const override;

 private:
  const GivenInTime& at_place(const JetBatch&, int i) const;

  std::vector<std::shared_ptr<const GivenInTime>> fluxes_;
};

/// The fluxes of a mesh by a table of time, with one stencil at each of their points; null: nothing flows in.
std::shared_ptr<const StencilFamily> boundary_flux(const StencilTable& time, int components, int sites,
                                                   std::span<const MeshSpace::AtPoint> fluxes);

}  // namespace delf
