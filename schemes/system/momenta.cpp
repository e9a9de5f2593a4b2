// SPDX-License-Identifier: MIT
#include "schemes/system/momenta.hpp"

#include <algorithm>
#include <cmath>

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
  std::vector<double> p(static_cast<std::size_t>(N * C), 0.0), y, rest, r;
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
    for (int i = 0; i < system.anchors(*family); ++i) {
      if (!system.has_stencil(*family, anchor, i)) continue;
      y.clear(), rest.clear();
      for (int m = 0; m < family->size(); ++m) {
        const Site v = family->site(m);
        const int c = family->values()[static_cast<std::size_t>(m)].component;
        y.push_back(window(anchor + v.time, family->column(i, m), c));
        rest.push_back(window.low_part(anchor + v.time, family->column(i, m), c));
      }
      r.resize(y.size());
      family->residual(
          {system.times()->step(anchor), lattice.space_step(), system.times()->time(anchor),
           family->listed() ? 0 : lattice.position(i), i},
          y, rest, r);
      for (int m = 0; m < family->size(); ++m) {
        const Site v = family->site(m);
        if (anchor + v.time != row || !family->is_varied(m)) continue;
        const int x = family->column(i, m), home = lattice.home(x);
        const int c = family->values()[static_cast<std::size_t>(m)].component;
        p[static_cast<std::size_t>(home * C + c)] +=
            side == Side::below ? r[static_cast<std::size_t>(m)] : -r[static_cast<std::size_t>(m)];
        if (absolute) (*absolute)[static_cast<std::size_t>(home * C + c)] += std::abs(r[static_cast<std::size_t>(m)]);
      }
    }
  }
  return p;
}

}  // namespace delf
