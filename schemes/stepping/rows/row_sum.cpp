// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_sum.hpp"

namespace delf {

void RowSum::scale(double factor) {
  for (auto* terms : {&differences_, &plain_, &changes_})
    for (Term& t : *terms) t.coefficient *= factor;
  constant_ *= factor;
}

}  // namespace delf
