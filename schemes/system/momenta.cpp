// SPDX-License-Identifier: MIT
#include "schemes/system/momenta.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lattice/error.hpp"
#include "schemes/system/assembly.hpp"

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
  std::vector<Assembly::Anchor> stencils;
  for (std::size_t f = 0; f < system.families().size(); ++f) {
    const StencilFamily& family = *system.families()[f];
    const auto [low, high] = std::ranges::minmax(family.pattern().vertices, {}, &Site::time);
    int top = high.time;
    if (low.time == top) {
      // in the row alone; or in the cell above it, an element or its lower end
      if (std::ranges::none_of(family.values(), [&](const VertexValue& value) {
            const Component& c = system.component(value.component);
            return c.at.time != 0 || c.momentum;
          }))
        continue;
      ++top;
    }
    const int anchor = side == Side::below ? -top : -low.time;
    for (int i = 0; i < system.anchors(family); ++i)
      if (system.has_stencil(family, row + anchor, i)) stencils.push_back({static_cast<int>(f), {anchor, i}});
  }
  // Differences in time are those of values with low parts: no digits are lost in them.
  Window rows = window;
  if (!rows.has_low())
    for (const auto& values : rows.rows) rows.low.emplace_back(values.size(), 0.0);
  const int reach = system.height() + 1;
  const Assembly assembly(system, {.equations = {},
                                   .parity = static_cast<int>(row & 1),
                                   .past = reach,
                                   .future = reach,
                                   .monodromy = window.monodromy,
                                   .stencils = std::move(stencils)});
  std::vector<double> p(system.lattice().sites() * system.components(), 0.0);
  if (absolute) absolute->assign(p.size(), 0.0);
  assembly.each_residual(SectionRing(rows, row - reach, row + reach), row, [&](const Assembly::Local& here) {
    for (int m = 0; m < here.family.size(); ++m) {
      if (here.rows[m] != 0 || !here.family.is_varied(m)) continue;
      p[here.places[m]] += side == Side::below ? here.derivatives[m] : -here.derivatives[m];
      if (absolute) (*absolute)[here.places[m]] += std::abs(here.derivatives[m]);
    }
  });
  return p;
}

}  // namespace delf
