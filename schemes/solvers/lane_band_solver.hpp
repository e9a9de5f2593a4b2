// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "jets/simd/pack.hpp"
#include "schemes/solvers/linear_solver.hpp"

namespace delf {

/// Block LU of a (cyclic) band by partition of the row: every lane of a pack factors the sites that it owns, n_l of
/// them, and all lanes work at once. What an arc takes from the last s sites a of the arc before it and from the first
/// s sites b of the arc after it is found from a small system over the ends of the arcs.
///
///     z_v = Q_v f_v + Σ_k L_{v,k} z_{v−k},     ends = R (Σ_v Φ_v z_v, Σ_v Ψ_v z_v),  (a, b) = neighbours' ends
///     x_v = z_v + G_v a + H_v b + Σ_k U_{v,k} x_{v+k}
///
/// k = 1 … s; Q_v is the inverse of a pivot block and signs are in the coefficients, so that a solve only multiplies
/// and adds. The spike G = −Λ⁻¹B (Λ = the lower factor, B = the coupling to the left) decays away from the start of the
/// arc, like the rows Φ of U⁻¹ that give its first sites; H and Ψ are needed at its end only. This is the partition
/// of Polizzi and Sameh (2006), Parallel Computing 32, 177, doi:10.1016/j.parco.2005.07.005, with the right spike left
/// in U, so that one backward sweep does both the solve and the correction.
///
/// A slot beyond what its lane owns has the row 1 alone: it gets its right side, which must be finite, as its value.
class LaneBandSolver final : public LinearSolver {
 public:
  /// Null if the arcs are too short, the band is too wide, or the factors are not accurate (see `trial`); then a
  /// solver that pivots may still do.
  static std::unique_ptr<LaneBandSolver> factor(const Lattice&, const RowLayout&, int components,
                                                const std::vector<LatticeSystem::Entry>& entries);
  void solve(const double* const* rhs, double* const* w) const override;
  std::size_t bytes() const override;
  std::string name() const override { return name_; }

  /// The widest block d·s that is worked on; also bounds the scratch memory of a solve, which is on the stack.
  static constexpr int widest = 32;

 private:
  struct Band;
  class LaneFactors;

  explicit LaneBandSolver(const RowLayout& layout, const Band&);
  void close(const Band&);
  void keep_what_matters();
  template <int components, int reach>
  void solve_as(const double* const* rhs, double* const* w) const;
  template <int components, int reach>
  void solve_ends(const Pack* ends, Pack* incoming) const;

  const RowLayout* layout_;
  int d_, s_, ends_;  ///< components; reach in sites; slots that H and Ψ have
  std::string name_;
  int first_packs_ = 0, left_packs_ = 0;  ///< how far Φ and G matter
  /// Blocks by slots, each by rows, n = d·s: Q d×d; L, U d×n; G, H d×n; Φ, Ψ n×d.
  std::vector<Pack> inverse_, lower_, upper_, left_, right_, first_, last_;
  /// R by how many lanes apart cause and effect are, as far as it matters: 2n×2n each.
  std::vector<int> shifts_;
  std::vector<Pack> reduced_;
};

/// What a solver makes of a seeded random right side b_i ∈ (−1, 1)·Σ_j |A_ij|.
struct Trial {
  double residual;  ///< max_i |Ax − b|_i / (|A||x| + |b|)_i   Oettli–Prager (1964), doi:10.1007/BF01386090
  double growth;    ///< max |x|, an estimate of |A⁻¹| after scaling by rows
};
Trial trial(const LinearSolver&, const RowLayout&, int components, const std::vector<LatticeSystem::Entry>& entries);

}  // namespace delf
