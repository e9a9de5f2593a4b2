// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <functional>
#include <string>

#include "lattice/complex/complex.hpp"
#include "schemes/complex/stencil_list.hpp"

namespace delf::testing {

/// The stencils of a complex of one shape as a list.
inline StencilList list_of(const Complex& complex, const std::string& shape, double circumference) {
  StencilList list;
  list.circumference = circumference;
  for (int s = 0; s < complex.sites(); ++s) list.sites.push_back({complex.position(s), complex.role(s)});
  for (int s = 0; s < complex.stencils(); ++s)
    list.stencils.push_back({shape, {complex.vertices(s).begin(), complex.vertices(s).end()}});
  return list;
}

/// Two rows of rectangles and two of triangles in turn over 0 ≤ x ≤ 3, on lines that are bent unless `amount` is 0. Walls
/// and two rows are data.
inline StencilList bent_rows(int sites, int rows, double amount = 0.05) {
  StencilList list;
  const double k = 3.0 / (sites - 1), h = 0.4 * k;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < sites; ++i) {
      const bool wall = i == 0 || i == sites - 1;
      const double bend = wall ? 0 : amount * std::sin(2 * k * i) * std::sin(3 * h * j);
      list.sites.push_back({{h * j + bend, k * i + bend, 0, 0},
                            wall || j == 0  ? SiteRole::given
                            : j == 1        ? SiteRole::initial
                            : j == rows - 1 ? SiteRole::final
                                            : SiteRole::free});
    }
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < sites; ++i) {
      const int a = j * sites + i, b = a + 1, c = a + sites, d = c + 1;
      if (j % 4 < 2) list.stencils.push_back({"rectangle", {a, c, d, b}});
      else list.stencils.push_back({"triangle", {a, c, b}, 0.5}), list.stencils.push_back({"triangle", {b, c, d}, 0.5});
    }
  return list;
}

/// Six-tuples on rows of sites x(i), i from 0 to sites − 1, around a circle.
inline StencilList beam_rows(int sites, int rows, double length, double h, const std::function<double(int)>& x) {
  StencilList list;
  list.circumference = length;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < sites; ++i)
      list.sites.push_back({{h * j, x(i), 0, 0},
                            j == 0          ? SiteRole::given
                            : j == 1        ? SiteRole::initial
                            : j == rows - 1 ? SiteRole::final
                                            : SiteRole::free});
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i < sites; ++i) {
      const int a = j * sites + (i + sites - 1) % sites, b = j * sites + i, c = j * sites + (i + 1) % sites;
      list.stencils.push_back({"six-tuple", {a, b, c, c + sites, b + sites, a + sites}});
    }
  return list;
}

}  // namespace delf::testing
