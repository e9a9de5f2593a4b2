// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/stepping/rows/ring_slots.hpp"
#include "schemes/stepping/rows/row_layout.hpp"

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
  int rows_held() const { return y_slots_.held(); }
  int increments_held() const { return v_slots_.held(); }

  double* y(std::int64_t row, int a) {
    y_slots_.at(place(row));
    return y_at(y_slots_.slot(), a);
  }
  /// Of the row before.
  double* y_before(std::int64_t row, int a) {
    y_slots_.at(place(row));
    return y_at(y_slots_.before(y_slots_.slot()), a);
  }
  double* v(std::int64_t row, int a) {
    v_slots_.at(place(row));
    return v_at(v_slots_.slot(), a);
  }
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
  const Lattice* lattice_;
  int d_;
  double turn_;
  RowLayout layout_;
  RowBuffer y_, v_;
  RingSlots y_slots_, v_slots_;
  std::int64_t overwritten_ = 0;  ///< rows that took the place of the one before
};

}  // namespace delf
