// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "jets/simd/pack.hpp"
#include "lattice/index.hpp"
#include "lattice/lattice.hpp"

namespace delf {

/// The packs first, first + stride, … before last.
struct PackRange {
  int first, last, stride = 1;
};

/// The layout of a row of N sites: lane l of every pack owns the contiguous arc of sites start(l) … start(l)+M−1,
/// so that the neighbours of a pack of sites are the packs before and after it, aligned, without shuffles. Arcs may
/// overlap by one site or more when N is no multiple of the lanes; such slots hold the same value. `halo` packs on
/// either side repeat the sites across the ends of the arcs.
///
///     pack −halo … −1 | 0 … M−1 | M … M+halo−1        slot(v, l) = (v + halo)·lanes + l
///
/// With `aligned` = 2 every arc starts at an even site (N even), so that a pack holds even sites only or odd sites
/// only: a brick wall then needs no more than every second pack.
class RowLayout {
 public:
  RowLayout(const Lattice&, int halo, int aligned = 1);

  int packs() const { return packs_; }  ///< M
  PackRange all() const { return {0, packs_}; }
  /// The pack at which one of so many parts of the row begins; part `parts` begins at its end.
  int first_of_part(int part, int parts) const {
    return static_cast<int>(static_cast<long long>(part) * packs_ / parts);
  }
  int halo() const { return halo_; }
  int sites() const { return sites_; }
  std::size_t doubles() const { return delf::at(packs_ + 2 * halo_) * lanes; }
  int start(int lane) const { return start_[lane]; }
  /// The slot in which site i is read and written from outside.
  int slot(int i) const {
    int lane = static_cast<int>(static_cast<long long>(i) * lanes / sites_);
    while (lane + 1 < lanes && start(lane + 1) <= i) ++lane;
    while (start(lane) > i) --lane;
    return (i - start(lane) + halo_) * lanes + lane;
  }
  /// Offset of pack v in a row.
  std::ptrdiff_t at(int v) const { return static_cast<std::ptrdiff_t>(v + halo_) * lanes; }

  /// Fills halo slots from the sites they repeat, adding `monodromy` for every time round the circle; on an interval the
  /// slots beyond a wall repeat the wall, so that they stay finite.
  void fill_halo(double* row) const {
    if (!by_packs_) fill_halo_turned(row, 0);
    else before_.fill(row, -at(0), 0), after_.fill(row, 0, at(0));
  }
  void fill_halo(double* row, double monodromy) const {
    if (monodromy != 0) fill_halo_turned(row, monodromy);
    else fill_halo(row);
  }
  /// True if packs of a halo are packs of the row, moved by a lane; before_first() is then the one before the first.
  bool finds_halos_by_packs() const { return by_packs_; }
  Pack before_first(const double* row) const { return before_.pack(row, -lanes); }
  /// Makes overlapping slots equal to the slot that slot(i) names.
  void copy_overlaps(double* row) const {
    for (const Copy& c : overlap_copies_) row[c.to] = row[c.from];
  }
  void copy_overlaps(double* row, double* other) const {
    for (const Copy& c : overlap_copies_) row[c.to] = row[c.from], other[c.to] = other[c.from];
  }
  /// Halos repeat no slot that copy_overlaps() sets. They are then better filled first, where a row has just been made: a
  /// pack cannot be loaded without waiting right after one of its slots was stored.
  bool halos_come_first() const { return halos_come_first_; }
  /// Every slot (overlaps too, halo not) that holds site i.
  std::vector<int> slots_of(int i) const;

  void scatter(std::span<const double> sites, double* row, double monodromy = 0) const;
  void gather(const double* row, std::span<double> sites) const;

  std::size_t bytes() const { return (halo_copies_.size() + overlap_copies_.size()) * sizeof(Copy); }

 private:
  struct Copy {
    int to, from, turns;
  };
  /// The values beside arcs on one side. A pack of them is a pack of the row, moved by a lane: another one where
  /// arcs overlap by one site more.
  template <Pack (*moved)(Pack)>
  struct Beside {
    std::ptrdiff_t to = 0, from = 0, from_others = 0;
    Pack is_other = 0.0;  ///< 1 in their lanes, before they are moved

    [[gnu::always_inline]] Pack pack(const double* row, std::ptrdiff_t by) const {
      const Pack one = Pack::load(row + from + by), other = Pack::load(row + from_others + by);
      return moved(Pack{is_other.v != 0 ? other.v : one.v});
    }
    /// The packs from `by` on, at least one. A copy of it is worked with, which stores cannot change.
    void fill(double* row, std::ptrdiff_t by, std::ptrdiff_t end) const {
      const Beside own = *this;
      do {
        own.pack(row, by).store(row + own.to + by);
      } while ((by += lanes) < end);
    }
  };
  void fill_halo_turned(double* row, double monodromy) const;
  void find_halo_packs();

  int sites_, packs_, halo_;
  std::vector<int> start_;
  std::vector<Copy> halo_copies_, overlap_copies_;
  bool by_packs_ = false, halos_come_first_ = false;
  Beside<from_lane_below> before_;
  Beside<from_lane_above> after_;
  Pack turns_before_ = 0.0, turns_after_ = 0.0;
};

/// Zeroed memory for rows, aligned to whole packs.
class RowBuffer {
 public:
  RowBuffer() = default;
  RowBuffer(const RowLayout& layout, int rows);
  /// Rows of so many doubles.
  explicit RowBuffer(std::size_t doubles, int rows = 1);
  /// The bytes that so many doubles take: rows begin at cache lines.
  static std::size_t bytes_of(std::size_t doubles, int rows = 1) {
    return stride_of(doubles) * delf::at(rows) * sizeof(double);
  }
  double* row(int r) { return data_.get() + delf::at(r) * stride_; }
  const double* row(int r) const { return data_.get() + delf::at(r) * stride_; }
  int rows() const { return rows_; }
  std::ptrdiff_t stride() const { return static_cast<std::ptrdiff_t>(stride_); }  ///< from row to row, in doubles
  std::size_t bytes() const { return stride_ * delf::at(rows_) * sizeof(double); }

 private:
  static std::size_t stride_of(std::size_t doubles) { return (doubles + 7) / 8 * 8; }
  struct Free {
    void operator()(double* p) const { std::free(p); }
  };
  std::unique_ptr<double[], Free> data_;
  std::size_t stride_ = 0;
  int rows_ = 0;
};

}  // namespace delf
