// SPDX-License-Identifier: MIT
#include "schemes/stepping/mesh_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/families/mapped_family.hpp"

namespace delf {

MeshWatch::MeshWatch(const LatticeSystem& system) : system_(system) {
  for (const auto& family : system.families())
    if (family->moving_cell()) stages_.push_back(family.get());
}

std::optional<int> MeshWatch::crossing(const double* row) const {
  for (int c = 0; c < system_.components(); ++c)
    for (int i = 0; system_.component(c).position && i + 1 < system_.lattice().sites(); ++i)
      if (!(row[i * system_.components() + c] < row[(i + 1) * system_.components() + c])) return i;
  return std::nullopt;
}

std::string MeshWatch::crossing_at(const SectionRing& ring, std::int64_t row) const {
  if (const auto i = crossing(ring.row(row)))
    return fmt::format("sites {} and {} of the mesh pass each other", *i, *i + 1);
  for (const StencilFamily* stage : stages_) {
    int top = 0;
    for (const Site& vertex : stage->pattern().vertices) top = std::max(top, vertex.time);
    for (int i = 0; i + 1 < system_.lattice().sites(); ++i) {
      double size = 0;
      for (const auto& [value, weight] : stage->moving_cell()->width) {
        const Site site = stage->site(value);
        const int component = stage->values()[value].component;
        size += weight * ring.row(row - top + site.time)[(i + site.space) * system_.components() + component];
      }
      if (!(size > 0))
        return fmt::format("sites {} and {} of the mesh pass each other at {:.3g} of the step", i, i + 1,
                           stage->moving_cell()->time);
    }
  }
  return {};
}

std::string MeshWatch::narrowest_cell(const double* row) const {
  double least = std::numeric_limits<double>::infinity();
  int where = 0;
  for (int c = 0; c < system_.components(); ++c)
    for (int i = 0; system_.component(c).position && i + 1 < system_.lattice().sites(); ++i)
      if (const double size = row[(i + 1) * system_.components() + c] - row[i * system_.components() + c]; size < least)
        least = size, where = i;
  return fmt::format("sites {} and {} are {:.2g} apart, closer than any others", where, where + 1, least);
}

}  // namespace delf
