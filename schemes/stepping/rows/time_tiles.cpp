// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/time_tiles.hpp"

#include <algorithm>
#include <functional>

namespace delf {
namespace {

/// y and v of a block, and of what lies between it and its last level, fit into half of a second-level cache.
constexpr int block_packs = 1024;
/// What halos repeat lies so many packs from the ends of arcs: arcs overlap by a few sites at most.
constexpr int deepest_overlap = 4;
/// Rows of half a megabyte each.
constexpr int long_row = 8192;
constexpr int most_reach = 16;

}  // namespace

TimeTiles::TimeTiles(const RowLayout& layout, const RowKernel& kernel, int components, int reach, int parts)
    : layout_(&layout),
      kernel_(&kernel),
      d_(components),
      reach_(reach),
      parts_(parts),
      shift_(reach + deepest_overlap),
      edges_(static_cast<std::size_t>(reach) * lanes, parts * 2 * most_levels * components),
      squares_(static_cast<std::size_t>(2 * parts * most_levels)) {}

bool TimeTiles::are_worth_while(const RowLayout& layout, int reach, int parts) {
  const int room = 4 * most_levels * (reach + deepest_overlap) + block_packs;
  return layout.finds_halos_by_packs() && reach <= most_reach && layout.packs() >= std::max(long_row, parts * room);
}

void TimeTiles::keep(int part, Edge side, int level, int first_pack) {
  for (int a = 0; a < d_; ++a)
    std::copy_n(row(a) + layout_->at(first_pack), reach_ * lanes, edge(part, side, level, a));
}

double TimeTiles::advance(int level, PackRange packs, const double* const* before, const double* const* after) const {
  ExplicitRows rows = *rows_;
  rows.before = before, rows.after = after;
  rows.now.t = static_cast<double>(n_ + level) * rows.now.time_step;
  return kernel_->explicit_step(rows, packs);
}

/// Level t of part [a, b) goes from a + t · shift to b − t · shift. Its neighbours at the ends are those of the row but
/// for level 0, to which other parts would write: they are kept before all begin.
void TimeTiles::go_through(int part) {
  constexpr int most = RowKernel::most_components;
  const int begin = begin_of(part), end = begin_of(part + 1);
  int done[most_levels];
  for (int level = 0; level < levels_; ++level) {
    done[level] = begin + level * shift_;
    squares_of(part, level) = 0;
  }
  const double *before[most], *after[most];
  alignas(Pack) double last[most][most_reach * lanes];
  for (int block_end = begin; block_end < end;) {
    block_end = end - block_end < 2 * block_packs ? end : block_end + block_packs;
    for (int level = 0; level < levels_; ++level) {
      const int until = block_end - level * shift_;
      if (until <= done[level]) break;
      const bool is_first = done[level] == begin + level * shift_, is_last = block_end == end;
      if (level > 0 && is_first) {
        keep(part, left, level, done[level] - reach_);
        keep(part, right, level, done[level]);  // that the seam before this part will read
      }
      for (int a = 0; a < d_; ++a) {
        before[a] = edge(part, left, level, a);
        after[a] = level == 0 && is_last ? edge(part, right, 0, a) : row(a) + layout_->at(until);
        std::copy_n(row(a) + layout_->at(until - reach_), reach_ * lanes, last[a]);
      }
      squares_of(part, level) += advance(level, {done[level], until}, before, after);
      for (int a = 0; a < d_; ++a) std::copy_n(last[a], reach_ * lanes, edge(part, left, level, a));
      done[level] = until;
    }
  }
}

/// Between the end of part `seam` and the beginning of the next one, or of the first: level t of the t · shift packs to
/// either side.
void TimeTiles::close_seam(int seam) {
  constexpr int most = RowKernel::most_components;
  const int end = begin_of(seam + 1), next = seam + 1 < parts_ ? seam + 1 : 0;
  const double *before[most], *after[most], *row_after[most], *row_before[most];
  for (int level = 1; level < levels_; ++level) {
    const int wide = level * shift_;
    for (int a = 0; a < d_; ++a) {
      before[a] = edge(seam, left, level, a), after[a] = edge(next, right, level, a);
      row_after[a] = row(a) + layout_->at(end), row_before[a] = row(a) + layout_->at(-reach_);
    }
    double& squares = squares_of(parts_ + seam, level);
    if (next != 0) {
      squares = advance(level, {end - wide, end + wide}, before, after);
    } else {
      for (int a = 0; a < d_; ++a) layout_->fill_halo(row(a), reach_, reach_);
      squares = advance(level, {end - wide, end}, before, row_after);
      squares += advance(level, {0, wide}, row_before, after);
    }
  }
}

void TimeTiles::run(const ExplicitRows& rows, std::int64_t n, std::span<double> squares, RowTeam* team) {
  rows_ = &rows, n_ = n, levels_ = static_cast<int>(squares.size());
  for (int part = 0; part < parts_; ++part) {
    keep(part, left, 0, begin_of(part) - reach_);
    keep(part, right, 0, begin_of(part + 1));
  }
  const auto with_all = [&](const std::function<void(int)>& work) {
    if (parts_ > 1) team->run(parts_, work);
    else work(0);
  };
  with_all([this](int part) { go_through(part); });
  std::fill(squares_.begin() + parts_ * most_levels, squares_.end(), 0.0);
  with_all([this](int seam) { close_seam(seam); });
  for (int level = 0; level < levels_; ++level) {
    squares[static_cast<std::size_t>(level)] = 0;
    for (int piece = 0; piece < 2 * parts_; ++piece)
      squares[static_cast<std::size_t>(level)] += squares_of(piece, level);
  }
}

}  // namespace delf
