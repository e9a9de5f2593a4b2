// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/complex/complex.hpp"

namespace delf {

/// Some stencils of one family, up to PlacedFamily::most: their tables, measures and time steps, and the values at their
/// vertices, y[i·most + s].
struct PlacedBatch {
  int count = 0;
  const std::int32_t* tables;
  const double* measures;
  const double* time_steps;
  const double* y;
};

/// A density on stencils that lie anywhere: a JetFamily whose tables differ from stencil to stencil in their numbers, and
/// not in their form.
///
///     L_Δ = |Δ| Σ_q w_q ℓ(j_q),    j_q = M_q y_Δ,    |Δ|, w_q and M_q of the stencil's own table
///
/// Weights of φ_t are divided by the stencil's time step; those of φ_x are of the coordinates themselves. A gradient of two
/// components is two points, whose φ_x are its components: see schemes/complex/space_tables.hpp. Value l·d + a is component
/// a at vertex l.
class PlacedFamily {
 public:
  static constexpr int most = 64;  ///< stencils at once

  PlacedFamily(std::shared_ptr<const BatchDensity>, int vertices, std::vector<TablePoint> form);

  /// The number of a table. Its slots must have the vertices of the form.
  int add_table(std::span<const TablePoint>);

  const BatchDensity& density() const { return *density_; }
  int vertices() const { return vertices_; }
  int size() const { return vertices_ * d_; }
  /// Which vertices feel each other.
  const ComplexShape& shape() const { return shape_; }
  /// ∂r/∂y is proved to be the same at all y: the equations of these stencils are linear.
  bool is_linear() const { return linear_; }
  /// ∂r/∂y of vertex m in the equation of vertex l is not proved to be the same at all y.
  bool is_varying(int l, int m) const { return varying_[static_cast<std::size_t>(l * vertices_ + m)] != 0; }

  void lagrangian(const PlacedBatch&, double* L) const;
  /// r[i·most + s] = ∂L/∂yⁱ
  void residual(const PlacedBatch&, double* r) const;
  /// J[(i·size + m)·most + s]
  void jacobian(const PlacedBatch&, double* J) const;
  /// Σ φ_t ∂ℓ/∂φ_t − ℓ of each stencil, with its measure and weights.
  void energy(const PlacedBatch&, double* E) const;

 private:
  struct Entry {
    int slot, vertex, number;  ///< where its weight stands in a table
  };
  struct Point {
    int number;  ///< of its weight
    std::vector<Entry> entries;
  };
  struct Strip;

  std::shared_ptr<const BatchDensity> density_;
  int vertices_, d_, stride_ = 0;
  std::vector<Point> points_;
  std::vector<double> numbers_;  ///< table by table
  ComplexShape shape_;
  std::vector<char> varying_;  ///< [l·vertices + m]
  bool linear_ = true;
};

}  // namespace delf
