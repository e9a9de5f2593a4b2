// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/complex/complex_solver.hpp"
#include "tools/complex/complex_scene.hpp"

namespace delf {

/// What is solved at once: an elliptic problem on a mesh, with data on the fixed boundary, or a finite complex of
/// spacetime, with data where its list says. Newton's method begins with initial.FIELD, or with 0 where values are unknown
/// if only a solution is given: from a solution nothing begins.
class StaticField {
 public:
  explicit StaticField(const ComplexScene&);

  const ComplexSystem& system() const { return system_; }
  const ComplexSolver& solver() const { return solver_; }
  /// The fields; behind them y has multipliers, where there is a constraint.
  std::span<const double> values() const { return {y_.data(), fields_}; }
  std::span<const double> multipliers() const { return std::span(y_).subspan(fields_); }
  const std::vector<double>& unknowns_and_data() const { return y_; }
  ComplexSolver::Report solve() { return solver_.solve(y_); }
  /// −S on a mesh: the energy of a static field.
  double energy() const;
  /// Of its values, stencils and matrices.
  std::size_t bytes() const { return system_.bytes() + solver_.bytes() + 8 * y_.size(); }
  /// The largest |E|, relative to the largest sum of absolute terms; of a field that is 0 to the rounding of its start, to
  /// the terms there.
  double residual() const;

 private:
  ComplexSystem system_;
  ComplexSolver solver_;
  std::vector<double> y_, start_;
  std::size_t fields_;
};

}  // namespace delf
