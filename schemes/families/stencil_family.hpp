// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "jets/simd/pack.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

class NodalKernel;
class RowKernel;

/// Some stencils of one family, whose cells differ in x alone. Arrays are aligned to packs.
struct StencilBatch {
  Cell cell;        ///< t, h and k of all of them
  int count;        ///< a multiple of `lanes`
  const double* x;  ///< [s]: of the anchors
  const double* y;  ///< [i·count + s]: value i of stencil s
};

/// The part of a residual that is proved linear with constant coefficients: r(y) = r0 + J y + what depends on y
/// nonlinearly, or on t or x.
struct ConstantPart {
  std::vector<double> J;   ///< [i·size + m]
  std::vector<double> r0;  ///< [i]
  bool is_all = false;     ///< there is nothing else
};

/// One kind of stencil all over the lattice. A stencil carries one residual rⁱ for each value that it reads, ∂L/∂yⁱ
/// where there is a Lagrangian; solver, plan and checks see only r and its Jacobian.
class StencilFamily {
 public:
  virtual ~StencilFamily() = default;

  const StencilPattern& pattern() const { return pattern_; }
  /// What y[i] and r[i] belong to: a vertex of the pattern and a component of the section, in the order of vertices.
  const std::vector<VertexValue>& values() const { return values_; }
  int size() const { return static_cast<int>(values_.size()); }
  /// Where y[i] lies, from the anchor.
  Site site(int i) const {
    return pattern_.vertices[static_cast<std::size_t>(values_[static_cast<std::size_t>(i)].vertex)];
  }
  bool is_variational() const { return variational_; }
  bool is_placed() const { return placed_; }

  /// r, for one stencil.
  virtual void residual(const Cell&, std::span<const double> y, std::span<double> r) const = 0;
  /// ∂r/∂y, row by row.
  virtual void jacobian(const Cell&, std::span<const double> y, std::span<double> J) const = 0;
  /// L, where there is one; the residual is its gradient.
  virtual std::optional<double> lagrangian(const Cell&, std::span<const double> /*y*/) const { return std::nullopt; }
  /// Elements: the momenta ∫ ∂ℓ/∂φ_t of the values at the element's lowest row (site(i).time = 0), in their order, for
  /// the fields φ and φ_t there: what a start by the discrete Legendre transform needs. False for other families.
  virtual bool momentum(const Cell&, std::span<const double> /*phi*/, std::span<const double> /*phi_t*/,
                        std::span<double> /*p*/) const {
    return false;
  }
  /// r of `lanes` stencils at once whose cells differ in x alone, lane by lane: y[i·lanes + l], r[i·lanes + l] and
  /// x[l], aligned to packs. False for a family that has only the one above.
  virtual bool residuals(const Cell&, const double* /*x*/, const double* /*y*/, double* /*r*/) const { return false; }
  /// ∂r/∂y without the terms that depend on y, t or x: what an iteration with a fixed matrix takes for it. False for a
  /// family that cannot tell which those are.
  virtual bool constant_jacobian(const Cell&, std::span<double> /*J*/) const { return false; }
  /// r of a batch: r[i·count + s].
  virtual void residual(const StencilBatch&, double* r) const;
  /// ∂rᵉ/∂yᵘ of a batch for some equations e and unknowns u, both indices of values():
  /// J[(e·unknowns.size() + u)·count + s], where e and u count in the lists.
  virtual void jacobian(const StencilBatch&, std::span<const int> equations, std::span<const int> unknowns,
                        double* J) const;
  /// Nothing if the family cannot tell it, or it is not finite.
  virtual std::optional<ConstantPart> constant_part(const Cell&) const;

  /// The same for whole rows of stencils at once; null for a family that has only the two above.
  virtual const RowKernel* row_kernel() const { return nullptr; }
  /// For rows of nodes inside an element that follow each other explicitly; null where they do not.
  virtual const NodalKernel* nodal_kernel() const { return nullptr; }

 protected:
  StencilFamily(StencilPattern pattern, std::vector<VertexValue> values, bool variational)
      : pattern_(std::move(pattern)), values_(std::move(values)), variational_(variational) {}

  StencilPattern pattern_;
  std::vector<VertexValue> values_;
  bool variational_, placed_ = false;
};

/// d components at every vertex, vertex by vertex: i = l·d + a.
inline std::vector<VertexValue> values_at_every_vertex(const StencilPattern& pattern, int d) {
  std::vector<VertexValue> values;
  for (int l = 0; l < pattern.size(); ++l)
    for (int a = 0; a < d; ++a) values.push_back({l, a});
  return values;
}

}  // namespace delf
