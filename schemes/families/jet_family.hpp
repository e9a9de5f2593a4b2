// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "jets/simd/pack.hpp"
#include "jets/tables/density_on_table.hpp"
#include "schemes/families/own_weights.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// A density on every stencil of the lattice, its jets by a table:
///
///     L_Δ = |Δ| Σ_q w_q ℓ(j_q),    j_q = M_q y_Δ
///     ∂L/∂y = |Δ| Σ_q w_q M_qᵀ ∂ℓ/∂j(j_q),    ∂²L/∂y∂y = |Δ| Σ_q w_q M_qᵀ ∂²ℓ/∂j∂j(j_q) M_q
///
/// Stencils of sites, elements with nodes inside and the sub-steps of a composition alike: value l·d + a is component
/// node·d + a of the section at vertex l. A table with tests N_q has N_qᵀ in the place of the left M_qᵀ, and no L. Where
/// stencils are listed, w_q and M_q have numbers of each stencil's own as factors.
class JetFamily final : public StencilFamily {
 public:
  /// A linear ∂ℓ/∂φ is part of the constant part, or a source term if `values_are_sources`.
  JetFamily(StencilTable, std::shared_ptr<const BatchDensity>, bool values_are_sources = false, OwnWeights = {});

  const DensityOnTable* made_of() const override { return &of_; }

  using StencilFamily::jacobian;
  using StencilFamily::lagrangian;
  using StencilFamily::residual;
  void residual(const StencilBatch&, std::span<const int> equations, double* r) const override;
  void jacobian(const StencilBatch&, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override;
  bool lagrangian(const StencilBatch&, double* L) const override;
  /// |Δ| Σ_q w_q (φ_t ∂ℓ/∂φ_t − ℓ)
  void energy(const StencilBatch&, double* E) const;
  bool is_constant(int i, int m) const override;
  std::optional<ConstantPart> constant_part(const Cell&) const override;

  const SourceTerms* sources() const override;
  double own_number(int number, int stencil) const override {
    return number < 0 ? 1 : own_.numbers[number][own_.set(stencil)];
  }
  void evaluate_sources(int group, const JetBatch& inputs, double* const* g) const override;
  void differentiate_sources(int group, const JetBatch& inputs, double* const* d) const override;

 private:
  /// The weight of a vertex value in a slot of a point's jet, with h = k = 1.
  struct Weight {
    int slot;
    double weight;
    int own;  ///< the stencil's own number that multiplies it, or −1
  };
  struct Point {
    /// Tests of the vertices, then of the columns: what a column's vertices have together.
    std::vector<std::vector<Weight>> of_vertex, of_test;
    std::vector<int> values;  ///< numbers in values() of those that the jet here reads, or that it adds to
  };
  struct Jets;

  /// The weights of one stencil, its points as lanes of packs, so many at once: those of a vertex value in a slot of
  /// their jets, and of ∂ℓ/∂j there in its residual. Lanes left over repeat the last point, with nothing in a residual.
  struct Lanes {
    struct Entry {
      int slot, vertex;
      Pack weight;
    };
    std::vector<Entry> jets, tests;
  };

  void find_columns();
  void find_sources();
  void find_lanes();
  bool residual_of_one(const StencilBatch&, std::span<const int> equations, double* r) const;
  bool adds_to(const Point&, std::span<const int> equations) const;  ///< to one of them

  OwnWeights own_;
  DensityOnTable of_;
  int d_;
  bool has_sources_;
  bool own_values_ = false;  ///< stencils have weights of φ of their own, and no groups of the same inputs
  /// Vertices of the same place in space at one time after another: weights of derivatives in time add up to zero there.
  std::vector<std::vector<int>> columns_;
  std::vector<int> first_;  ///< [vertex]: the one of its column that increments count from
  std::vector<Point> points_;
  std::vector<Lanes> across_points_;  ///< none where a density depends on the place, which a batch has one time of
  SourceTerms sources_;
};

}  // namespace delf
