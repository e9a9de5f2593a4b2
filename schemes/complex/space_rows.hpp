// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "lattice/index.hpp"
#include "lattice/space/mesh_space.hpp"
#include "schemes/complex/complex_system.hpp"
#include "schemes/complex/space_tables.hpp"

namespace delf {

/// A mesh of space and a density on it, with what rows of any steps have in common.
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

/// The sites of the mesh at some times, row after row: site i of row j has the number j·N + i. Stencils of motion join rows;
/// those of sites and cells lie in a row, and have the mean of the steps below and above it,
///
///     S = Σ_j Σ_i A_i h_j T((y_i^{j+1} − y_i^j)/h_j) + Σ_j ½(h_{j−1} + h_j) V(y^j),
///
/// where the first and the last row have half a step. Rows 0 and 1 are data, and equations hold from row 1 to the last but
/// one.
///
/// With constraints V has A_i Σ_m λ_i,m G_m(y_i) besides. Then every value is a site of the complex of its own, since equations of
/// one point are not matched with its own unknowns: G(y^{j+1}) = 0 and the equations of y^j determine y^{j+1} and λ^j
/// together. This is SHAKE on a mesh (Ryckaert, Ciccotti, Berendsen, J. Comput. Phys. 23, 327, 1977).
class SpaceRows {
 public:
  SpaceRows(const CellSpace&, std::span<const double> times);
  /// The mesh alone, for problems without time: S = Σ V(y), data on the fixed boundary.
  explicit SpaceRows(const CellSpace&);

  const ComplexSystem& system() const { return system_; }
  int rows() const { return rows_; }
  /// Rows of fields alone with the multipliers that fit their equations best, 0 where none holds: the components of E along
  /// ∂G/∂φ are zero.
  std::vector<double> with_multipliers(std::span<const double> fields) const;
  /// The same with these, [(row·sites + i)·m + b].
  std::vector<double> with_multipliers(std::span<const double> fields, std::span<const double> multipliers) const;

 private:
  /// A row at a time, whose stencils have this measure.
  void add_row(double t, double measure);
  /// The point that a value of a row belongs to.
  int point_of(int value) const;
  /// A_i; or 1 without time, where the line search weighs G against forces, which do not shrink with the mesh.
  double weight_of_constraint(int point) const;
  /// The sites of the complex that hold the fields of some points, one after the other.
  std::span<const int> sites_of(std::initializer_list<int> rows, std::span<const std::int32_t> points);

  const CellSpace& space_;
  int per_point_, per_row_;  ///< sites of the complex: of the fields of a point, and of a row
  bool is_still_ = false;    ///< without time
  ComplexSystem system_;
  int rows_ = 0;
  int site_ = 0, constraint_ = 0, motion_ = 0;
  std::vector<int> flux_;  ///< families of ℓ = φ_a, by field
  std::vector<int> sites_;
  std::vector<int> gradient_;         ///< family by number of corners
  std::vector<int> gradient_tables_;  ///< by cell
  std::vector<double> measures_;      ///< of the stencils of each row
};

}  // namespace delf
