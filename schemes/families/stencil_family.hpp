// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/discrete_lagrangian.hpp"
#include "lattice/index.hpp"
#include "lattice/space/listed_stencils.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

struct DensityOnTable;
class DrivenEnd;
struct MeshConstraint;
struct MovingCell;

/// Some stencils of one family, whose cells differ in x alone. Arrays are aligned to packs.
struct StencilBatch {
  Cell cell;        ///< t, h and k of all of them
  int count;        ///< a multiple of `lanes`
  const double* x;  ///< [s]: of the anchors
  const double* y;  ///< [i·count + s]: value i of stencil s
  /// The low parts, which rounding has taken from y: the values are y + low. Null: nothing is known of them.
  const double* low = nullptr;
  const int* numbers = nullptr;  ///< [s]: of stencils that are listed; else null
};

/// The part of a residual that is proved linear with constant coefficients: r(y) = r0 + J y + what depends on y
/// nonlinearly, or on t or x.
struct ConstantPart {
  std::vector<double> J;   ///< [i·size + m]
  std::vector<double> r0;  ///< [i]
  bool is_all = false;     ///< there is nothing else
};

/// The source terms of a residual, beside its constant part, where they are functions of a few quadrature values:
///
///     r(y) = r0 + J y + hk Σ_c weights(c, ·) g_c(m),        m = Σ weight · y(vertex)
///
/// A row of stencils then evaluates each g_c once. The functions come in groups of the same inputs at one place.
struct SourceTerms {
  struct Part {
    Site vertex;
    int component;
    double weight;
  };
  using QuadratureValue = std::vector<Part>;
  struct Group {
    std::vector<QuadratureValue> inputs;
    double time = 0, space = 0;  ///< where it lies, from the anchor, in steps
    int own = -1;  ///< of listed stencils: the number of their own that multiplies the group's weights, or none
    /// The latest vertex time that it depends on: below the pattern's latest, it is known before a step.
    int latest_time() const;
  };
  std::vector<Group> groups;
  int outputs_per_group = 1;
  /// [(g · outputs_per_group + c) · size + i], in units of hk. A direct residual may give its stencils shares of what r
  /// itself has at one vertex: sums over stencils are alike.
  std::vector<double> weights;

  int outputs() const { return static_cast<int>(groups.size()) * outputs_per_group; }
  double weight(int output, int i) const { return weights[at(output) * (weights.size() / at(outputs())) + at(i)]; }
};

/// One kind of stencil all over the lattice. A stencil carries one residual rⁱ for each value that it reads, ∂L/∂yⁱ
/// where there is a Lagrangian; solver, plan and checks see only r and its Jacobian.
class StencilFamily {
 public:
  virtual ~StencilFamily() = default;

  const StencilPattern& pattern() const { return pattern_; }
  /// The vertex of the pattern and the component of the section that y[i] and r[i] belong to, in the order of vertices.
  const std::vector<VertexValue>& values() const { return values_; }
  int size() const { return static_cast<int>(values_.size()); }
  /// The site of y[i], from the anchor.
  Site site(int i) const { return pattern_.vertices[at(values_[i].vertex)]; }
  bool is_variational() const { return variational_; }
  /// r[i] enters the equation of y[i]. False for a value that is read but not varied: its equation is another family's.
  bool is_varied(int i) const { return varied_.empty() || varied_[i]; }
  bool is_placed() const { return placed_; }
  /// On a space where stencils do not repeat, those of a row. Null: one at every anchor of the pattern.
  const ListedStencils* listed() const { return listed_.get(); }
  /// The column where y[i] of a stencil lies: of the anchor in this column, beyond a circle's ends too, or of a number.
  int column(int anchor, int i) const {
    return listed_ ? listed_->site(anchor, site(i).space) : anchor + site(i).space;
  }

  /// True if derivatives in time are sums of differences of y + low, which lose no digits in a short step.
  bool reads_low() const { return reads_low_; }
  /// Values whose residuals residual() adds up more exactly than their terms are, as equation size() + n for sums()[n]. A
  /// field that is raised at one place at all times has no φ_t there: what is left is the momentum that a step adds.
  const std::vector<std::vector<int>>& sums() const { return sums_; }
  /// These sums are zero: r depends on differences of their values alone.
  bool sums_vanish() const { return sums_vanish_; }

  /// r of a batch for some equations e, indices of values(): r[e·count + s], where e counts in the list.
  virtual void residual(const StencilBatch&, std::span<const int> equations, double* r) const;
  void residual(const StencilBatch&, double* r) const;  ///< for all of them
  /// r of one stencil whose values are y + low.
  void residual(const Cell&, std::span<const double> y, std::span<const double> low, std::span<double> r) const;
  /// ∂rᵉ/∂yᵘ of a batch for some equations e and unknowns u, both indices of values():
  /// J[(e·unknowns.size() + u)·count + s], where e and u count in the lists.
  virtual void jacobian(const StencilBatch&, std::span<const int> equations, std::span<const int> unknowns,
                        double* J) const;
  /// L of a batch, where there is one; the residual is its gradient.
  virtual bool lagrangian(const StencilBatch&, double* /*L*/) const { return false; }
  /// ∂rⁱ/∂yᵐ is proved to be that of the constant part at all y, t and x.
  virtual bool is_constant(int /*i*/, int /*m*/) const { return false; }
  /// Nothing where it is not finite.
  virtual std::optional<ConstantPart> constant_part(const Cell&) const;

  /// The part of r besides its constant part; null if it is not of that form. And the functions g_c of a group.
  virtual const SourceTerms* sources() const { return nullptr; }
  /// A number of a listed stencil's own (SourceTerms::Group::own); 1 for none.
  virtual double own_number(int /*number*/, int /*stencil*/) const { return 1; }
  virtual void evaluate_sources(int /*group*/, const JetBatch& /*inputs*/, double* const* /*g*/) const {}
  /// ∂g_c/∂m_j: d[c·inputs + j][i]
  virtual void differentiate_sources(int /*group*/, const JetBatch& /*inputs*/, double* const* /*d*/) const {}

  /// The density and the table whose jets the residual is made of; null: it is made of something else.
  virtual const DensityOnTable* made_of() const { return nullptr; }
  /// The cell of a mesh that moves, at the stage of a step that the family stands for; null: it has none.
  virtual const MovingCell* moving_cell() const { return nullptr; }
  /// The constraint that holds the sites of a mesh at their rows; null: the family is something else.
  virtual const MeshConstraint* mesh_constraint() const { return nullptr; }
  /// The motion of an end whose value is data for all times; null: the family is something else.
  virtual const DrivenEnd* driven_end() const { return nullptr; }
  /// Something flows into a natural wall.
  virtual bool is_flux() const { return false; }

  /// The values of one stencil: r, ∂r/∂y row by row, one of its rows, and L.
  virtual void residual(const Cell&, std::span<const double> y, std::span<double> r) const;
  virtual void jacobian(const Cell&, std::span<const double> y, std::span<double> J) const;
  void jacobian_row(int equation, const Cell&, std::span<const double> y, std::span<double> J) const;
  virtual std::optional<double> lagrangian(const Cell&, std::span<const double> y) const;

 private:
  void rows_of_jacobian(std::span<const int> equations, const Cell&, std::span<const double> y,
                        std::span<double> J) const;

 protected:
  StencilFamily(StencilPattern pattern, std::vector<VertexValue> values, bool variational)
      : pattern_(std::move(pattern)), values_(std::move(values)), variational_(variational) {}

  StencilPattern pattern_;
  std::vector<VertexValue> values_;
  std::vector<bool> varied_;  ///< [i]; empty: all
  std::shared_ptr<const ListedStencils> listed_;
  bool variational_, placed_ = false, reads_low_ = false, sums_vanish_ = false;
  std::vector<std::vector<int>> sums_;
};

/// d components at every vertex, vertex by vertex: i = l·d + a. Nodes inside a cell have components of their own.
inline std::vector<VertexValue> values_at_every_vertex(const StencilPattern& pattern, int d) {
  std::vector<VertexValue> values;
  for (int l = 0; l < pattern.size(); ++l)
    for (int a = 0; a < d; ++a) values.push_back({l, pattern.vertices[l].node * d + a});
  return values;
}

}  // namespace delf
