// SPDX-License-Identifier: MIT
#include "lattice/stencil.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "lattice/error.hpp"

namespace delf {

void require_closing(const Lattice& lattice, Placement placement) {
  if (placement == Placement::brick_wall && lattice.is_circle() && lattice.sites() % 2 != 0)
    throw BadInput("lattice.sites", "lattice.sites = " + std::to_string(lattice.sites()) +
                                        ": a brick wall closes on a circle only if the number of sites is even; take " +
                                        std::to_string(lattice.sites() + 1));
}

bool has_column(const Lattice& lattice, const StencilPattern& pattern, int column) {
  if (pattern.is_of_wall()) {
    const bool left = pattern.placement == Placement::left_wall || pattern.placement == Placement::left_mirror;
    return lattice.space() == Space::interval && column == (left ? 0 : lattice.sites() - 1);
  }
  return lattice.is_circle() || std::ranges::all_of(pattern.vertices, [&](Site offset) {
           const int x = column + offset.space;
           return 0 <= x && x < lattice.sites();
         });
}

bool has_stencil(const Lattice& lattice, const StencilPattern& pattern, Site anchor) {
  return pattern.placed_at(anchor) && has_column(lattice, pattern, anchor.space);
}

Stencils::Stencils(const Lattice& lattice, std::vector<StencilPattern> families)
    : lattice_(lattice), families_(std::move(families)) {
  if (families_.empty()) throw BadInput("lattice.stencil", "lattice.stencil: no stencil family is given; name one");
  for (const StencilPattern& pattern : families_) {
    if (pattern.size() == 0)
      throw BadInput("lattice.stencil", "lattice.stencil: a stencil has no vertices and touches nothing; list them");
    require_closing(lattice_, pattern.placement);
  }
}

Site Stencils::reduced(Site site) const { return {site.time, lattice_.home(site.space), site.node}; }

bool Stencils::in_lattice(Site site) const {
  return lattice_.is_circle() || (0 <= site.space && site.space < lattice_.sites());
}

bool Stencils::exists(int family, Site anchor) const {
  const StencilPattern& pattern = families_[family];
  // Stencils are anchored at the vertices of the lattice.
  return anchor.node == 0 && has_stencil(lattice_, pattern, anchor);
}

std::optional<Stencil> Stencils::find(int family, Site anchor) const {
  if (!exists(family, anchor)) return std::nullopt;
  const StencilPattern& pattern = families_[family];
  Stencil stencil{family, reduced(anchor), {}};
  stencil.sites.reserve(pattern.vertices.size());
  for (const Site offset : pattern.vertices) stencil.sites.push_back(reduced(anchor + offset));
  return stencil;
}

std::vector<Stencil> Stencils::touching(Site site) const {
  std::vector<Stencil> found;
  for (int family = 0; family < static_cast<int>(families_.size()); ++family)
    for (const Site offset : families_[family].vertices) {
      auto stencil = find(family, site - offset);
      // A stencil that is longer than its circle meets a site with more than one vertex.
      if (stencil && std::ranges::find(found, *stencil) == found.end()) found.push_back(std::move(*stencil));
    }
  return found;
}

}  // namespace delf
