// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "lattice/index.hpp"
#include "lattice/space/mesh_space.hpp"
#include "schemes/complex/complex_system.hpp"
#include "schemes/complex/space_tables.hpp"

namespace delf {

/// A mesh of space and a density on it, with what problems on it have in common.
struct CellSpace : MeshSpace {
  /// `constraint`: of d + m values at a vertex, as a theory declares it. Throws BadInput for a density that has no form on
  /// cells.
  CellSpace(Mesh, std::shared_ptr<const BatchDensity>, bool fixed_boundary,
            std::shared_ptr<const StencilFamily> constraint = nullptr);

  int sites() const { return static_cast<int>(mesh.points.size()); }
  int fields() const { return density->components(); }
  /// m, each with a multiplier.
  int constraints() const { return constraint ? constraint->size() - fields() : 0; }
  /// Values of a row: the fields, point by point; and behind them the multipliers, where there are constraints.
  std::size_t fields_of_row() const { return mesh.points.size() * at(fields()); }
  std::size_t values_of_row() const { return fields_of_row() + multipliers_of_row(); }
  std::size_t multipliers_of_row() const { return mesh.points.size() * at(constraints()); }
  /// use(i, G, ∂G/∂φ) at fields[i·d + a], site after site, and constraint after constraint at a site.
  using UseConstraint = std::function<void(std::size_t i, double G, std::span<const double> slopes)>;
  void each_constraint(std::span<const double> fields, const UseConstraint& use) const;
  /// The largest |G(φ)| of some fields.
  double largest_constraint(std::span<const double> fields) const;

  std::shared_ptr<const BatchDensity> density;
  std::shared_ptr<const StencilFamily>
      constraint;  ///< of d + m values at one vertex, the λ the last of them; null: none
  SpaceTables tables;
  std::vector<double> masses;  ///< A_i
};

/// The mesh alone, for problems without time, by the families of rows (schemes/families/mesh_families.hpp),
///
///     S = Σ_i A_i V(φ_i) + Σ_cells [V(φ, ∇φ) − V(φ, 0)] + Σ_i f_i φ_i,
///
/// f being what flows in at the boundary, and with constraints Σ_i Σ_m λ_im G_m(φ_i) besides: the line search weighs G against
/// forces, which do not shrink with the mesh. Points of the fixed boundary are data. With constraints every value is a site of the
/// complex of its own, since equations of one point are not matched with its own unknowns: those of the fields, point by point, and
/// behind them the multipliers.
ComplexSystem mesh_complex(const CellSpace&);

}  // namespace delf
