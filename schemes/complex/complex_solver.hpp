// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lattice/complex/complex_plan.hpp"
#include "schemes/complex/complex_system.hpp"

namespace delf {

/// Solves a complex level by level. What is proved linear is assembled once, as a sparse matrix of the level's equations.
/// If all other terms are linear in the unknowns of the level, the level is one solve: divisions where every unknown is a block of
/// its own, a sparse factorisation otherwise. Else Newton's method with a sparse matrix and a line search, from the values
/// that stand there.
class ComplexSolver {
 public:
  struct Options {
    double tolerance = 1e-14;  ///< the last correction, relative to the largest value
    int max_iterations = 50;
  };
  struct Report {
    int iterations = 0;     ///< the most of a level
    double correction = 0;  ///< the last one, relative
    double shortest = 1;    ///< the shortest step of a line search
    /// Where the equations hold to rounding and the matrix is nearly singular: how far, relative to the values, a correction
    /// would go that gains nothing. 0 otherwise.
    double undetermined = 0;
  };

  /// Throws BadInput if the complex is ill-posed.
  ComplexSolver(const ComplexSystem&, Options);
  /// For two and no more arguments, because Options has defaults of its own.
  explicit ComplexSolver(const ComplexSystem& system) : ComplexSolver(system, Options{}) {}
  ~ComplexSolver();
  ComplexSolver(ComplexSolver&&) noexcept;

  const ComplexPlan& plan() const { return plan_; }
  /// No level is iterated.
  bool is_direct() const;
  /// To be called when measures or time steps of the system have changed.
  void refresh();
  /// Throws NoConvergence or NotFinite; y is then what it was before the level that failed.
  Report solve(std::span<double> y) const;

 private:
  class Level;
  const ComplexSystem& system_;
  Options options_;
  Touching touching_;
  ComplexPlan plan_;
  std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace delf
