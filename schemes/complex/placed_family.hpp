// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/complex/complex.hpp"

namespace delf {

/// Some stencils of one family, up to PlacedFamily::most: their tables, measures and time steps, the values at their
/// vertices, y[i·most + s], and where these lie, t[l·most + s] and x[l·most + s], if the density reads t or x.
struct PlacedBatch {
  int count = 0;
  const std::int32_t* tables;
  const double* measures;
  const double* time_steps;
  const double* y;
  const double* t = nullptr;
  const double* x = nullptr;
};

/// A density on stencils that lie anywhere: a JetFamily whose tables differ from stencil to stencil in their numbers, and
/// not in their form.
///
///     L_Δ = |Δ| Σ_q w_q ℓ(j_q),    j_q = M_q y_Δ,    |Δ|, w_q and M_q of the stencil's own table
///
/// Weights are divided by the power of the stencil's time step that the slot has: φ_t once, φ_tt twice. Those of φ_x are of
/// the coordinates themselves. A gradient of two components is two points, whose φ_x are its components: see
/// schemes/complex/space_tables.hpp. Value l·d + a is component a at vertex l.
///
/// A density that reads t and x does so, at each point, where the point has φ: at the mean of the vertices with the weights
/// of φ; and where the point has derivatives alone, at the mean of the vertices that it reads. A pair of sites in time thus has its
/// middle, a site its own place, and a cell its centroid, or a Gauss point of it: the action is of second order.
class PlacedFamily {
 public:
  static constexpr int most = 64;  ///< stencils at once

  PlacedFamily(std::shared_ptr<const BatchDensity>, int vertices, std::vector<TablePoint> form);

  /// The number of a table. Its slots must have the vertices of the form.
  int add_table(std::span<const TablePoint>);

  const BatchDensity& density() const { return *density_; }
  int vertices() const { return vertices_; }
  int size() const { return vertices_ * d_; }
  /// Which values feel each other, where a site of the complex holds so many of them.
  ComplexShape shape(int values_of_site) const;
  /// ∂r/∂y is proved to be the same at all y: the equations of these stencils are linear.
  bool is_linear() const { return linear_; }
  bool is_placed() const { return density_->is_placed(); }
  /// The equations of the stencils depend on t.
  bool reads_time() const { return reads_time_; }
  /// ∂r/∂y of value m in the equation of value i is not proved to be the same at all y.
  bool is_varying(int i, int m) const { return varying_[static_cast<std::size_t>(i * size() + m)] != 0; }
  /// p, where r ∝ |Δ|/hᵖ and ∂r/∂y ∝ |Δ|/h²ᵖ in the time step h: 1 where jets have φ_t alone, 0 where they do not have
  /// it, and nothing where slots differ in it.
  std::optional<int> time_power() const { return time_power_; }

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
    std::vector<TablePoint::Entry> place = {};  ///< weights of the vertices, where the density is placed
  };
  struct Strip;

  std::shared_ptr<const BatchDensity> density_;
  int vertices_, d_, stride_ = 0;
  std::vector<Point> points_;
  std::vector<double> numbers_;          ///< table by table
  std::vector<char> coupled_, varying_;  ///< [i·size + m]
  std::optional<int> time_power_ = 0;
  bool linear_ = true, reads_time_ = false;
};

}  // namespace delf
