// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <span>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"
#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The stencils of a listed family that read one row, values[site·components + c], with h = k = 1 at a time t: calls
/// use(batch, stencils in it) for some at once, whose numbers follow each other. The last batch is filled up with copies.
template <class Use>
void each_listed_strip(const StencilFamily& family, std::span<const double> values, int components, double t,
                       const Use& use) {
  constexpr int most = 64;
  const int stencils = family.listed()->size();
  const ScratchRows x(1, most);
  std::fill_n(x[0], most, 0.0);  // listed stencils have places of their own
  for (int first = 0; first < stencils; first += most) {
    const int own = std::min(most, stencils - first), count = (own + lanes - 1) / lanes * lanes;
    std::array<int, most> numbers{};
    for (int s = 0; s < count; ++s) numbers[s] = first + std::min(s, own - 1);
    const ScratchRows y(family.size(), count);
    for (int i = 0; i < family.size(); ++i)
      for (int s = 0; s < count; ++s)
        y[i][s] = values[family.column(numbers[s], i) * components + family.values()[i].component];
    use(StencilBatch{{1, 1, t, 0}, count, x[0], y[0], nullptr, numbers.data()}, own);
  }
}

}  // namespace delf
