// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/candidate_rows.hpp"

namespace delf {

void CandidateRows::hold_whole() {
  const int d = static_cast<int>(at_.size());
  if (whole_.rows() == 0) whole_ = RowBuffer(*layout_, d);
  for (int a = 0; a < d; ++a) at_[static_cast<std::size_t>(a)] = whole_.row(a);
  is_whole_ = true;
}

void CandidateRows::hold_window(int packs, int first, int kept_until) {
  window_.hold(packs, first, kept_until);
  at_[0] = window_.row();
  is_whole_ = false;
}

}  // namespace delf
