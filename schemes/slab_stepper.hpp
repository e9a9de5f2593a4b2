// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>

#include "lattice/solve_plan.hpp"
#include "schemes/block_solver.hpp"
#include "schemes/slab_equations.hpp"
#include "schemes/step_method.hpp"

namespace delf {

/// Steps any system that has a plan, slab by slab: multipliers, nodes inside cells, unknowns that do not lie in one row.
/// Newton's method from an extrapolated seed; a factored Jacobian is kept while it contracts by more than ten, and the
/// linear equations are solved block by block in the plan's order.
class SlabStepper final : public StepMethod {
 public:
  SlabStepper(const LatticeSystem&, const SolvePlan&, const StepOptions&);

  int starting_rows() const override { return starting_rows_; }
  void start(const std::vector<std::vector<double>>& rows) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  void step() override;

  std::int64_t newest() const override { return J_ - lag_; }
  std::vector<double> row(int back) const override;
  Window window(int rows) const override;
  double residual() const override;
  int iterations() const override { return iterations_; }

  bool iterates() const override { return true; }
  std::string solver_name() const override;
  bool matrix_free() const override { return false; }
  std::size_t bytes() const override;
  std::string memory_report() const override;

 private:
  struct Parity {
    SlabEquations equations;
    BlockSolver solver;
    bool factored = false;
  };
  Parity& parity(std::int64_t J) { return parities_[static_cast<std::size_t>(J) % parities_.size()]; }
  const Parity& parity(std::int64_t J) const { return parities_[static_cast<std::size_t>(J) % parities_.size()]; }
  void seed(Parity&, std::int64_t J);
  void solve(std::int64_t J, const std::vector<double>* momenta);
  std::optional<int> crossing(const double* row) const;
  [[noreturn]] void fail(std::int64_t J, const char* why) const;

  const LatticeSystem& system_;
  const SolvePlan& plan_;
  StepOptions options_;
  int components_, past_ = 0, future_ = 0, lag_ = 0, starting_rows_ = 0, seed_order_ = 3;
  std::vector<int> back_;       ///< of each component: rows that its newest value lies behind the newest field
  std::vector<Parity> parities_;
  std::unique_ptr<SectionRing> ring_;
  std::int64_t J_ = -1;         ///< newest slab
  std::int64_t known_ = 0;      ///< slabs whose every component is known
  int iterations_ = 0;
  std::vector<double> E_, change_, jacobian_;
  mutable std::vector<double> residual_, absolute_;
};

}  // namespace delf
