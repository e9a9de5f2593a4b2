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
/// a lumped kinetic term alone. With h_s the step of the slab that node s lies in, and h the step that M, K, c and w are of,
///
///     S = Σ_s (h/h_s) ½ (y_{s+1} − y_s)ᵀ M_s (y_{s+1} − y_s) + Σ_s (h_s/h) [½ y_sᵀ K_s y_s + c_sᵀ y_s + Σ_i w_{s,i} N(y_{s,i})]
///
///     kick     P ← P + (h_s/h) (K_s y_s + c_s + w_s N′(y_s))   ∂S/∂y_s = 0, with P = M_{s−1} (y_s − y_{s−1}) h/h_{s−1} before it
///     drift    y_{s+1} = y_s + (h_s/h) M_s⁻¹ P
///
/// with M diagonal, K a sparse matrix and N′ a function of t and x too, if the density reads them. A row has the kicks of the slabs
/// below it and above it, at once where these are alike: (h_s/h) is then the mean of both slabs'. All of it comes from the constant
/// parts and the source terms of the families.
class KickStepper final : public StepMethod {
 public:
  /// Returns null if the equations are of another kind.
  static std::unique_ptr<StepMethod> make(const LatticeSystem&, const SolvePlan&, const StepOptions&);

  void start(const std::vector<std::vector<double>>& rows) override;
  void start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  void step(bool) override;

  StepState state() const override { return {newest_, 0, Continued::no, held_}; }
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
    Packs x;        ///< of the sites, where the density reads it: the family's own numbers
    /// Where the family is of some sites alone: these, to whole packs, and weights and x are theirs. Empty: of all.
    std::vector<std::int32_t> sites;
  };
  /// The kick of the values at a node, y[a·padded + i], a field after the other.
  struct Kick {
    /// Of each pack of rows of K its entries, and the end. An entry has a value for each lane: of neighbouring places from
    /// `column` on, or where that is negative, of those that are listed from ~column on.
    std::vector<std::int32_t> first, column, listed;
    Packs value;
    Packs constant;  ///< none if all are zero
    std::vector<Source> sources;
  };
  /// Values are y + low.
  struct Node {
    Packs y, low;
  };
  struct Parts;

  KickStepper(const LatticeSystem&, const StepOptions&, Parts);
  static std::size_t bytes_of(const Kick&);
  Node& node(std::int64_t row, int node) { return ring_[index(row, node)]; }
  const Node& node(std::int64_t row, int node) const { return ring_[index(row, node)]; }
  std::size_t index(std::int64_t row, int node) const;
  /// At node n of the newest row, `kick` and `drift` times what they are in a step h, to the next node.
  void kick_and_drift(const Kick&, int n, double kick, double drift, double t, Node& next);
  void kick_some(const Source&, double of_kick, double t, const double* from, double* P) const;
  void read(const std::vector<double>& row, Packs& y) const;
  /// The values at a time of the points that are driven.
  void set_driven(double t, Node&) const;
  void take_slab(const Kick& first, double share_below);
  /// A row, or row 0 for those before it, [i·C + c], with the nodes above the row so many `behind` it; or the low parts of both.
  std::vector<double> row_of(std::int64_t row, int behind, bool low) const;

  const LatticeSystem& system_;
  double monodromy_, tolerance_;
  int max_iterations_;
  int fields_, nodes_, padded_;        ///< nodes of a slab but the last; sites to whole packs
  std::vector<int> behind_;            ///< rows that the newest of a component is below the newest row
  Kick alone_;                         ///< of row 0, which has no slab below it
  std::vector<Kick> kicks_;            ///< of each node: at a row those of both slabs
  std::vector<Packs> inverse_;         ///< M_s⁻¹; 0 where values are data
  std::vector<Node> ring_;             ///< rows with the nodes above them
  std::vector<int> slots_;             ///< where the newest row stands in the ring, and those before it
  Packs momentum_;                     ///< P
  std::vector<const double*> inputs_;  ///< of a source, in kick_and_drift()
  Pack largest_;
  std::int64_t newest_ = -1;
  int held_ = 0;  ///< rows that are there
};

}  // namespace delf
