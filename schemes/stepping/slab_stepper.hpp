// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/solvers/block_solver.hpp"
#include "schemes/system/slab_equations.hpp"
#include "schemes/stepping/step_method.hpp"

namespace delf {

/// Steps any system that has a plan, slab by slab: multipliers, nodes inside cells, unknowns that do not lie in one row.
/// The linear equations are solved block by block in the plan's order, with one of two matrices:
///
///  - where every family knows the constant part A of its Jacobian, A, factored once: y ← y − A⁻¹ E(y) from a polynomial
///    through the last scheme.seed_order slabs, as long as it contracts by four and more;
///  - otherwise, and where that does not contract, the Jacobian: Newton's method from a seed of lower order. A factored
///    Jacobian is kept while it contracts by more than ten.
class SlabStepper final : public StepMethod {
 public:
  SlabStepper(const LatticeSystem&, const SolvePlan&, const StepOptions&);

  int starting_rows() const override { return starting_rows_; }
  void start(const std::vector<std::vector<double>>& rows) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  void step(bool looked_at) override;

  std::int64_t newest() const override { return J_ - lag_; }
  std::vector<int> behind() const override { return back_; }
  std::vector<double> row(int back) const override;
  Window window(int rows) const override;
  double residual() const override;
  int iterations() const override { return iterations_; }

  bool iterates() const override { return true; }
  std::string solver_name() const override;
  bool matrix_free() const override { return false; }
  std::size_t bytes() const override;
  std::size_t bytes_to_come(bool residual) const override;
  std::string memory_report(bool residual) const override;

 private:
  /// Unknowns whose pasts are as long: those in one row of which as many slabs are known.
  struct Unknowns {
    int time;  ///< of their row, from J
    Role role;
    /// Of the slab, and site·C + component. Packs are whole: what the last one has too much repeats the last unknown.
    std::vector<int> numbers, places;
    bool field() const { return role == Role::field; }
  };
  enum class Matrix { none, constant, jacobian };
  struct Parity {
    SlabEquations equations;
    BlockSolver solver;
    std::vector<Unknowns> unknowns;
    bool has_constant = false;       ///< there is a constant part, and it has an inverse
    bool has_values = false;         ///< the solver has had the values of a matrix, and keeps them
    Matrix factored = Matrix::none;  ///< what the solver holds
  };
  struct Change {
    double change = 0;  ///< the largest, multipliers apart
    double value = 0;   ///< largest |y| of the candidate and of the two slabs before
    bool finite = true;
  };
  Parity& parity(std::int64_t J) { return parities_[static_cast<std::size_t>(J) % parities_.size()]; }
  const Parity& parity(std::int64_t J) const { return parities_[static_cast<std::size_t>(J) % parities_.size()]; }
  std::vector<Unknowns> list_unknowns(const SlabEquations&) const;
  bool factor_constant(Parity&);
  void seed(Parity&, std::int64_t J, int most_order);
  void seed_without_past(const Unknowns&, std::int64_t J);
  double largest_of(const double* row) const;
  Change take_change(const Parity&, std::int64_t J);
  bool small(const Change&) const;
  bool iterate(Parity&, std::int64_t J);
  bool may_iterate(const Parity&);
  void newton(Parity&, std::int64_t J, const std::vector<double>* momenta);
  void solve(std::int64_t J, const std::vector<double>* momenta);
  std::optional<int> crossing(const double* row) const;
  [[noreturn]] void fail(std::int64_t J, const char* why) const;
  std::size_t unknowns() const;  ///< of a slab, the larger one
  std::size_t equation_bytes() const, matrix_bytes() const, matrix_bytes_to_come() const, work_bytes() const,
      residual_bytes_to_come() const;

  const LatticeSystem& system_;
  const SolvePlan& plan_;
  StepOptions options_;
  int components_, past_ = 0, future_ = 0, lag_ = 0, starting_rows_ = 0;
  int seed_order_, newton_seed_order_;
  std::vector<int> back_;  ///< of each component: rows that its newest value lies behind the newest field
  std::vector<Parity> parities_;
  std::unique_ptr<SectionRing> ring_;
  std::int64_t J_ = -1;     ///< newest slab
  std::int64_t known_ = 0;  ///< slabs whose every component is known
  int iterations_ = 0;
  double largest_[2] = {0, 0};  ///< |y| of the newest two slabs, or of the starting rows
  int wait_ = 1,
      waiting_ = 0;  ///< steps by Newton's method before the constant part is tried again; those that are left
  std::vector<double> E_, known_E_, change_, jacobian_, seed_;
  mutable std::vector<double> residual_, absolute_;
};

}  // namespace delf
