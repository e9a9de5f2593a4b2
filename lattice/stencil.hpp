// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "lattice/lattice.hpp"
#include "lattice/site.hpp"
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
/// all its vertices lie in the lattice.
class Stencils {
 public:
  /// Throws BadInput: "lattice.stencil" without families or vertices, "lattice.sites" if a brick wall does not close.
  Stencils(const Lattice&, std::vector<StencilPattern> families);

  const Lattice& lattice() const { return lattice_; }
  const std::vector<StencilPattern>& families() const { return families_; }

  /// The site with its space index in 0 … N−1 on a circle; itself on an interval.
  Site reduced(Site site) const;
  bool in_lattice(Site site) const;
  /// The stencil of a family at an anchor, if there is one.
  std::optional<Stencil> find(int family, Site anchor) const;
  bool exists(int family, Site anchor) const;
  /// Every stencil that touches the site, that is, has it as a vertex.
  std::vector<Stencil> touching(Site site) const;

 private:
  Lattice lattice_;
  std::vector<StencilPattern> families_;
};

/// A brick wall closes on a circle of even N only: throws BadInput "lattice.sites" otherwise.
void require_closing(const Lattice&, Placement);

}  // namespace delf
