// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
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
  int increments_held() const { return v_.rows() / d_; }

  double* y(std::int64_t row, int a) { return y_.row(slot(row, y_.rows() / d_) * d_ + a); }
  double* v(std::int64_t row, int a) { return v_.row(slot(row, v_.rows() / d_) * d_ + a); }

  /// y_{row} = y_{row−1} + v_{row}, halo too.
  void add_increment(std::int64_t row);
  /// v_{row} = y_{row} − y_{row−1}, halo too.
  void find_increment(std::int64_t row);

  /// In the order of sites, row[i·d + a].
  void set_row(std::int64_t row, const std::vector<double>& sites);
  std::vector<double> row(std::int64_t row);
  Window window(std::int64_t first, std::int64_t last);

  std::size_t row_bytes() const { return y_.bytes(); }
  std::size_t increment_bytes() const { return v_.bytes(); }

 private:
  static int slot(std::int64_t row, int held) { return static_cast<int>(row % held); }
  const Lattice* lattice_;
  int d_;
  double turn_;
  RowLayout layout_;
  RowBuffer y_, v_;
};

}  // namespace delf
