// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/SparseCore>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "lattice/matrix_entry.hpp"
#include "schemes/system/energy_momentum.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The Legendre transform of a row. Over the quadrature of the lower sides of elements a row is mechanics,
///
///     L(y, v) = k Σ w ℓ(φ, φ_t, φ_x),  φ_t = Σ φ_b v_b,     p = ∂L/∂v,     H = p·v − L,     P = −k Σ w φ_x ∂ℓ/∂φ_t
///
/// Where values are bound, Σ ∂G/∂y v = 0 or the rate of the bond holds too: a constraint of the theory at the sites, or the
/// one that a mesh follows. Momenta are then known up to forces: those of the bonds, −∂Gᵀ/∂y μ, or, for values that are
/// slaved, any force on the value that each bond is the equation of. Rows are [i·C + c]; v is 0 at fixed walls, and ḟ at driven
/// ones, whose p·ḟ is part of H.
class LegendreTransform {
 public:
  /// A row of a system: the families whose tables have a lower side, or the row of its mesh that moves.
  LegendreTransform(const LatticeSystem&, const Window&, std::int64_t row);
  /// Points of space, each on its own, where φ_x = 0: q[point·d + a].
  LegendreTransform(const BatchDensity&, std::span<const double> q, double t);

  /// The system has elements, whose lower side a row is.
  bool has_row() const { return !parts_.empty(); }
  std::vector<double> momenta(std::span<const double> v) const;
  /// The velocities of given momenta, found by Newton's method from v = 0 with the mass matrix ∂²L/∂v∂v; nothing where
  /// it is singular, or does not converge.
  std::optional<std::vector<double>> velocities(std::span<const double> p) const;
  /// H and P of given momenta; not a number where they have no velocities. Where ℓ is linear in φ_t, H does not depend
  /// on v, and none is needed.
  EnergyMomentum energy(std::span<const double> p) const;
  /// Σ (∂L/∂v − p) ḟ over the driven walls, of the momenta p of what lies below the row: what their forces do at it.
  double work_in_row(std::span<const double> p) const;

 private:
  using Vector = Eigen::VectorXd;
  using Sparse = Eigen::SparseMatrix<double>;
  struct VelocityEquations;
  /// The cells of one family: the values at their lower sides, and the velocities that are unknown.
  struct Part {
    const BatchDensity* density;
    std::span<const TablePoint> points;
    int values;                     ///< of a cell
    std::vector<int> unknown = {};  ///< −1: held; −2 − n: as rates_[n] says
    std::vector<double> y = {};
    /// Of each point, cell by cell.
    struct AtPoint {
      std::vector<double> weight, x;
    };
    std::vector<AtPoint> own = {};
    int cells() const { return static_cast<int>(own.front().weight.size()); }
  };
  struct Bonds {
    std::vector<MatrixEntry> entries =
        {};  ///< rows and columns are places, the row that of the value it is the equation of
    bool slaved = false;
    std::map<int, double> rates = {};  ///< their right sides, by row; 0 where there is none
  };
  struct BoundRows;

  void add_part(const StencilFamily&, const LatticeSystem&, const Window&, std::int64_t row, std::vector<int>& number);
  void bind(const StencilFamily&, int equation, const LatticeSystem&, const Window&, std::int64_t row);
  void bind_delayed(const MeshConstraint&, const LatticeSystem&, const Window&, std::int64_t row);
  /// ∂L/∂v, and ∂²L/∂v∂v if it is asked for.
  Vector momenta(const Vector& v, Sparse* mass) const;
  std::optional<Vector> velocities(const Vector& wanted) const;
  Vector on_unknowns(std::span<const double> row) const;
  std::vector<double> on_row(const Vector&) const;
  bool is_linear() const;
  template <class Visit>
  void each_point(const Part&, const Vector& v, const Visit&) const;
  /// Σ ∂L/∂v ḟ over the driven walls.
  double given_at(const Vector& v) const;

  double k_ = 1, t_ = 0;
  std::size_t size_;  ///< of a row
  std::vector<Part> parts_;
  std::vector<int> places_;  ///< of the unknowns in a row
  std::vector<int> driven_;  ///< places of the values that driven walls give
  std::vector<double> rates_;
  Bonds bonds_;
};

/// ∂ℓ/∂q̇(q, q̇) = p at points of space, [point·d + a]; nothing where there is no such q̇.
std::optional<std::vector<double>> velocity_of(const BatchDensity&, std::span<const double> q,
                                               std::span<const double> p, double t = 0);
/// H(q, p) = p·q̇ − ℓ(q, q̇), summed over them; not a number where there is no q̇.
double hamiltonian(const BatchDensity&, std::span<const double> q, std::span<const double> p, double t = 0);

}  // namespace delf
