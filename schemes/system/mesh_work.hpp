// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/system/mesh_energy.hpp"
#include "schemes/system/momenta.hpp"

namespace delf {

/// The work that the boundary of a mesh does on the field, where points follow data g(t) and where something flows in, f(t),
///
///     W = K(ġ)|₀ⁿ − Σ_slabs Σ_nodes ∂S_V/∂y·ġ  +  f·φ|₀ⁿ − Σ_slabs Σ_nodes φ·∂S_ḟ/∂φ
///
/// with K = φ_t ∂T/∂φ_t − T of the driven points, and the terms of the action without φ_t: S_V, and S_ḟ = ∫ ḟ·φ dt. Both sums are
/// the scheme's own quadrature of ∫ ∂V/∂y·ġ dt and of ∫ ḟ·φ dt. The energy less W stays, as far as the scheme keeps energies at
/// all.
class MeshWork {
 public:
  /// A system on a mesh, whose first family is that of the sites.
  MeshWork(const LatticeSystem&, std::shared_ptr<const BatchDensity>);

  /// Rows n − 1 and n.
  void add(const Window&);
  /// From row 0 to row n, or to the row before it.
  double sum() const { return sum_; }
  double sum_before() const { return before_; }
  /// ġ in the place of what rates [i·d + a] have at driven points.
  void give_rates(std::span<double> rates, double t) const;

  /// SavedState, of a room above this one.
  template <class State>
  void visit(State& state) {
    state("work of the boundary", sum_), state("work before", before_), state("work of quadrature", integral_);
    state("terms of row 0", first_), state("begun", begun_);
  }

 private:
  struct Forces {
    Forces(LatticeSystem system_)
        : system(std::move(system_)), above(system, Side::above, 0), below(system, Side::below, 0) {}
    LatticeSystem system;
    HalfEquations above, below;
  };
  std::unique_ptr<const Forces> forces(const std::vector<std::shared_ptr<const StencilFamily>>&) const;
  /// Σ_nodes weight · ∂S/∂y over the slab between two rows.
  template <class Weight>
  double slab(const Forces&, const Window&, const Weight&) const;
  /// K(ġ) + f·φ
  double terms(std::span<const double> row, double t) const;
  std::vector<double> on_patch(std::span<const double> row) const;

  const LatticeSystem& system_;
  const MeshSpace& space_;
  MeshSpace patch_;                   ///< the driven points with the cells around them, and those of a flux
  std::vector<std::int32_t> points_;  ///< of the mesh, by their numbers in the patch
  std::vector<MeshSpace::AtPoint> driven_, fluxes_;  ///< in the patch
  std::unique_ptr<const Forces> potential_, flux_rates_;
  std::optional<MeshEnergy> energy_;
  double sum_ = 0, before_ = 0, integral_ = 0;
  double first_ = 0;  ///< the terms of row 0
  bool begun_ = false;
};

}  // namespace delf
