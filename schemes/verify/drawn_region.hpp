// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "lattice/region_shapes.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// A region that is asked for: a kind, drawn anew at every moment, or the sites themselves, whose rows count from the
/// first one of the moment whose equations can be asked.
struct RegionRequest {
  std::string name;  ///< of the kind, or "given"
  std::optional<RegionKind> kind;
  std::vector<Site> sites = {};
};

/// The regions that checks look at, on windows of `rows` rows; equations hold on the rows `solved` of a window.
class RegionDrawer {
 public:
  RegionDrawer(const LatticeSystem&, Range solved);

  const LatticeSystem& system() const { return system_; }
  /// Nothing if the lattice has no room for such a region.
  std::optional<Region> draw(const RegionRequest&, std::mt19937_64&) const;

  /// Rows on which equations must hold for every kind of region to fit.
  static int rows_wanted(const LatticeSystem&);

 private:
  std::optional<Region> within(Region) const;

  const LatticeSystem& system_;
  std::vector<StencilPattern> patterns_;
  RegionFrame frame_;
};

/// "rows 812 … 819, sites 12 … 30, 31 stencils"
std::string in_words(const Region&, std::int64_t origin, std::int64_t stencils);
/// "row 812, site 17", and the name of the component where there are several
std::string in_words(const LatticeSystem&, const Node&, std::int64_t origin);

}  // namespace delf
