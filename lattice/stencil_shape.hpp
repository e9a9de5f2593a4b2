// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "lattice/site.hpp"

namespace delf {

/// At which sites of the lattice a stencil is anchored.
enum class Placement {
  every_site,   ///< one stencil for each site
  brick_wall,   ///< only where time + space is even, so that rows of bricks are laid half a brick apart
  left_wall,    ///< at the first column of an interval: a term of the boundary, for the walls that need it
  right_wall,   ///< at the last column, likewise
  left_mirror,  ///< at the first column of an interval, whatever its wall: what wide stencils have beyond it
  right_mirror  ///< at the last column, likewise
};

/// A tuple of n sites, written as offsets from its anchor; the order is that of the paper's Δ¹, Δ², …, Δⁿ.
///
///     inline constexpr Offsets<3> triangle{{{{0, 0}, {1, 0}, {1, 1}}}};          // {time, space}
///
template <int n>
struct Offsets {
  std::array<Site, n> vertices;
  Placement placement = Placement::every_site;

  static constexpr int size() { return n; }
  /// Δˡ relative to the anchor, l = 0 … n−1 (the paper counts from 1).
  constexpr Site vertex(int l) const { return vertices[l]; }
};

/// The concept of a stencil shape: `size()`, `vertex(l)` for l = 0 … size()−1, and a `placement`. A list of offsets,
/// `delf::Offsets<n>{{{{time, space}, …}}}`, has them all.
template <class S>
concept StencilShape = requires(const S& shape) {
  { S::size() } -> std::convertible_to<int>;              // how many vertices: static constexpr int size()
  { shape.vertex(0) } -> std::convertible_to<Site>;       // the offset {time, space} of vertex l from the anchor
  { shape.placement } -> std::convertible_to<Placement>;  // every_site, or brick_wall
};

/// A stencil shape whose number of vertices is known at run time only; regions, plans and checks use it.
struct StencilPattern {
  std::vector<Site> vertices;
  Placement placement = Placement::every_site;

  StencilPattern() = default;
  StencilPattern(std::vector<Site> v, Placement p = Placement::every_site) : vertices(std::move(v)), placement(p) {}
  template <StencilShape S>
  explicit StencilPattern(const S& shape) : placement(shape.placement) {
    for (int l = 0; l < S::size(); ++l) vertices.push_back(shape.vertex(l));
  }
  int size() const { return static_cast<int>(vertices.size()); }
  /// True if a stencil of this pattern is anchored at `site`, without regard to walls.
  bool placed_at(Site site) const { return placement != Placement::brick_wall || (site.time + site.space) % 2 == 0; }
  /// It stands at a wall alone: all of space, and a circle, have none.
  bool is_of_wall() const { return placement != Placement::every_site && placement != Placement::brick_wall; }
};

/// One of the numbers that a stencil reads: the component `component` of the section at a vertex of its pattern.
/// Fields, the nodes inside an element and multipliers are all components.
struct VertexValue {
  int vertex = 0, component = 0;

  friend bool operator==(const VertexValue&, const VertexValue&) = default;
};

}  // namespace delf
