// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/stepping/step_method.hpp"

namespace delf {

/// Steps a system row by row, as its plan says. Kept are the newest rows y and their increments v_j = y_j − y_{j−1}:
/// with A₊ the coefficients of the unknown row, every step solves for w = v_{n+1} − v_n,
///
///     A₊ w = −(linear part at y_n, v_n, v_{n−1}, …) − r(0) − source terms,      v += w, y += v,
///
/// differences throughout, so that rounding enters at the size of the increment and not of the field.
class RowStepper final : public StepMethod {
 public:
  /// The stepper of a system that goes_by_rows. Throws NoConvergence if the constant part of the equations is singular.
  RowStepper(const LatticeSystem&, const SolvePlan&, const StepOptions&);
  ~RowStepper() override;

  void start(const std::vector<std::vector<double>>& rows) override;
  void start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  void step(bool looked_at) override;

  StepState state() const override;
  std::vector<double> row(int back) const override;
  Window window(int rows) const override;
  double residual() const override;
  void newest_pair(const double** rows) const override;
  StepReport report(bool residual) const override;
  void visit(SavedState&) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace delf
