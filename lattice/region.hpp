// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "lattice/lattice.hpp"
#include "lattice/site.hpp"
#include "lattice/site_set.hpp"
#include "lattice/stencil.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// The integers first, first+1, …, last.
struct Range {
  int first = 0, last = 0;
};

/// A finite set U of sites, with its interior, closure and boundary as Marsden–Patrick–Shkoller, §5.1, define them, for
/// any list of stencil families: all of them count together.
///
///     int U   the sites of U that some stencil touches, and of which U holds every stencil that touches them
///     cl U    the union of all stencils that touch int U
///     ∂U      (U ∩ cl U) \ int U
///
class Region {
 public:
  /// True for sites that are data and have no equation. They are in no int U, and those of cl U are in ∂U, where first
  /// variations are as free as at its other sites. None: every site that stencils touch has equations.
  using IsData = std::function<bool(Site)>;

  /// Sites in any order; on a circle they are reduced to 0 … N−1. Throws BadInput "lattice.sites" for a site outside an
  /// interval, and what Stencils throws.
  static Region from_sites(Stencils, std::vector<Site> sites, IsData = {});
  static Region from_sites(const Lattice& lattice, std::vector<StencilPattern> families, std::vector<Site> sites) {
    return from_sites(Stencils(lattice, std::move(families)), std::move(sites));
  }
  /// All sites of the rows `time` and the columns `space`. On a circle the columns may run past N−1.
  static Region rectangle(const Lattice&, std::vector<StencilPattern> families, Range time, Range space);

  const Lattice& lattice() const { return all_.lattice(); }
  /// The stencils of the lattice, and its data.
  const Stencils& all() const { return all_; }
  const IsData& is_data() const { return is_data_; }

  // Each sorted by time, then space.
  const std::vector<Site>& sites() const { return u_.sites(); }
  const std::vector<Site>& interior() const { return interior_.sites(); }
  const std::vector<Site>& closure() const { return closure_.sites(); }
  const std::vector<Site>& boundary() const { return boundary_.sites(); }

  bool contains(Site site) const { return u_.contains(all_.reduced(site)); }
  bool in_interior(Site site) const { return interior_.contains(all_.reduced(site)); }
  bool in_closure(Site site) const { return closure_.contains(all_.reduced(site)); }
  bool in_boundary(Site site) const { return boundary_.contains(all_.reduced(site)); }
  /// U is exactly int U ∪ ∂U.
  bool regular() const { return interior_.size() + boundary_.size() == u_.size(); }

  /// The place of a site of U in sites(), or sites().size() for any other.
  std::size_t place(Site site) const { return u_.index(all_.reduced(site)); }
  /// Calls visit(family, anchor, places of its vertices in sites()) for every stencil Δ ⊂ U, in a fixed order.
  void visit_stencils(const std::function<void(int, Site, std::span<const std::size_t>)>& visit) const;

 private:
  Region(Stencils all, SiteSet u, IsData);

  Stencils all_;
  IsData is_data_;
  SiteSet u_, interior_, closure_, boundary_;
};

}  // namespace delf
