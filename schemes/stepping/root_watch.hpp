// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "schemes/solvers/stopping.hpp"
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
/// predictors differ least. Driven ends are data: their differences count on the right, those of row n + 1 too, since what
/// they set off from rest is in no row before.
class RootWatch {
 public:
  explicit RootWatch(const LatticeSystem&);

  /// The unknowns of a slab that lie in one row, site·C + component.
  struct Values {
    int time;       ///< of the row, from J
    int held;       ///< rows before it that the section has
    bool is_field;  ///< known in all rows before; others in those of the slabs that were solved
    std::span<const int> places;
  };
  /// Judges the root of slab J, `solved` slabs before it, by where it lies and by how Newton's method has gone there.
  /// Other root: further away than any resolved motion. Doubtful: in the first steps, where few rows or none are there to
  /// predict from, further than the predictors of two orders differ by. Each field is judged on its own, with its inner nodes
  /// and traces; the worst one counts.
  Stop judge(const NewtonProgress&, const SectionRing&, std::int64_t J, std::int64_t solved, std::span<const Values>);
  /// The fields and sites of a row leave the straight line through the two before it by more than the way between these:
  /// another root than the motion's, where a predictor of low order has led to it. On a soliton that bounces on a moving mesh roots
  /// of the motion leave it by up to 0.63 of that way, and others by 1.24 and more.
  bool leaps(const SectionRing&, std::int64_t row) const;

  static constexpr int most_rows = 5;  ///< that are read before the new one

 private:
  using Maxima = std::array<double, most_rows + 1>;
  struct Field {
    double way, aside;      ///< |∇y_n|, |∇²y_{n+1}|
    double size;            ///< |y_n|
    Maxima leaves, differ;  ///< by order p: |∇ᵖ y_{n+1}|, and what predictors differ by
  };
  Stop judge(const SectionRing&, std::int64_t J, std::int64_t solved, std::span<const Values>);
  int rows(const Values& list, std::int64_t J, std::int64_t solved) const;

  const LatticeSystem& system_;
  std::vector<std::size_t> field_;  ///< of each component
  std::vector<char> moves_;         ///< components that are fields or positions of sites
  std::vector<int> driven_;         ///< places of the fields that are driven
  std::vector<Field> fields_;
  bool has_flux_;
};

}  // namespace delf
