// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/pack_window.hpp"

#include <algorithm>

namespace delf {

void PackWindow::hold(int packs, int first, int kept_until) {
  const std::size_t doubles = static_cast<std::size_t>(packs) * lanes;
  const bool is_new = buffer_.bytes() < doubles * sizeof(double);
  if (is_new) buffer_ = RowBuffer(doubles);
  double* const start = buffer_.row(0);
  if (!is_new && kept_until > first && first >= first_)
    std::copy(row_ + layout_->at(first), row_ + layout_->at(kept_until), start);
  row_ = start - layout_->at(first);
  first_ = first;
}

}  // namespace delf
