// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/complex/complex_solver.hpp"
#include "tools/complex/complex_scene.hpp"

namespace delf {

/// An elliptic problem of a scene: data on the fixed boundary, and the field inside by Newton's method. It begins with
/// initial.FIELD, or with 0 inside if only a solution is given: from a solution nothing begins.
class StaticField {
 public:
  explicit StaticField(const ComplexScene&);

  const ComplexSystem& system() const { return rows_.system(); }
  const ComplexSolver& solver() const { return solver_; }
  const std::vector<double>& values() const { return y_; }
  ComplexSolver::Report solve() { return solver_.solve(y_); }
  /// −S: the energy of a static field.
  double energy() const;
  /// The largest |E|, relative to the largest sum of absolute terms.
  double residual() const;

 private:
  SpaceRows rows_;
  ComplexSolver solver_;
  std::vector<double> y_;
};

}  // namespace delf
