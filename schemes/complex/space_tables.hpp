// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/tables/cell_points.hpp"
#include "lattice/space/mesh.hpp"
#include "schemes/complex/complex_system.hpp"

namespace delf {

/// A density of one coordinate of space on cells of any dimension. ℓ must be T(φ_t) + V(φ, ∇φ), and quadratic in ∇φ, so
/// that in coordinates x_a
///
///     ℓ(φ, φ_t, ∇φ) = ℓ(0, φ_t, 0) + ℓ(φ, 0, 0) + Σ_a [ℓ(φ, 0, ∂_aφ) − ℓ(φ, 0, 0)]
///
/// (up to ℓ(0, 0, 0), which no equation contains). Each term is a kind of stencil:
///
///     motion     2 sites, one after the other in time: T
///     site       1 site, with its share of the cells around it: V without gradient
///     gradient   the corners of a cell: V's gradient; linear or bilinear in the cell (P1, Q1)
///
/// Motion and sites have the lumped masses A_i = Σ_cells ∫ N_i of a mesh. Where φ and ∇φ are not coupled, φ is left out of
/// the gradient's jets, and its equations are linear.
class SpaceTables {
 public:
  /// Throws BadInput "theory.name" for a density of another form.
  explicit SpaceTables(std::shared_ptr<const BatchDensity>);

  ComplexSystem::Family motion() const;
  ComplexSystem::Family site() const;
  ComplexSystem::Family gradient(int corners) const;

  /// With the measure of the cell in its weights.
  std::vector<TablePoint> gradient_table(const Mesh& mesh, int cell) const {
    return delf::gradient_table(mesh, cell, coupled_);
  }
  /// The potential of a cell, its sites and gradient in one: for cells with a time step of their own.
  std::vector<TablePoint> cell_table(const Mesh& mesh, int cell) const {
    return delf::cell_table(mesh, cell, coupled_);
  }
  ComplexSystem::Family cell(int corners) const;

 private:
  std::vector<TablePoint> motion_table() const;
  std::vector<TablePoint> site_table() const;

  std::shared_ptr<const BatchDensity> density_;
  bool coupled_;  ///< φ and ∇φ
};

}  // namespace delf
