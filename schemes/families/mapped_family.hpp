// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "schemes/families/stencil_family.hpp"

namespace delf {

/// The width of a cell whose ends are sites that move, at a stage of a step: a sum of a family's values.
struct MovingCell {
  struct Part {
    int value;
    double weight;
  };
  std::vector<Part> width;
  double time = 0;  ///< of the stage, as a fraction of the step
};

/// A family read through a linear map: its values are ŷ = M y, sums of values y at sites and nodes of the lattice, and its
/// residuals r̂ are tested by other sums,
///
///     r(y) = N r̂(M y),    ∂r/∂y = N (∂r̂/∂ŷ) M
///
/// Variational for N = Mᵀ. A stage of an element in time is such a map of a density on one row; an N without the rows of a
/// field reads that field without varying it; an N that moves r̂ to another value makes a constraint the equation of what it
/// determines, in place of its multiplier.
class MappedFamily final : public StencilFamily {
 public:
  struct Part {
    Site site;
    int component;
    double weight;
  };
  using Sum = std::vector<Part>;
  struct Map {
    std::vector<Sum> reads;  ///< of each value of the family; empty: it is 0
    std::vector<Sum> tests;  ///< where the residual of each of its values goes; none at all: the same
    /// Values of the family of which the first must stay below the second: the ends of a cell at a stage.
    std::optional<std::pair<int, int>> cell = {};
    double time = 0;  ///< of the stage, as a fraction of the step
    std::shared_ptr<const MeshConstraint> mesh = {};  ///< the family is this constraint at the rows
  };
  MappedFamily(std::shared_ptr<const StencilFamily>, const Map&);

  using Entry = MovingCell::Part;
  const MovingCell* moving_cell() const override { return cell_.width.empty() ? nullptr : &cell_; }
  const MeshConstraint* mesh_constraint() const override { return mesh_.get(); }

  using StencilFamily::jacobian;
  using StencilFamily::lagrangian;
  using StencilFamily::residual;
  void residual(const StencilBatch&, std::span<const int> equations, double* r) const override;
  void jacobian(const StencilBatch&, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override;
  bool lagrangian(const StencilBatch&, double* L) const override;
  std::optional<ConstantPart> constant_part(const Cell&) const override;

 private:
  struct Mapped;

  MappedFamily(std::shared_ptr<const StencilFamily>, const Map&,
               std::pair<StencilPattern, std::vector<VertexValue>> own);
  int number_of(const Part&) const;
  void find_rates();

  std::shared_ptr<const StencilFamily> family_;
  std::vector<std::vector<Entry>> map_;            ///< rows of M, by own values
  /// Columns of M and rows of N, by the family's values; N has rows of sums() too.
  std::vector<std::vector<Entry>> reads_, tests_;
  /// True for values of the family that are sums of increments in time, whose weights add up to zero.
  std::vector<char> is_rate_;
  MovingCell cell_;
  std::shared_ptr<const MeshConstraint> mesh_;
};

}  // namespace delf
