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
    for (int l = 0; l < all.families()[family].size(); ++l) all.with_vertex(family, l, site, [&](Site) { ++count; });
  return count;
}

/// Calls visit(family, anchor, places of its vertices in U) for every stencil Δ ⊂ U.
template <class Visit>
void for_stencils_inside(const Stencils& all, const SiteSet& u, Visit visit) {
  std::vector<std::size_t> places;
  for (int family = 0; family < static_cast<int>(all.families().size()); ++family)
    for (const Site site : u.sites())
      all.with_vertex(family, 0, site, [&](Site anchor) {
        places.clear();
        for (int l = 0; l < all.families()[family].size(); ++l) {
          places.push_back(u.index(all.vertex(family, anchor, l)));
          if (places.back() == u.size()) return;
        }
        visit(family, anchor, places);
      });
}

}  // namespace

Region Region::from_sites(Stencils all, std::vector<Site> sites, IsData is_data) {
  const Lattice& lattice = all.lattice();
  for (Site& site : sites) {
    if (!all.in_lattice(site))
      throw BadInput("lattice.sites", "lattice.sites = " + std::to_string(lattice.sites()) +
                                          ": a region reaches column " + std::to_string(site.space) +
                                          ", but the interval ends at " + std::to_string(lattice.sites() - 1) +
                                          "; keep it within the walls");
    site = all.reduced(site);
  }
  return Region(std::move(all), SiteSet(std::move(sites)), std::move(is_data));
}

Region Region::rectangle(const Lattice& lattice, std::vector<StencilPattern> families, Range time, Range space) {
  std::vector<Site> sites;
  for (int j = time.first; j <= time.last; ++j)
    for (int i = space.first; i <= space.last; ++i) sites.push_back({j, i});
  return from_sites(lattice, std::move(families), std::move(sites));
}

Region::Region(Stencils all, SiteSet u, IsData is_data)
    : all_(std::move(all)), is_data_(std::move(is_data)), u_(std::move(u)) {
  // U holds every stencil that touches a site when as many vertices of stencils Δ ⊂ U meet there as of any stencils.
  std::vector<int> held(u_.size(), 0);
  for_stencils_inside(all_, u_, [&](int, Site, const std::vector<std::size_t>& places) {
    for (const std::size_t place : places) ++held[place];
  });
  std::vector<char> interior(u_.size()), closure(u_.size());
  for (std::size_t n = 0; n < u_.size(); ++n)
    interior[n] = held[n] > 0 && held[n] == vertices_at(all_, sites()[n]) && !(is_data_ && is_data_(sites()[n]));

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

}  // namespace delf
