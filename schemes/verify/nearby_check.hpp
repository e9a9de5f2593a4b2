// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "schemes/verify/check.hpp"
#include "schemes/verify/region_system.hpp"

namespace delf {

/// The form formula on solutions made elsewhere: V and W are differences to nearby solutions A and B of the same
/// program, and first variations of it up to the size ε of the differences,
///
///     Σ_∂U Ω(A − F, B − F) / Σ |terms| = q + c₁ ε + c₂ ε² + …
///
/// with q = 0 if the program is multisymplectic in the sense of this scheme. Pairs (A, B) of several sizes, in the same
/// directions, are extrapolated to ε = 0.
class NearbyCheck {
 public:
  explicit NearbyCheck(double tolerance) : tolerance_(tolerance) {}

  /// Takes one region: F, and the pairs of differences to it, in any order of size.
  void at(const std::string& kind, const RegionSystem&, const RegionSystem::Values& F,
          const std::vector<RegionSystem::Pair>& differences);
  std::vector<Check> checks() const;
  /// The checks that were not possible, in words.
  std::vector<std::string> left_out() const;

 private:
  double tolerance_;
  std::vector<Check> worst_;  ///< one for each kind of region
  std::int64_t too_far_ =
      0;  ///< regions on which the differences are too large, or too much rounding, to tell anything
};

}  // namespace delf
