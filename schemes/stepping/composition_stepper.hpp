// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jets/force_squared.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "schemes/stepping/step_method.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Steps an element whose nodes form rows above each other, each determined explicitly by the two before: a composition of
/// sub-steps over pairs of sites. With P_s = −c_s (y_{s+1} − y_s), the momenta that a sub-step hands on,
///
///     P_s = P_{s−1} + Σ_m g_m (y_s(i + m) − 2y_s(i) + y_s(i − m)) + b_s ∂ℓ/∂φ(y_s),     y_{s+1} = y_s − P_s/c_s,
///
/// where all numbers come from the constant part of the element's Jacobian. A second family, the squares of the force at
/// node 0, adds its gradient there. Where rows are those of a kernel, its processor gives the first one, and is undone on
/// copies of rows that are observed. A step that no one looks at writes rows over
/// each other; one that is checked keeps those between its sub-steps.
///
/// On an interval the families with the placement of a mirror say that the field goes on beyond the walls as its mirror image:
/// steps take the equations of the first family everywhere, and halos are mirror images.
class CompositionStepper final : public StepMethod {
 public:
  /// Nothing if the equations are not of this kind.
  static std::unique_ptr<CompositionStepper> make(const LatticeSystem&, const StepOptions&);

  /// Throws BadInput where there are rows between the sub-steps: they follow from momenta alone.
  void start(const std::vector<std::vector<double>>& rows) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  void step(bool looked_at) override;

  StepState state() const override { return {.newest = n_, .held = known_ + 1}; }
  std::vector<double> row(int back) const override;
  Window window(int rows) const override;
  void observe(int back, std::vector<double>& fields, std::vector<double>* rates) const override;
  double residual() const override;

  StepReport report(bool residual) const override;
  void visit(SavedState&) override;

 private:
  /// One sub-step from the row of a node.
  struct SubStep {
    std::vector<double> linear;     ///< Σ_{m > j} g_m / K at [a · reach + j]
    std::vector<double> nonlinear;  ///< b / K
    double stride = 0;              ///< −K / c
    double time = 0;                ///< of the row, from that of the step
    double gradient = 0;            ///< times that of the squared force
  };
  /// The squares of the force at node 0: their density, and what the sites m apart weigh in φ_xx.
  struct ForceGradient {
    const ForceSquared* density = nullptr;
    std::vector<double> weights, sums;  ///< w_m/k² at [m − 1]; Σ_{m > j} w_m/k² at [j]
    double kick = 0;                    ///< hk/K
  };

  CompositionStepper(const LatticeSystem&, const StepOptions&);
  /// False where an equation is not of the form above.
  bool assemble();
  SubStep read_sub_step(int s, bool from_below, bool& fits) const;
  void find_mirrors();
  void mirror_differences(double* D) const;
  void hold_walls(double* y, double* differences, double* velocity, int a) const;
  static std::optional<ForceGradient> read_gradient(const StencilFamily& of, const StencilFamily&, double k);
  void prepare_processor();
  void add_gradient(std::int64_t n, const SubStep&, const double* from, const double* differences,
                    double* velocity) const;
  void undo_processor(std::int64_t n, bool with_rates) const;
  double sub_step(std::int64_t n, const SubStep&, const double* from, const double* differences, double* to,
                  double* next_differences, double* velocity) const;
  void find_differences(const double* row, double* differences) const;
  double* newest_row() { return newest_.row(0); }
  const double* newest_row() const { return newest_.row(0); }
  double advance(const SubStep& first, bool looked_at);
  /// A row of y has a halo of one pack.
  void fill_ends(double* row) const {
    ends_.fill_halo(row + static_cast<std::ptrdiff_t>(layout_.halo() - 1) * lanes, options_.monodromy);
  }
  double* node(std::int64_t row, int s) { return slabs_.row(static_cast<int>(row % slabs_held) * S_ + s); }
  const double* node(std::int64_t row, int s) const { return slabs_.row(static_cast<int>(row % slabs_held) * S_ + s); }
  void copy_components(const double* rows, int first_component, std::vector<double>& section) const;
  void set(RowBuffer& rows, const std::vector<double>& section, double monodromy);
  void save();
  [[noreturn]] void fail();
  /// The number of rows to work out the residual in, which those of a slab no longer held do not give.
  int scratch_rows() const { return S_ < 3 ? 3 - S_ : 0; }
  void require(int slabs) const;

  /// A slot of a halo that repeats another one, or its opposite.
  struct Image {
    int to, from;
    double sign;
  };

  static constexpr int slabs_held = 4;
  const LatticeSystem& system_;
  StepOptions options_;
  const StencilFamily& family_;
  ForceGradient gradient_;  ///< without a density where there is none
  int d_, S_, reach_;
  double scale_ = 1;         ///< K: velocities are P/K
  RowLayout layout_, ends_;  ///< with the halo of differences, and of rows: one pack
  std::size_t size_;         ///< of a row of d components
  // The images of differences and of values beyond an interval, slots of fixed walls with values, natural walls.
  std::vector<Image> differences_beyond_, values_beyond_;
  struct Held {
    int slot;
    std::vector<double> value;
  };
  /// D of a wall and its neighbour.
  struct AtWall {
    int slot, above, below;
  };
  std::vector<AtWall> differences_at_walls_;
  std::vector<Held> held_;
  std::vector<int> natural_;
  // Room of a sub-step: where its strip begins, where a gradient goes, the last values of the strip before.
  mutable std::vector<const double*> now_;
  mutable std::vector<double*> out_;
  mutable std::vector<Pack> before_;
  std::vector<SubStep> steps_;
  SubStep first_;                        ///< from row 0, with nothing below
  std::vector<SubStep> process_, undo_;  ///< of the processor
  RowBuffer positions_;
  // Each "row" has the rows of its d components one after the other.
  RowBuffer newest_, velocity_;    ///< y_n; P/K of the sub-step before it
  mutable RowBuffer differences_;  ///< of y_n to its neighbours, and others, by turns
  int at_ = 0;                     ///< which are those of y_n
  mutable RowBuffer slabs_;        ///< of the newest steps: S nodes each; the oldest is room to work in
  RowBuffer saved_;                ///< y and P/K, now and then: a row that overflows is found again from there
  mutable RowBuffer scratch_;      ///< of the residual, where S nodes are too few
  mutable RowBuffer squares_;      ///< ∂ℓ̃/∂φ, ∂ℓ̃/∂φ_xx of the squared force, and ∂ℓ/∂φ
  mutable RowBuffer observed_;     ///< a row to be observed: y and P/K
  mutable RowBuffer observed_differences_;
  std::int64_t n_ = 0, saved_row_ = -1;
  int known_ = 0;  ///< newest slabs that are held
};

}  // namespace delf
