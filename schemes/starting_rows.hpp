// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "schemes/problem.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

class FieldTheory;

/// The conditions on rows that a scheme starts from. Arguments are kept by reference; rows are [i·C + c].
class StartingRows {
 public:
  StartingRows(const Problem& problem, const FieldTheory& theory, const LatticeSystem& system)
      : problem_(problem), theory_(theory), system_(system) {}

  /// S¹: chooses for every value the representative next to its neighbour, so that the section is continuous; from there
  /// on differences are those of real numbers, and Stepper watches that they stay small enough to be distinguished.
  /// Throws NotFinite for rows that jump, BadInput for those of another winding number.
  std::vector<std::vector<double>> lifted(std::vector<std::vector<double>> rows) const;
  /// A fixed wall does not move: the nodes of a step on it have the value of its vertex, and no velocity.
  void hold_walls(std::vector<double>& row, bool velocity) const;
  /// Stencils that go on beyond a wall by mirror images: throws BadInput if the density has none about the wall's value.
  void check_mirrors(const std::vector<double>& row) const;
  /// ∂S/∂φ_t of the elements at row 0, of all components but slaved ones; none for a scheme without elements.
  std::optional<std::vector<double>> momenta(std::span<const double> row0, std::span<const double> velocity) const;

 private:
  const Problem& problem_;
  const FieldTheory& theory_;
  const LatticeSystem& system_;
};

}  // namespace delf
