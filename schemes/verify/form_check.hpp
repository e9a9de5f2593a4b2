// SPDX-License-Identifier: MIT
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "schemes/verify/check.hpp"
#include "schemes/verify/drawn_region.hpp"
#include "schemes/verify/region_system.hpp"
#include "schemes/verify/tangent.hpp"

namespace delf {

/// The discrete multisymplectic form formula (5.6) on regions of a section, the local identity Σ_l Ωˡ = 0 behind it,
/// and the symplectic form from slab to slab, which is (5.6) on all of space between two rows. First variations V, W
/// are evolved from random values on the first rows of a window, and, on regions of up to `most_local` nodes, drawn
/// from the null space of the region's own linearised equations. It is an identity of the linearised equations at any
/// section.
///
/// Values that are slaved to others have an equation that comes from no action. What is checked then is (5.6) where they are
/// known functions: V = 0 there, and their equations are dropped. What it leaves where they follow the field is measured; and
/// so is, of constraints, what it leaves without the terms of their multipliers (Tyranowski–Desbrun, remark 5).
class FormCheck {
 public:
  struct Options {
    std::vector<RegionRequest> regions;
    int pairs = 2;  ///< of V and W, of either sort, for each region
    double tolerance = 1e-13;
    double monodromy = 0;          ///< φ(x + L) − φ(x)
    bool break_variation = false;  ///< plants a fault: V is wrong at the site of ∂U that int U feels most
  };
  static constexpr std::size_t most_local = 1500;

  FormCheck(const LatticeSystem&, const SolvePlan&, int rows, Options);

  /// Rows that windows must have.
  static int rows_wanted(const LatticeSystem&, const SolvePlan&, const std::vector<RegionRequest>&);
  /// The rows of a window, counted from its first, in which regions may lie.
  Range solved_rows() const { return solved_; }

  /// Looks at one moment: consecutive rows of a section, every component at its own row, the first row even.
  void at(const Window&, std::mt19937_64&);

  std::vector<Check> checks() const;
  std::vector<Measured> measured() const;
  /// Kinds of regions for which there was no room.
  std::vector<std::string> left_out() const;
  std::int64_t stencils() const { return stencils_; }  ///< on which sums were taken

  struct Point {
    std::string kind;
    std::int64_t stencils;
    double value;
    bool local;
  };
  const std::vector<Point>& points() const { return points_; }

  /// The region on which the formula fails most, with the size of the boundary's terms.
  struct Worst {
    double value = -1;
    std::string words;
    std::vector<Site> sites;
    std::vector<char> interior, boundary;
    std::vector<double> weights;
  };
  const Worst& worst() const { return worst_; }

 private:
  void look(const RegionRequest&, const RegionSystem&, const RegionSystem::Values& y,
            std::vector<RegionSystem::Pair>& pairs, bool local);
  void measure(const RegionRequest&, const RegionSystem&, const RegionSystem::Values& y,
               const std::vector<RegionSystem::Pair>& pairs);
  std::string why(const RegionSystem&, const RegionSystem::Values& y, const RegionSystem::Pair&) const;
  void look_at_stencils(const RegionSystem&, const RegionSystem::Values& y, std::mt19937_64&);
  void look_at_cuts(const Window& y, const std::vector<Window>& V);

  const LatticeSystem& system_;
  Options options_;
  bool variational_;
  std::string slaved_;  ///< the names of what is slaved; empty: nothing
  bool constrained_;    ///< by multipliers
  std::unique_ptr<Tangent> tangent_;
  Range solved_;
  std::vector<Check> forms_, beyond_;  ///< one for each request: what is checked, and what is measured
  std::vector<bool> drawn_;
  Check local_, cuts_;
  std::vector<Point> points_;
  Worst worst_;
  std::int64_t stencils_ = 0;
  std::string no_evolution_;  ///< why there was none, if there was none
};

/// ω(V, W) over the cut below row `cut`: Σ_Δ Σ_{l: Δˡ at or above it} Ωˡ(V, W), over the stencils that reach across.
/// It is the same at every cut between which the linearised equations hold. Of slaved values there is no p.
std::vector<Balance> symplectic_form(const LatticeSystem&, const Window& y, const std::vector<Window>& V,
                                     std::int64_t cut);

}  // namespace delf
