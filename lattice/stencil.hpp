// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "lattice/lattice.hpp"
#include "lattice/site.hpp"
#include "lattice/space/listed_stencils.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// A stencil Δ: an ordered tuple of sites.
struct Stencil {
  int family = 0;  ///< which of the stencil families it belongs to
  Site anchor;
  std::vector<Site> sites;  ///< on a circle, space indices are 0 … N−1

  int size() const { return static_cast<int>(sites.size()); }
  /// Δˡ, l = 0 … n−1 (the paper counts from 1).
  Site vertex(int l) const { return sites[l]; }

  friend bool operator==(const Stencil&, const Stencil&) = default;
};

/// True if stencils of this pattern are anchored in a column, in some of its rows or in all of them: all their vertices
/// lie in the lattice, and those of a natural wall stand there.
bool has_column(const Lattice&, const StencilPattern&, int column);

/// True if there is a stencil of this pattern at `anchor`: it is placed there, and all its vertices lie in the lattice.
bool has_stencil(const Lattice&, const StencilPattern&, Site anchor);

/// X^Δ: all the stencils of some families on a lattice. A stencil exists if its family places one at the anchor and
/// all its vertices lie in the lattice; where stencils do not repeat, if its family lists it: then every row has it, and
/// the space of its anchor is its number.
class Stencils {
 public:
  /// `lists` are those of the families, null for families of patterns; they outlive the stencils. Throws BadInput:
  /// "lattice.stencil" without families or vertices, "lattice.sites" if a brick wall does not close.
  Stencils(const Lattice&, std::vector<StencilPattern> families, std::vector<const ListedStencils*> lists = {});

  const Lattice& lattice() const { return lattice_; }
  const std::vector<StencilPattern>& families() const { return families_; }

  /// The site with its space index in 0 … N−1 on a circle; itself on an interval.
  Site reduced(Site site) const;
  bool in_lattice(Site site) const;
  /// The stencil of a family at an anchor, if there is one.
  std::optional<Stencil> find(int family, Site anchor) const;
  bool exists(int family, Site anchor) const;
  /// Δˡ of the stencil of a family at an anchor.
  Site vertex(int family, Site anchor, int l) const;
  /// Calls use(anchor) for every stencil of a family whose vertex l is the site.
  template <class Use>
  void with_vertex(int family, int l, Site site, const Use& use) const {
    const Site offset = families_[family].vertices[l];
    if (const ListedStencils* const listed = lists_[family]; listed == nullptr) {
      if (const Site anchor = site - offset; exists(family, anchor)) use(anchor);
    } else if (site.node == offset.node) {
      for (const auto& [stencil, place] : listed->touching(site.space))
        if (place == offset.space) use(Site{site.time - offset.time, stencil});
    }
  }
  /// Every stencil that touches the site, that is, has it as a vertex.
  std::vector<Stencil> touching(Site site) const;

 private:
  Lattice lattice_;
  std::vector<StencilPattern> families_;
  std::vector<const ListedStencils*> lists_;  ///< of each family
};

/// A brick wall closes on a circle of even N only: throws BadInput "lattice.sites" otherwise.
void require_closing(const Lattice&, Placement);

}  // namespace delf
