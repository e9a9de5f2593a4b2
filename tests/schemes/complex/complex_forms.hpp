// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "lattice/region_shapes.hpp"
#include "schemes/complex/complex_region.hpp"
#include "schemes/verify/wrong_sign.hpp"

namespace delf::testing {

/// The union of the stencils around a connected set of sites of a complex.
inline Region drawn_region(const ComplexSystem& system, int centres, std::mt19937_64& random) {
  const Region whole = region_of(system);
  return region_around(whole.all(), draw_connected(whole, centres, random), whole.is_data());
}

/// The forms at a section of a complex on one region, or those of its row with a fault.
class ComplexForms {
 public:
  using Values = RegionSystem::Values;

  ComplexForms(const ComplexSystem& system, Region region, std::span<const double> y, bool wrong_sign = false)
      : wrong_(wrong_sign ? with_wrong_sign(system.row()) : nullptr),
        on_(wrong_ ? *wrong_ : system.row(), std::move(region)),
        y_(on_.restricted(system.row().window(0, {{y.begin(), y.end()}}, 0))) {}

  const RegionSystem& on() const { return on_; }
  const Values& y() const { return y_; }
  std::vector<Values> first_variations(int count, std::mt19937_64& random) const {
    return on_.first_variations(y_, count, random);
  }
  double linearised(const Values& V) const {
    double worst = 0;
    for (const Balance& E : on_.linearised(y_, V)) worst = std::max(worst, E.relative());
    return worst;
  }
  Balance form_formula(const Values& V, const Values& W) const {
    const RegionSystem::Pair pair{V, W};
    return on_.form_formula(y_, {&pair, 1}).front();
  }
  Balance local_identity(const Values& V, const Values& W) const { return on_.local_identity(y_, {V, W}).balance; }
  std::optional<std::size_t> coupling_node() const { return on_.coupling_node(y_); }

 private:
  std::unique_ptr<LatticeSystem> wrong_;
  RegionSystem on_;
  Values y_;
};

}  // namespace delf::testing
