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

Stencils::Stencils(const Lattice& lattice, std::vector<StencilPattern> families,
                   std::vector<const ListedStencils*> lists)
    : lattice_(lattice), families_(std::move(families)), lists_(std::move(lists)) {
  lists_.resize(families_.size(), nullptr);
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
  // Stencils are anchored at the vertices of the lattice.
  if (anchor.node != 0) return false;
  if (const ListedStencils* const listed = lists_[family]) return 0 <= anchor.space && anchor.space < listed->size();
  return has_stencil(lattice_, families_[family], anchor);
}

Site Stencils::vertex(int family, Site anchor, int l) const {
  const Site offset = families_[family].vertices[l];
  if (const ListedStencils* const listed = lists_[family])
    return {anchor.time + offset.time, listed->site(anchor.space, offset.space), offset.node};
  return reduced(anchor + offset);
}

std::optional<Stencil> Stencils::find(int family, Site anchor) const {
  if (!exists(family, anchor)) return std::nullopt;
  Stencil stencil{family, reduced(anchor), {}};
  for (int l = 0; l < families_[family].size(); ++l) stencil.sites.push_back(vertex(family, anchor, l));
  return stencil;
}

std::vector<Stencil> Stencils::touching(Site site) const {
  std::vector<Stencil> found;
  for (int family = 0; family < static_cast<int>(families_.size()); ++family)
    for (int l = 0; l < families_[family].size(); ++l)
      with_vertex(family, l, site, [&](Site anchor) {
        Stencil stencil = *find(family, anchor);
        // A stencil that is longer than its circle meets a site with more than one vertex.
        if (std::ranges::find(found, stencil) == found.end()) found.push_back(std::move(stencil));
      });
  return found;
}

}  // namespace delf
