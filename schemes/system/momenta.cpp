// SPDX-License-Identifier: MIT
#include "schemes/system/momenta.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"

namespace delf {

void require_lagrangian(const LatticeSystem& system) {
  if (!is_variational(system))
    throw BadInput("scheme.method",
                   "scheme.method: momenta are derivatives of a discrete Lagrangian, and this scheme "
                   "has none; use a variational one");
}

std::vector<double> momenta(const LatticeSystem& system, const Window& window, std::int64_t row, Side side) {
  require_lagrangian(system);
  return half_equations(system, window, row, side);
}

std::vector<double> half_equations(const LatticeSystem& system, const Window& window, std::int64_t row, Side side,
                                   std::vector<double>* absolute) {
  const Lattice& lattice = system.lattice();
  const int C = system.components(), N = lattice.sites();
  std::vector<double> p(N * C, 0.0);
  constexpr std::size_t most = 64;  // stencils at once
  const ScratchRows x(1, most);
  if (absolute) absolute->assign(p.size(), 0.0);
  for (const auto& family : system.families()) {
    const auto [low, high] = std::ranges::minmax(family->pattern().vertices, {}, &Site::time);
    int top = high.time;
    if (low.time == top) {
      // in the row alone; or in the cell above it, an element or its lower end
      if (std::ranges::none_of(family->values(), [&](const VertexValue& value) {
            const Component& c = system.component(value.component);
            return c.at.time != 0 || c.momentum;
          }))
        continue;
      ++top;
    }
    const std::int64_t anchor = row - (side == Side::below ? top : low.time);
    const auto& values = family->values();
    const std::size_t size = family->size();
    std::vector<int> anchors;
    for (int i = 0; i < system.anchors(*family); ++i)
      if (system.has_stencil(*family, anchor, i)) anchors.push_back(i);
    for (std::size_t first = 0; first < anchors.size(); first += most) {
      const std::size_t own = std::min(most, anchors.size() - first), count = (own + lanes - 1) / lanes * lanes;
      std::array<int, most> numbers{};
      for (std::size_t s = 0; s < count; ++s) {
        numbers[s] = anchors[first + std::min(s, own - 1)];  // the last one fills whole packs
        x[0][s] = family->listed() ? 0 : lattice.position(numbers[s]);
      }
      const ScratchRows y(2, static_cast<int>(size * count)), r(1, static_cast<int>(size * count));
      for (std::size_t m = 0; m < size; ++m)
        for (std::size_t s = 0; s < count; ++s) {
          const std::int64_t at = anchor + family->site(static_cast<int>(m)).time;
          const int column = family->column(numbers[s], static_cast<int>(m));
          y[0][m * count + s] = window(at, column, values[m].component);
          y[1][m * count + s] = window.low_part(at, column, values[m].component);
        }
      family->residual(
          StencilBatch{{system.times()->step(anchor), lattice.space_step(), system.times()->time(anchor), 0},
                       static_cast<int>(count),
                       x[0],
                       y[0],
                       family->reads_low() ? y[1] : nullptr,
                       numbers.data()},
          r[0]);
      for (std::size_t m = 0; m < size; ++m) {
        if (anchor + family->site(static_cast<int>(m)).time != row || !family->is_varied(static_cast<int>(m))) continue;
        for (std::size_t s = 0; s < own; ++s) {
          const double here = r[0][m * count + s];
          const std::size_t n = lattice.home(family->column(numbers[s], static_cast<int>(m))) * C + values[m].component;
          p[n] += side == Side::below ? here : -here;
          if (absolute) (*absolute)[n] += std::abs(here);
        }
      }
    }
  }
  return p;
}

}  // namespace delf
