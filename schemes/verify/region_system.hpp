// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "jets/symmetry.hpp"
#include "lattice/index.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "lattice/region.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// The part of slaved values in forms: they are solved for with the rest, or are known functions of t, which do
/// not vary and have no equations.
enum class SlavedValues { solved, known };

/// The patterns of a system's families.
std::vector<StencilPattern> patterns_of(const LatticeSystem&);
/// The stencils of a system, as regions count them; those that are listed are the families'.
Stencils stencils_of(const LatticeSystem&);

/// A family's stencils have the multiplier of a constraint.
bool has_multiplier(const LatticeSystem&, const StencilFamily&);

/// A system on a region U alone: its equations at int U, their linearisation, and the sums over ∂U that the form
/// formula and Noether's theorem are about. Sections and variations are vectors over the nodes of U: node number
/// place of its site · C + component.
class RegionSystem {
 public:
  using Values = std::vector<double>;

  /// Rows of U count from `origin`, which is even: brick walls keep their parity. `monodromy` is φ(x + L) − φ(x).
  RegionSystem(const LatticeSystem&, Region, std::int64_t origin = 0, double monodromy = 0,
               SlavedValues = SlavedValues::solved);

  const LatticeSystem& system() const { return system_; }
  const Region& region() const { return *region_; }
  std::int64_t origin() const { return origin_; }
  /// Counts the rows of U from another origin, of the same parity: a window that has moved on.
  void move_to(std::int64_t origin) { origin_ = origin; }
  std::size_t nodes() const { return region().sites().size() * at(components_); }
  std::int64_t stencils() const { return assembly_->stencils(); }
  /// The node of that number; rows count from the origin.
  Node node(std::size_t n) const;
  /// The nodes of int U where there is an equation.
  const std::vector<std::size_t>& equations() const { return equations_; }

  /// The values of a window on U.
  Values restricted(const Window&) const;

  /// E_b = Σ_{l: Δˡ = b} rˡ at the nodes of equations()                                                     (5.2)
  std::vector<Balance> residual(const Values& y) const;
  /// Σ_a |∂E_b/∂y_a y_a| at every node b of U: what the terms of E_b have cancelled within stencils too.
  std::vector<double> sizes(const Values& y) const;
  /// Σ_ba |∂E_b/∂y_a y_a| of the stencils that have a node, at every node of U: its equation is rounded like their terms, even
  /// where these cancel within a stencil.
  std::vector<double> sizes_of_stencils(const Values& y) const;

  /// Random solutions of the linearised equations at equations(), by an orthogonal projection onto the null space of
  /// ∂E_b/∂y_a, and zero at fixed walls, unless these are data of the region: no evolution is needed to have them.
  std::vector<Values> first_variations(const Values& y, int count, std::mt19937_64&) const;
  /// The failure of V to solve them: Σ_a ∂E_b/∂y_a V_a at each node of equations().
  std::vector<Balance> linearised(const Values& y, const Values& V) const;
  /// The node of ∂U that the equations of int U feel most: where a broken variation must show.
  std::optional<std::size_t> coupling_node(const Values& y) const;

  struct Pair {
    Values V, W;
  };
  /// The form formula of each pair, with every stencil differentiated once,
  ///
  ///     Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} Ωˡ(V, W)                                                      (5.6)
  ///
  /// or, if some family has no Lagrangian and with it no Ω, the same for the equations alone (where slaved values are known
  /// it is Ω even so: what is varied may have an action of its own):
  ///
  ///     Σ_{b ∈ int U, a ∈ ∂U} ∂E_b/∂y_a (W_a V_b − V_a W_b)
  std::vector<Balance> form_formula(const Values& y, std::span<const Pair> pairs) const;
  /// (5.6) over the stencils without multipliers alone: on (φ, X) in place of (φ, X, λ), Tyranowski–Desbrun, remark 5.
  std::vector<Balance> form_without_multipliers(const Values& y, std::span<const Pair> pairs) const;

  /// The largest effect of an error of δ in V and W on that sum: δ Σ |∂rⁱ/∂yᵐ| (|Vᵐ| + |Wⁱ| + |Wᵐ| + |Vⁱ|).
  double form_error(const Values& y, const Pair&, double delta) const;

  struct LocalDefect {
    Balance balance;  ///< Σ_l Ωˡ(V, W)
    int family = 0;
    Site anchor;              ///< its row counts from the origin
    int row = 0, column = 0;  ///< the values between which ∂²L/∂y∂y is least symmetric
  };
  /// The stencil in U on which Σ_l Ωˡ(V, W) is largest, relative to its terms.
  LocalDefect local_identity(const Values& y, const Pair&) const;

  /// The two equations in int U that differ most from ∂E_b/∂y_a = ∂E_a/∂y_b, by which equations are those of an action.
  struct OneWay {
    Node b, a;
    double b_by_a = 0, a_by_b = 0;
  };
  std::optional<OneWay> least_mutual(const Values& y) const;
  /// |Σ_{l: Δˡ = a} Ωˡ(V, W)| over the sites a of ∂U: what the form formula sums; zero elsewhere.
  std::vector<double> boundary_terms(const Values& y, const Pair&) const;

  /// Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} Jˡ(ξ)                                                            (5.7)
  ///
  /// and, for a symmetry up to a divergence, less what L changes by on all Δ ⊂ U: Σ_{Δ ⊂ U} Σ_l ∂L/∂yˡ ξ(yˡ).
  Balance noether(const Values& y, const LinearSymmetry&, bool up_to_divergence = false) const;
  /// The rounding of that sum by the number of bits of y: ε Σ |∂rⁱ/∂yᵐ yᵐ ξⁱ| at the boundary. A momentum (q₁ − q₀)/h
  /// has the rounding of q divided by h.
  double rounding(const Values& y, const LinearSymmetry&) const;

 private:
  enum Kind : char { outside, inside, boundary };  ///< outside: in U, but neither in int U nor in ∂U
  using Reads = std::span<const int>;              ///< the nodes that a stencil reads
  /// Calls visit(stencil, reads, ∂r/∂y) for every stencil in U, or for those that meet ∂U.
  template <class Visit>
  void each_jacobian(const Values& y, bool at_boundary, const Visit& visit) const;
  template <class Wanted>
  std::vector<Balance> form_sums(const Values& y, std::span<const Pair> pairs, const Wanted& wanted) const;
  bool at_boundary(int node) const { return kind_[node / components_] == boundary; }
  bool is_solved(int node) const { return solved_[node]; }
  bool is_held(int node) const { return held_[node]; }
  /// Values of a section or a variation as its one row.
  static SectionView row(const Values& values) { return {values.data(), 1, values.size()}; }
  void gather(const Assembly::Local&, const Values& from, std::vector<double>& to) const;

  const LatticeSystem& system_;
  std::shared_ptr<const Region> region_;
  std::int64_t origin_;
  int components_;
  bool by_forms_;           ///< Ω is that of residuals; or else the sum is that of equations
  std::vector<Kind> kind_;  ///< of each site
  std::vector<std::size_t> equations_;
  std::vector<char> solved_;  ///< of each node: it is in equations_
  std::vector<char> held_;    ///< of each node: at a fixed wall, where V = 0
  std::optional<Assembly>
      assembly_;  ///< of equations_, in their order, and all stencils in U; rows count from the origin
};

/// The first two variations, the next two, …
std::vector<RegionSystem::Pair> pairs_of(std::vector<RegionSystem::Values> variations);

}  // namespace delf
