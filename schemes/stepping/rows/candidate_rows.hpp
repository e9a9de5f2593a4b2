// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/stepping/rows/pack_window.hpp"

namespace delf {

/// The candidate for y_{n+1}, d rows: kept apart from the row itself, so that a step can tell how far apart they are.
/// Either whole, or, of one component, a window of packs; memory is taken when first needed.
class CandidateRows {
 public:
  CandidateRows(const RowLayout& layout, int components)
      : layout_(&layout), window_(layout), at_(static_cast<std::size_t>(components), nullptr) {}

  /// All packs and halos from here on. What a window held is gone.
  void hold_whole();
  /// PackWindow::hold()
  void hold_window(int packs, int first, int kept_until);
  /// Whether all packs are held.
  bool is_whole() const { return is_whole_; }

  /// Pack v of those held stands at row(a) + layout.at(v).
  double* row(int a) const { return at_[static_cast<std::size_t>(a)]; }
  double* const* rows() const { return at_.data(); }
  std::size_t bytes() const { return whole_.bytes() + window_.bytes(); }

 private:
  const RowLayout* layout_;
  RowBuffer whole_;
  PackWindow window_;
  std::vector<double*> at_;
  bool is_whole_ = false;
};

}  // namespace delf
