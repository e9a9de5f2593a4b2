// SPDX-License-Identifier: MIT
#include "schemes/system/momenta.hpp"

#include <algorithm>
#include <utility>

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

namespace {

Assembly::Parts half_of_row(const LatticeSystem& system, Side side, double monodromy, int parity) {
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
      if (system.has_stencil(family, parity + anchor, i)) stencils.push_back({static_cast<int>(f), {anchor, i}});
  }
  const int reach = system.height() + 1;
  Assembly::Parts parts{.equations = {},
                        .parity = parity,
                        .past = side == Side::below ? reach : 0,
                        .future = side == Side::below ? 0 : reach,
                        .monodromy = monodromy,
                        .stencils = std::move(stencils)};
  for (int i = 0; i < system.lattice().sites(); ++i)
    for (int c = 0; c < system.components(); ++c) parts.equations.push_back({{0, i}, c});
  return parts;
}

}  // namespace

HalfEquations::HalfEquations(const LatticeSystem& system, Side side, double monodromy, int parity)
    : side_(side), reach_(system.height() + 1), assembly_(system, half_of_row(system, side, monodromy, parity)) {}

std::vector<double> HalfEquations::operator()(const Window& window, std::int64_t row,
                                              std::vector<double>* absolute) const {
  std::vector<double> E;
  const bool below = side_ == Side::below;
  assembly_.residual(SectionRing(window, below ? row - reach_ : row, below ? row : row + reach_), row, E, absolute);
  for (double& e : E) e = below ? e : -e;
  return E;
}

Window with_low_parts(Window window) {
  if (!window.has_low())
    for (const auto& values : window.rows) window.low.emplace_back(values.size(), 0.0);
  return window;
}

std::vector<double> half_equations(const LatticeSystem& system, const Window& window, std::int64_t row, Side side,
                                   std::vector<double>* absolute) {
  const HalfEquations half(system, side, window.monodromy, static_cast<int>(row & 1));
  return half(with_low_parts(window), row, absolute);
}

}  // namespace delf
