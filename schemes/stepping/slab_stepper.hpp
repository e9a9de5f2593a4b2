// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <optional>

#include "lattice/index.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "schemes/solvers/newton.hpp"
#include "schemes/stepping/mesh_watch.hpp"
#include "schemes/stepping/newton.hpp"
#include "schemes/stepping/root_watch.hpp"
#include "schemes/stepping/slab_solver.hpp"
#include "schemes/stepping/step_method.hpp"
#include "schemes/system/driven_values.hpp"

namespace delf {

/// Steps any system that has a plan, slab by slab: multipliers, nodes inside cells, unknowns that do not lie in one row.
/// The linear equations are solved block by block in the plan's order, with one of two matrices:
///
///  - where every family knows the constant part A of its Jacobian, A, factored once: y ← y − A⁻¹ E(y) from a polynomial
///    through the last scheme.seed_order slabs, as long as it contracts by four and more;
///  - otherwise, and where that does not contract, the Jacobian: Newton's method from the same polynomial, or from one
///    through fewer slabs. The factors of large blocks are kept while they contract by more than ten.
///
/// An iteration ends when what it leaves, estimated from its last two corrections, is below the tolerance. A root that has left
/// the motion (RootWatch) is not taken: it is sought again from lower orders, and then followed from a small step.
class SlabStepper final : public StepMethod {
 public:
  SlabStepper(const LatticeSystem&, const SolvePlan&, const StepOptions&);

  void start(const std::vector<std::vector<double>>& rows) override;
  void start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) override;
  void start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) override;
  void step(bool looked_at) override;

  StepState state() const override {
    return {newest(), plan_.nonlinear_in_slab && !by_levels() ? iterations_ : 0, continued_};
  }
  std::vector<double> row(int back) const override;
  Window window(int rows) const override;
  double residual() const override;

  StepReport report(bool residual) const override;
  void visit(SavedState&) override;

 private:
  /// Unknowns whose pasts are as long: those in one row of which as many slabs are known.
  struct Unknowns {
    int time;  ///< of their row, from J
    Role role;
    std::vector<int> numbers, places;  ///< of the slab, and site·C + component
    bool field() const { return role == Role::field; }
  };
  enum class Matrix { none, constant, jacobian };
  /// Unknowns that depend on those of lower levels and on no other of their own, and that their equations contain linearly, with
  /// the same matrix always: found by one solve, such as the rows between the sub-steps of a composition.
  struct Level {
    Assembly equations;
    BlockSolver solver;
    std::vector<Unknowns> unknowns;
  };
  struct Parity {
    Assembly equations;
    BlockSolver solver;
    std::vector<Unknowns> unknowns;
    std::vector<RootWatch::Values> watched;         ///< of the unknowns those that move
    std::vector<Level> levels = {};                 ///< none where some unknown is not of that kind
    bool has_constant = false;                      ///< there is a constant part, and it has an inverse
    bool has_values = false;                        ///< the solver has had the values of a matrix, and keeps them
    Matrix factored = Matrix::none;                 ///< what the solver holds
    int last_iterations = 0, fresh_iterations = 0;  ///< of the last slab, and of the last one with a new Jacobian
    double curvature = 0;    ///< the last correction over the square of that before, with a fresh Jacobian each time
    int unseen = 0;          ///< iterations since it was seen
    double contraction = 0;  ///< of corrections with the constant part, as seen last; 0: not yet
    bool momentum_follows = false;  ///< the known part of the next slab is this one's and what the slab adds to it
  };
  struct Iteration;
  struct WithConstant;
  struct WithJacobian;
  struct Finish;
  std::int64_t newest() const { return J_ - delay_; }
  Parity& parity(std::int64_t J) { return parities_[at(J) % parities_.size()]; }
  const Parity& parity(std::int64_t J) const { return parities_[at(J) % parities_.size()]; }
  std::vector<Unknowns> list_unknowns(const Assembly&) const;
  Parity parity_of(Assembly) const;
  bool factor_constant(Parity&);
  std::vector<Level> list_levels(const Parity&, int parity) const;
  Stop solve_levels(Parity&, std::int64_t J);
  bool by_levels() const { return !parities_.empty() && !parities_[0].levels.empty(); }
  void predict(const Parity&, std::int64_t J, int most_points);
  double weight_of_past(std::int64_t row, int m, int points) const;
  void predict_without_past(const Unknowns&, std::int64_t J);
  double largest_of(const double* row) const;
  void take_change(const std::vector<Unknowns>&, std::int64_t J, NewtonProgress&);
  bool estimates(const Parity&) const;
  Stop iterate(Parity&, std::int64_t J);
  bool may_iterate(const Parity&);
  Stop newton(Parity&, std::int64_t J, int points, const std::vector<double>* momenta);
  void find_known(const Parity&, std::int64_t J, const std::vector<double>* momenta);
  Stop finish(Parity&, std::int64_t J, Stop);
  void carry(const Parity&, std::int64_t J);
  void keep_means(std::int64_t J);
  Stop watch(const Parity&, std::int64_t J, int points, const std::vector<double>* momenta, std::string& crossed);
  SlabPast past_of(std::int64_t J, const std::vector<double>* momenta) const;
  std::vector<double> values_of(const Parity&, std::int64_t J) const;  ///< of the unknowns
  void follow(Parity&, std::int64_t J, const std::vector<double>* momenta, Stop why,
              const std::vector<double>& doubtful);
  bool solve_slab_of_start(const std::vector<double>* momenta);
  void check_increments(std::int64_t J) const;
  void solve(std::int64_t J, const std::vector<double>* momenta);
  [[noreturn]] void fail(std::int64_t J, const std::string& why, std::string remedy = {}) const;
  std::size_t unknowns() const;  ///< of a slab, the larger one
  std::size_t equation_bytes() const, matrix_bytes() const, matrix_bytes_to_come() const, work_bytes() const,
      residual_bytes_to_come() const;

  const LatticeSystem& system_;
  const DrivenValues driven_;
  const SolvePlan plan_;  ///< with_gauge()
  StepOptions options_;
  int components_, past_ = 0, future_ = 0, delay_ = 0, starting_rows_ = 0;
  std::optional<MeshWatch> mesh_;  ///< where it moves
  RootWatch root_;
  bool by_values_ = false;       ///< runs begin with the values of row 0 alone
  int points_;                   ///< slabs that a predictor goes through, if there are as many
  std::vector<int> predictors_;  ///< that, and what is tried after it
  std::vector<int> back_;        ///< of each component: rows that its newest value lies behind the newest field
  std::vector<Parity> parities_;
  std::unique_ptr<SectionRing> ring_;
  std::int64_t J_ = -1;      ///< newest slab
  std::int64_t known_ = 0;   ///< slabs whose every component is known
  bool by_momenta_ = false;  ///< the run began with the discrete Legendre transform
  int iterations_ = 0;
  NewtonProgress at_;  ///< of the last iteration
  Continued continued_ = Continued::no;
  double largest_[2] = {0, 0};  ///< |y| of the newest two slabs, or of the starting rows
  int wait_ = 1,
      waiting_ = 0;  ///< steps by Newton's method before the constant part is tried again; those that are left
  /// Of slab carried_slab_, in two numbers: the known part of its equations, momenta of the slab below.
  std::vector<double> carried_, carried_low_;
  std::int64_t carried_slab_ = -1;
  std::vector<double> E_, known_E_, gain_, change_, jacobian_, predicted_;
  mutable std::vector<double> residual_, absolute_;
};

}  // namespace delf
