// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <vector>

#include "lattice/index.hpp"
#include "tests/schemes/complex/lattice_complex.hpp"
#include "tests/schemes/support.hpp"

namespace delf::testing {

/// Some first rows of a lattice as values of its complex; later rows begin as the last of them.
inline std::vector<double> first_values(const LatticeComplex& whole, const std::vector<Row>& rows, int count) {
  std::vector<double> y(whole.system.nodes());
  for (int j = 0; j < count; ++j) {
    const Row& row = rows[std::min(at(j), rows.size() - 1)];
    for (std::size_t i = 0; i < row.size(); ++i) y[whole.site(j, static_cast<int>(i))] = row[i];
  }
  return y;
}

}  // namespace delf::testing
