// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "schemes/lattice_system.hpp"
#include "schemes/row_layout.hpp"

namespace delf {

/// The newest rows of a section in the lanes' layout, halos filled: y_j, and the increments v_j = y_j − y_{j−1}, each a
/// ring that the next row enters by overwriting the oldest.
class SectionRows {
 public:
  /// `rows` of y and `increments` of v are held at once; beyond the ends of a circle values differ by `turn`.
  SectionRows(const LatticeSystem&, int halo, int rows, int increments, double turn);

  const RowLayout& layout() const { return layout_; }
  int sites() const { return layout_.sites(); }
  int components() const { return d_; }
  double turn() const { return turn_; }
  int rows_held() const { return y_.rows() / d_; }
  int increments_held() const { return v_.rows() / d_; }

  double* y(std::int64_t row, int a) { return y_at(slot(row, rows_held()), a); }
  double* v(std::int64_t row, int a) { return v_at(slot(row, increments_held()), a); }
  /// Lets the next row and its increment take the place of the newest instead of the oldest: the one before it is then
  /// gone.
  void overwrite_newest() { ++overwritten_; }
  /// Where a row comes in the rings: rows that took the place of the one before do not count.
  std::int64_t place(std::int64_t row) const { return row - overwritten_; }
  /// How often that was done; to go back to a time when it had been done less often, or before rows are set anew.
  std::int64_t overwritten() const { return overwritten_; }
  void restore(std::int64_t overwritten) { overwritten_ = overwritten; }
  /// By their slots in the rings, for those who keep count of them.
  double* y_at(int slot, int a) { return y_.row(slot * d_ + a); }
  double* v_at(int slot, int a) { return v_.row(slot * d_ + a); }

  /// v_{row} = y_{row} − y_{row−1}, halo too.
  void find_increment(std::int64_t row);

  /// In the order of sites, row[i·d + a].
  void set_row(std::int64_t row, const std::vector<double>& sites);
  std::vector<double> row(std::int64_t row);
  Window window(std::int64_t first, std::int64_t last);

  std::size_t row_bytes() const { return y_.bytes(); }
  std::size_t increment_bytes() const { return v_.bytes(); }

 private:
  int slot(std::int64_t row, int held) const {
    const std::int64_t r = place(row);
    // A division of 64 bits takes several times as long.
    if (r >= 0 && r < std::numeric_limits<std::uint32_t>::max())
      return static_cast<int>(static_cast<std::uint32_t>(r) % static_cast<std::uint32_t>(held));
    return static_cast<int>((r % held + held) % held);
  }
  const Lattice* lattice_;
  int d_;
  double turn_;
  RowLayout layout_;
  RowBuffer y_, v_;
  std::int64_t overwritten_ = 0;  ///< rows that took the place of the one before
};

}  // namespace delf
