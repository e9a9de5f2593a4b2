// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "jets/symmetry.hpp"
#include "schemes/verify/check.hpp"
#include "schemes/verify/drawn_region.hpp"
#include "schemes/verify/region_system.hpp"

namespace delf {

/// Noether's theorem (5.7) for symmetries of the fields, on regions of a section that solves the equations. Each
/// generator is first tried on the Lagrangian itself: one that changes it is no symmetry, and nothing is owed for it.
class NoetherCheck {
 public:
  /// `forced`: the sums are taken even for what is no symmetry. The system is read here alone: regions may be those of others
  /// with the same kinds of stencils.
  NoetherCheck(const LatticeSystem&, std::vector<LinearSymmetry>, double tolerance, bool forced, std::uint64_t seed);

  void at(const RegionSystem&, const RegionSystem::Values& y, const std::string& where);
  /// On a region of each kind that is asked for and has room, drawn in these rows.
  void at(const Window& rows, const RegionDrawer&, const std::vector<RegionRequest>&, std::mt19937_64&);
  std::vector<Check> checks() const;

 private:
  /// Σ_l Jˡ(ξ) = dL(ξ) on single stencils at random jets, which is zero where ξ is a symmetry of L.
  static Check invariance(const LatticeSystem&, const LinearSymmetry&, std::mt19937_64&);
  /// Checks that the change δL is a divergence: its sum over a region is one over the region's boundary.
  static Check divergence(const LatticeSystem&, const LinearSymmetry&, std::mt19937_64&);
  /// ∂/∂y of Σ_Δ δL_Δ at one value of a random field.
  static Balance change_at(const LatticeSystem&, Site, int component, const LinearSymmetry&, double centre,
                           std::mt19937_64&);

  std::vector<LinearSymmetry> symmetries_;
  std::vector<Check> invariant_, sums_;
  std::vector<bool> up_to_divergence_;
  bool forced_;
};

}  // namespace delf
