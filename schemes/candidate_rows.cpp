// SPDX-License-Identifier: MIT
#include "schemes/candidate_rows.hpp"

#include <algorithm>

namespace delf {

void CandidateRows::hold_whole() {
  const int d = static_cast<int>(at_.size());
  if (whole_.rows() == 0) whole_ = RowBuffer(*layout_, d);
  for (int a = 0; a < d; ++a) at_[static_cast<std::size_t>(a)] = whole_.row(a);
  is_whole_ = true;
}

void CandidateRows::hold_window(int packs, int first, int kept_until) {
  const std::size_t doubles = static_cast<std::size_t>(packs) * lanes;
  const bool nothing_held = is_whole_ || window_.rows() == 0;
  if (window_.bytes() < at_.size() * doubles * sizeof(double)) window_ = RowBuffer(at_.size() * doubles);
  for (std::size_t a = 0; a < at_.size(); ++a) {
    double* const start = window_.row(0) + a * doubles;
    if (!nothing_held && kept_until > first && first >= first_)
      std::copy(at_[a] + layout_->at(first), at_[a] + layout_->at(kept_until), start);
    at_[a] = start - layout_->at(first);
  }
  first_ = first;
  is_whole_ = false;
}

}  // namespace delf
