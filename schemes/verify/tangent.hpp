// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "lattice/region.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// First variations along a section, slab by slab: the linearised equations of any system that has a plan, solved for
/// V on each slab from random values on the rows before the first one. Memory is linear in the slab.
class Tangent {
 public:
  /// Prepares windows of `rows` rows.
  Tangent(const LatticeSystem&, const SolvePlan&, int rows, double monodromy);

  ~Tangent();

  /// The least number of rows with a row in the middle on which all equations can hold.
  static int least_rows(const LatticeSystem&, const SolvePlan&);
  /// The rows of a window of `rows`, from its first, in which V solves the linearised equations of all components.
  static Range solved_rows(const LatticeSystem&, const SolvePlan&, int rows);

  /// `count` of them on the rows of y; zero where values are data, at fixed walls. Where y itself solves the equations
  /// or not does not matter. Throws NoConvergence if a slab's linear equations are singular.
  std::vector<Window> evolve(const Window& y, int count, std::mt19937_64&);

 private:
  struct Parity;  ///< the equations of slabs of one parity, and their solver
  const LatticeSystem& system_;
  int rows_;
  int data_ = 1;   ///< rows that V starts from
  int above_ = 0;  ///< rows after row J that slab J holds unknowns of
  std::vector<std::unique_ptr<Parity>> parities_;
};

}  // namespace delf
