// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "schemes/complex/complex_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// A finite set U of sites of a complex: int U, the sites with an equation of which U holds every stencil that touches
/// them; cl U, the union of all stencils that touch int U; ∂U = (U ∩ cl U) \ int U (§5.1).
class ComplexRegion {
 public:
  ComplexRegion(const Complex&, const Touching&, const std::vector<int>& sites);
  /// The union of the stencils that touch some centres.
  static ComplexRegion around(const Complex&, const Touching&, const std::vector<int>& centres);

  const std::vector<int>& sites() const { return sites_; }
  const std::vector<int>& interior() const { return interior_; }
  const std::vector<int>& boundary() const { return boundary_; }
  /// {Δ ⊂ U}, sorted by family.
  const std::vector<std::int32_t>& stencils() const { return stencils_; }

 private:
  std::vector<int> sites_, interior_, boundary_;
  std::vector<std::int32_t> stencils_;
};

/// Connected sets of up to `count` sites with equations, grown at random by stencils.
std::vector<int> draw_centres(const Complex&, const Touching&, int count, std::mt19937_64&);

/// The equations of int U at y, and the discrete multisymplectic form formula
///
///     Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} Ωˡ(V, W) = 0                                                 (5.6)
///
/// for random solutions V, W of the equations linearised at y.
class ComplexForm {
 public:
  using Values = std::vector<double>;  ///< at the nodes of U: place of the site in sites() · d + a

  /// `wrong_sign` plants a fault: one derivative of L with the other sign, on every stencil of several values.
  ComplexForm(const ComplexSystem&, ComplexRegion, std::span<const double> y, bool wrong_sign = false);

  const ComplexRegion& region() const { return region_; }
  /// Random vectors projected onto the null space of the linearised equations. At walls, which are in ∂U,
  /// they are as free as elsewhere: what U's equations do not know needs no data.
  std::vector<Values> first_variations(int count, std::mt19937_64&) const;
  /// How badly V solves them, the worst node.
  double linearised(const Values& V) const;
  Balance form_formula(const Values& V, const Values& W) const;
  /// ΣΩˡ(V, W) over one stencil, whatever V and W are: the worst of all.
  Balance local_identity(const Values& V, const Values& W) const;
  /// The node of ∂U that the equations of int U feel most: where a broken variation must show.
  std::optional<std::size_t> coupling_node() const;

 private:
  struct Local {
    std::vector<std::size_t> nodes;
    std::vector<double> J;
  };
  const ComplexSystem& system_;
  ComplexRegion region_;
  std::vector<Local> locals_;      ///< of each stencil in U
  std::vector<int> equation_;      ///< of each node: its number among those of int U, or −1
  std::vector<char> at_boundary_;  ///< of each node
  int equations_ = 0;
};

}  // namespace delf
