// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/wrapped_differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "jets/fibre.hpp"
#include "lattice/error.hpp"

namespace delf {
namespace {

/// The first site whose difference is too large; −1 if none is.
int first_too_large(const RowLayout& layout, const double* from, const double* to, std::ptrdiff_t shift) {
  Pack most(0.0);
  for (int p = 0; p < layout.packs(); ++p) {
    const auto at = layout.at(p);
    most = max_or_nan(abs(Pack::load(to + at + shift) - Pack::load(from + at)), most);
  }
  if (max_or_nan(most) <= largest_wrapped_difference) return -1;
  int site = 0;
  while (std::abs(to[layout.slot(site) + shift] - from[layout.slot(site)]) <= largest_wrapped_difference) ++site;
  return site;
}

}  // namespace

void check_wrapped_differences(const LatticeSystem& system, const RowLayout& layout,
                               const std::vector<const double*>& rows, std::int64_t newest) {
  const int d = system.components();
  const auto row = [&](std::int64_t which, int a) { return rows[(newest - which) * d + a]; };
  for (const auto& family : system.families()) {
    const auto& vertices = family->pattern().vertices;
    const int top = std::ranges::max(vertices, {}, &Site::time).time;
    for (const Site& vertex : vertices) {
      const std::int64_t from = newest - top + vertices[0].time, to = newest - top + vertex.time;
      if (std::min(from, to) < 0) continue;
      for (int a = 0; a < d; ++a) {
        const int site = first_too_large(layout, row(from, a), row(to, a),
                                         static_cast<std::ptrdiff_t>(vertex.space - vertices[0].space) * lanes);
        if (site < 0) continue;
        throw NotFinite(fmt::format(
            "step {}, t = {:.6g}, site {}: on the fibre S1 a wrapped difference within a stencil is above 0.9 pi, where "
            "it cannot be distinguished from its complement; refine the lattice, reduce lattice.courant, or use "
            "theory.fibre = R",
            newest, static_cast<double>(newest) * system.time_step(), site));
      }
    }
  }
}

}  // namespace delf
