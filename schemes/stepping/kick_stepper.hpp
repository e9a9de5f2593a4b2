// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "jets/simd/pack.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "schemes/stepping/step_method.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Steps a mesh, or mechanics, whose slab is a chain of nodes in time (rows, and the sub-steps between them) that are joined by
/// a lumped kinetic term alone:
///
///     S = Σ_s ½ (y_{s+1} − y_s)ᵀ M_s (y_{s+1} − y_s) + Σ_s [½ y_sᵀ K_s y_s + c_sᵀ y_s + Σ_i w_{s,i} N(y_{s,i})]
///
///     kick     P ← P + K_s y_s + c_s + w_s N′(y_s)            ∂S/∂y_s = 0, with P = M_{s−1} (y_s − y_{s−1}) before it
///     drift    y_{s+1} = y_s + M_s⁻¹ P
///
/// with M diagonal. K is a sparse matrix, and that of a row is the sum of those of the slabs below it and above it. All of it
/// comes from the constant parts and the source terms of the families.
class KickStepper final : public StepMethod {
 public:
  /// Null where the equations are of another kind.
  static std::unique_ptr<StepMethod> make(const LatticeSystem&, const SolvePlan&, const StepOptions&);

  void start(const std::vector<std::vector<double>>& rows) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  void step(bool looked_at) override;

  StepState state() const override { return {newest_, 0, Continued::no}; }
  std::vector<double> row(int back) const override;
  Window window(int rows) const override;
  double residual() const override;
  StepReport report(bool residual) const override;
  void visit(SavedState&) override;

 private:
  using Packs = std::vector<Pack>;
  /// w N′ of a node: the functions of one group of a family.
  struct Source {
    const StencilFamily* family;
    int group;
    Packs weights;  ///< as the values of a node
  };
  /// Of the values at a node: y[a·padded + i], a field after the other.
  struct Kick {
    std::vector<std::int32_t> first, column;  ///< of the rows of K, and the end
    std::vector<double> value;
    Packs constant;
    std::vector<Source> sources;
  };
  struct Parts;

  KickStepper(const LatticeSystem&, const SolvePlan&, const StepOptions&, Parts);
  static Kick sum(const Kick&, const Kick&);
  static std::size_t bytes_of(const Kick&);
  void kick_and_drift(const Kick&, int node);
  void read(const std::vector<double>& row, Packs& y) const;
  void take_slab(const Kick& first);
  void keep(std::int64_t row, int node);
  std::vector<double>& ring(std::int64_t row) { return rows_[static_cast<std::size_t>(row) % rows_.size()]; }
  const std::vector<double>& ring(std::int64_t row) const { return rows_[static_cast<std::size_t>(row) % rows_.size()]; }

  const LatticeSystem& system_;
  double turn_;
  int fields_, nodes_, padded_;      ///< nodes of a slab but the last; sites to whole packs
  std::vector<int> behind_;          ///< rows that the newest of a component is below the newest row
  Kick alone_;                       ///< of row 0, which has no slab below it
  std::vector<Kick> kicks_;          ///< of each node: at a row those of both slabs
  std::vector<Packs> inverse_;       ///< M_s⁻¹; 0 where values are data
  std::vector<Packs> y_, low_;       ///< of the nodes of a slab, the last one too: values are y + low
  Packs momentum_;                   ///< P
  std::vector<const double*> inputs_;  ///< of a source, in kick_and_drift()
  Pack largest_;
  std::vector<std::vector<double>> low_rows_;  ///< what rounding has taken from rows_
  std::vector<std::vector<double>> rows_;  ///< a ring of the newest, [i·C + c]; nodes inside a slab are with the row below
  std::int64_t newest_ = -1;
};

}  // namespace delf
