// SPDX-License-Identifier: MIT
#include "tools/run/moves_walls.hpp"

#include <algorithm>

#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/system/conserved.hpp"

namespace delf {

bool moves_walls(const LinearSymmetry& symmetry, std::span<const double> row, const Problem& problem) {
  const std::size_t d = symmetry.shift.size();
  for (std::size_t n = 0; n < row.size(); ++n)
    if (problem.lattice.is_fixed(static_cast<int>(n / d)) && generator_at(symmetry, n % d, row.data() + n - n % d) != 0)
      return true;
  const auto not_zero = [](double x) { return x != 0; };
  return has_driven_boundary(problem) &&
         (std::ranges::any_of(symmetry.shift, not_zero) || std::ranges::any_of(symmetry.matrix, not_zero));
}

}  // namespace delf
