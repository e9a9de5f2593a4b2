// SPDX-License-Identifier: MIT
#include "lattice/region.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "lattice/error.hpp"

namespace delf {
namespace {

/// The number of vertices of stencils of the lattice at a site.
int vertices_at(const Stencils& all, Site site) {
  int count = 0;
  for (int family = 0; family < static_cast<int>(all.families().size()); ++family)
    for (const Site offset : all.families()[family].vertices) count += all.exists(family, site - offset) ? 1 : 0;
  return count;
}

/// Calls visit(family, anchor, places of its vertices in U) for every stencil Δ ⊂ U.
template <class Visit>
void for_stencils_inside(const Stencils& all, const SiteSet& u, Visit visit) {
  std::vector<std::size_t> places;
  for (int family = 0; family < static_cast<int>(all.families().size()); ++family) {
    const StencilPattern& pattern = all.families()[family];
    for (const Site site : u.sites()) {
      const Site anchor = site - pattern.vertices.front();
      if (!all.exists(family, anchor)) continue;
      places.clear();
      for (const Site offset : pattern.vertices) {
        places.push_back(u.index(all.reduced(anchor + offset)));
        if (places.back() == u.size()) break;
      }
      if (places.back() != u.size()) visit(family, anchor, places);
    }
  }
}

}  // namespace

Region Region::from_sites(const Lattice& lattice, std::vector<StencilPattern> families, std::vector<Site> sites) {
  Stencils all(lattice, std::move(families));
  for (Site& site : sites) {
    if (!all.in_lattice(site))
      throw BadInput("lattice.sites", "lattice.sites = " + std::to_string(lattice.sites()) +
                                          ": a region reaches column " + std::to_string(site.space) +
                                          ", but the interval ends at " + std::to_string(lattice.sites() - 1) +
                                          "; keep it within the walls");
    site = all.reduced(site);
  }
  return Region(std::move(all), SiteSet(std::move(sites)));
}

Region Region::rectangle(const Lattice& lattice, std::vector<StencilPattern> families, Range time, Range space) {
  std::vector<Site> sites;
  for (int j = time.first; j <= time.last; ++j)
    for (int i = space.first; i <= space.last; ++i) sites.push_back({j, i});
  return from_sites(lattice, std::move(families), std::move(sites));
}

Region::Region(Stencils all, SiteSet u) : all_(std::move(all)), u_(std::move(u)) {
  // U holds every stencil that touches a site when as many vertices of stencils Δ ⊂ U meet there as of any stencils.
  std::vector<int> held(u_.size(), 0);
  for_stencils_inside(all_, u_, [&](int, Site, const std::vector<std::size_t>& places) {
    for (const std::size_t place : places) ++held[place];
  });
  std::vector<char> interior(u_.size()), closure(u_.size());
  for (std::size_t n = 0; n < u_.size(); ++n) interior[n] = held[n] > 0 && held[n] == vertices_at(all_, sites()[n]);

  // cl U: the stencils that touch int U all lie in U.
  for_stencils_inside(all_, u_, [&](int, Site, const std::vector<std::size_t>& places) {
    if (std::ranges::any_of(places, [&](std::size_t place) { return interior[place]; }))
      for (const std::size_t place : places) closure[place] = true;
  });

  std::vector<Site> inside, closed, edge;
  for (std::size_t n = 0; n < u_.size(); ++n) {
    if (interior[n]) inside.push_back(sites()[n]);
    if (closure[n]) closed.push_back(sites()[n]);
    if (closure[n] && !interior[n]) edge.push_back(sites()[n]);
  }
  interior_ = SiteSet(std::move(inside));
  closure_ = SiteSet(std::move(closed));
  boundary_ = SiteSet(std::move(edge));
}

void Region::visit_stencils(const std::function<void(int, Site, std::span<const std::size_t>)>& visit) const {
  for_stencils_inside(all_, u_, [&](int family, Site anchor, const std::vector<std::size_t>& places) {
    visit(family, anchor, places);
  });
}

bool Region::contains(const Stencil& stencil) const {
  return std::ranges::all_of(stencil.sites, [&](Site site) { return contains(site); });
}

std::vector<Stencil> Region::stencils() const {
  std::vector<Stencil> found;
  for_stencils_inside(all_, u_, [&](int family, Site anchor, const std::vector<std::size_t>&) {
    found.push_back(*all_.find(family, anchor));
  });
  return found;
}

std::vector<Stencil> Region::boundary_stencils() const {
  std::vector<Stencil> found;
  for_stencils_inside(all_, u_, [&](int family, Site anchor, const std::vector<std::size_t>& places) {
    if (std::ranges::any_of(places, [&](std::size_t place) { return boundary_.contains(sites()[place]); }))
      found.push_back(*all_.find(family, anchor));
  });
  return found;
}

Region united(const Region& U, const Region& V) {
  std::vector<Site> sites = U.sites();
  sites.insert(sites.end(), V.sites().begin(), V.sites().end());
  return Region::from_sites(U.lattice(), U.families(), std::move(sites));
}

Region without(const Region& U, const Region& V) {
  std::vector<Site> sites;
  std::ranges::set_difference(U.sites(), V.sites(), std::back_inserter(sites));
  return Region::from_sites(U.lattice(), U.families(), std::move(sites));
}

}  // namespace delf
