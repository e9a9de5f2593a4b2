// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "schemes/system/assembly.hpp"

namespace delf {

/// Watches which root Newton's method has gone to: a slab may have several, and the residual of each is zero.
///
/// The polynomial through the last p values predicts the next one, P_p = Σ_{k<p} ∇ᵏy_n. The new value leaves it by ∇ᵖy_{n+1},
/// and the predictors of two orders differ by P_p − P_{p−1} = ∇^{p−1}y_n. Of any oscillation, of whatever frequency and
/// phase, and of one that alternates,
///
///     |∇ᵖ y_{n+1}| ≤ 2 max(|∇^{p−1} y_n|, |∇^{p−1} y_{n−1}|),
///
/// so that a value further away has left the motion, or the step does not resolve it. The order p is the one whose
/// predictors differ least.
class RootWatch {
 public:
  explicit RootWatch(const LatticeSystem&);

  /// The unknowns of a slab that lie in one row, site·C + component; `rows` before it are known.
  struct Values {
    std::int64_t row;
    int rows;
    std::span<const int> places;
  };
  /// Far: further than any resolved motion. Doubtful: in the first steps, where few rows or none are there to predict from,
  /// further than the predictors of two orders differ by.
  enum class Verdict { near, doubtful, far };
  /// Each field is judged on its own, with its inner nodes and traces; the worst one counts.
  Verdict judge(const SectionRing&, std::span<const Values>) const;

  static constexpr int most_rows = 5;  ///< that are read before the new one

 private:
  const LatticeSystem& system_;
};

}  // namespace delf
