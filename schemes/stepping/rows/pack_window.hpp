// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/stepping/rows/row_layout.hpp"

namespace delf {

/// Room for some packs of a row, which slides along where rows outgrow the cache. Memory is taken when first needed.
class PackWindow {
 public:
  explicit PackWindow(const RowLayout& layout) : layout_(&layout) {}

  /// Room for `packs` packs from `first` on, which may lie in a halo; of what is held, first … kept_until − 1 stays.
  void hold(int packs, int first, int kept_until);
  /// Pack v of those held stands at row() + layout.at(v).
  double* row() const { return row_; }
  std::size_t bytes() const { return buffer_.bytes(); }

 private:
  const RowLayout* layout_;
  RowBuffer buffer_;
  double* row_ = nullptr;
  int first_ = 0;
};

}  // namespace delf
