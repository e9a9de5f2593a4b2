// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lattice/complex/complex_plan.hpp"
#include "schemes/complex/complex_system.hpp"

namespace delf {

class ThreadTeam;

/// Solves a complex level by level, and a wide level in parts: some blocks each, which threads share. Where the equations of
/// a part are proved linear in its unknowns it is one solve, by a BlockSolver: divisions where every unknown is a block of its
/// own, dense matrices of small blocks, a sparse factorisation of each larger one. Else Newton's method with such a solver and
/// a line search, from the values that stand there.
/// Parts are the same for any number of threads, and so is every bit.
class ComplexSolver {
 public:
  struct Options {
    double tolerance = 1e-14;  ///< the last correction, relative to the largest value
    int max_iterations = 50;
    int threads = 1;  ///< that parts of a level are shared by
    /// Of a part at least, where a level has several: a level of 2000 is about as long as it takes to wake a thread twice.
    int unknowns = 1024;
    std::function<bool()> is_to_end = {};  ///< asked between levels and iterations, by any thread
  };
  struct Report {
    int iterations = 0;     ///< the most of a part
    double correction = 0;  ///< the last one, relative
    /// Where the equations hold to rounding and the matrix is nearly singular: how far, relative to the values, a correction
    /// would go that gains nothing. 0 otherwise.
    double undetermined = 0;
    bool ended = false;  ///< is_to_end said so: levels that were not solved have the values that they had

    void add(const Report&);
  };

  /// Throws BadInput if the complex is ill-posed.
  ComplexSolver(const ComplexSystem&, Options);
  /// For two and no more arguments, because Options has defaults of its own.
  explicit ComplexSolver(const ComplexSystem& system) : ComplexSolver(system, Options{}) {}
  ~ComplexSolver();
  ComplexSolver(ComplexSolver&&) noexcept;

  const ComplexPlan& plan() const { return plan_; }
  /// Of its matrices and lists, without what a sparse factorisation fills in.
  std::size_t bytes() const;
  /// No level is iterated.
  bool is_direct() const;
  /// Levels in several parts.
  int shared_levels() const;
  /// Throws NoConvergence or NotFinite; y is then what it was before the level that failed.
  Report solve(std::span<double> y) const;

 private:
  class LevelPart;
  /// Calls one(part, share) for each of these parts, where shares go on side by side. Throws what the first part threw, when all
  /// are done.
  template <class Do>
  void for_each(std::size_t first, std::size_t last, const Do& one) const;

  const ComplexSystem& system_;
  Options options_;
  ComplexPlan plan_;
  std::vector<std::unique_ptr<LevelPart>> parts_;
  std::vector<std::size_t> level_;  ///< the first part of each, and the end
  std::unique_ptr<ThreadTeam> team_;
};

}  // namespace delf
