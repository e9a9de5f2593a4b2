// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "schemes/families/row_kernel.hpp"
#include "schemes/stepping/rows/row_layout.hpp"
#include "schemes/stepping/rows/row_team.hpp"

namespace delf {

/// Several explicit steps at once through rows that outgrow the cache, in place: a block of packs is taken up by all of
/// them while it is in the cache, so that it comes from memory once. Level t, the step from row n + t, follows level t − 1
/// at a distance:
///
///     t
///     │   \ block \ block \            level t of a block ends `shift` packs before level t − 1 of it: these read
///     │    \       \       \           beyond their end what level t − 1 has made already
///     └──────────────────────── pack
///
/// Parts of the row, one a thread, begin and end level t by t · shift packs later and earlier. What that leaves round
/// their ends, a seam, is made afterwards, level by level; the ends of the row are one, for arcs go on there in the next
/// lane. Neighbours that a level has written over before another piece of it reads them are kept apart. Every value is
/// made by the same loop from the same neighbours as in a step of its own: the bits are the same.
class TimeTiles {
 public:
  static constexpr int most_levels = 16;
  /// Neighbours are those within `reach`; the row's halos are moved packs (RowLayout::finds_halos_by_packs).
  TimeTiles(const RowLayout&, const RowKernel&, int components, int reach, int parts);

  /// Whether rows are so long that it pays, and parts have room for it.
  static bool are_worth_while(const RowLayout&, int reach, int parts);

  /// `rows`: where y and v of row n lie, halos of y filled, and the coefficients. Puts Σy² of every level's new values into
  /// `squares`, one for each level. A team for more than one part. The new row's halos are not filled.
  void run(const ExplicitRows& rows, std::int64_t n, std::span<double> squares, RowTeam*);

  std::size_t bytes() const { return edges_.bytes(); }

 private:
  enum Edge { left, right };
  int begin_of(int part) const { return layout_->first_of_part(part, parts_); }
  double* edge(int part, Edge side, int level, int a) {
    return edges_.row(((part * 2 + side) * most_levels + level) * d_ + a);
  }
  double* row(int a) const { return rows_->y[a]; }
  void keep(int part, Edge, int level, int first_pack);
  double advance(int level, PackRange, const double* const* before, const double* const* after) const;
  void go_through(int part);
  void close_seam(int seam);
  double& squares_of(int piece, int level) { return squares_[static_cast<std::size_t>(piece * most_levels + level)]; }

  const RowLayout* layout_;
  const RowKernel* kernel_;
  int d_, reach_, parts_, shift_;
  RowBuffer edges_;
  std::vector<double> squares_;  ///< of parts and of seams
  const ExplicitRows* rows_ = nullptr;
  std::int64_t n_ = 0;
  int levels_ = 0;
};

}  // namespace delf
