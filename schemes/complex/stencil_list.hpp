// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/complex/complex.hpp"
#include "lattice/space/mesh.hpp"

namespace delf {

/// A finite complex as it is written down: sites in spacetime, and stencils of any shapes, each an ordered list of sites.
struct StencilList {
  struct Site {
    Complex::Position position{};  ///< t, x, y, z
    SiteRole role = SiteRole::free;
    int line = 0;  ///< of the file, or 0
  };
  struct Entry {
    std::string shape;
    std::vector<int> sites;
    std::optional<double> share = {};  ///< see StencilShapeKind
    int line = 0;
  };
  std::vector<Site> sites;
  std::vector<Entry> stencils;
  double circumference = 0;  ///< of the circle that x runs around; 0: a line

  /// How many of t, x, y, z the sites need: 2 at least.
  int coordinates() const;
  /// Of a stencil's sites; on a circle each is the nearest to the first.
  std::vector<Complex::Position> positions(const Entry&) const;
  /// The sites around a stencil, in the order of the lattice's shape, without one in its middle; none if it lies across the seam
  /// of a circle. Of motion, site and gradient all, as listed.
  std::vector<int> outline(const Entry&) const;
};

/// What a stencil of a list may be.
///
///     triangle, rectangle, …   the tables of lattice.stencil, in the plane of t and x, with jets from the coordinates
///     motion I J               T of the pair, site J above site I; its share is the mass A, |Δ| = A (t_J − t_I)
///     site I                   V at a site without its gradient; the share is |Δ|
///     gradient I J [K [L]]     the gradient in V, on a segment, triangle or quadrilateral of space; the share is a time
///
/// The last three are for densities T(φ_t) + V(φ, ∇φ), in space of any dimension: see SpaceTables. The share of a table is
/// what one stencil stands for of t_τ x_ξ − x_τ t_ξ, the cell that it spans: that of the lattice unless it is given.
struct StencilShapeKind {
  const StencilTable* table = nullptr;  ///< nullptr: a part of T + V
  int least = 0, most = 0;              ///< sites
};
/// Nothing for a name that is none.
std::optional<StencilShapeKind> stencil_shape(std::string_view name);
std::vector<std::string> stencil_shape_names();

/// The points of a table on sites that lie anywhere. The table's jets of the coordinates themselves give the map,
///
///     φ_τ = t_τ φ_t + x_τ φ_x,    φ_ξ = t_ξ φ_t + x_ξ φ_x,    w = w_q (t_τ x_ξ − x_τ t_ξ),
///
/// so that affine fields have exact jets, and equal steps those of the lattice. Second derivatives of the table, less what
/// the map's own make of an affine field, are combined so that quadratic fields have exact ones: on the monomials m of
/// ½t², tx and ½x²
///
///     q_r = φ_r − t_r φ_t − x_r φ_x,    B_rs = q_r[m_s],    φ_s = Σ_r (B⁻¹)_sr q_r,    r of ττ, τξ, ξξ, s of tt, tx, xx.
///
/// A table without φ_ττ, such as the six-tuple's, determines φ_tx and φ_xx where q_r[½t²] = 0: where its rows lie at one time
/// each. Where it does not, the slots are left empty. Weights that are rounding errors are left out: what cancels must
/// couple nothing. Of a stencil listed the wrong way round a w is negative.
std::vector<TablePoint> placed_points(const StencilTable&, std::span<const Complex::Position>);

/// The first fault: a stencil with too few sites or too many, listed the wrong way round, degenerate, or there twice; a
/// site that no stencil has, or that lies where another does; a share that is missing or not above 0.
std::optional<MeshFault> find_fault(const StencilList&);
/// The first stencil of a table that lacks a second derivative which the density reads.
std::optional<MeshFault> find_fault(const StencilList&, const BatchDensity&);

}  // namespace delf
