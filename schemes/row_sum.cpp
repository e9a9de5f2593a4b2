// SPDX-License-Identifier: MIT
#include "schemes/row_sum.hpp"

namespace delf {

void RowSum::scale(double factor) {
  for (auto* terms : {&differences_, &plain_})
    for (Term& t : *terms) t.coefficient *= factor;
  constant_ *= factor;
}

void RowSum::bind(const double* const* rows) {
  for (auto* terms : {&differences_, &plain_})
    for (Term& t : *terms) {
      t.own = rows[t.row];
      t.shifted = t.own + static_cast<std::ptrdiff_t>(t.shift) * lanes;
    }
}

}  // namespace delf
