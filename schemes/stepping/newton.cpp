// SPDX-License-Identifier: MIT
#include "schemes/stepping/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/error.hpp"
#include "schemes/solvers/sparse_lu.hpp"
#include "schemes/stepping/slab_solver.hpp"

namespace delf {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

double largest(const Vector& v) { return v.size() ? v.lpNorm<Eigen::Infinity>() : 0; }

Vector as_vector(const std::vector<double>& row) {
  return Eigen::Map<const Vector>(row.data(), static_cast<Eigen::Index>(row.size()));
}
std::vector<double> as_row(const Vector& v) { return {v.data(), v.data() + v.size()}; }
int parity_of(const SolvePlan& plan, std::int64_t J) { return static_cast<int>(J & (plan.table.parities - 1)); }

/// The equations of slab J as a function of row J, followed in the step s·h from s = 0 to 1.
class SlabProblem {
 public:
  /// The rows that the equations read, made from row J: those of the past move with s, or with row J.
  using MakeRows = std::function<void(double s, const Vector& row, SectionRing&)>;

  SlabProblem(const LatticeSystem& system, Assembly::Parts parts, std::int64_t J, MakeRows make)
      : h_(system.time_step()),
        J_(J),
        ring_(parts.past + parts.future + 1,
              static_cast<std::size_t>(system.lattice().sites()) * static_cast<std::size_t>(system.components())),
        equations_(system, std::move(parts)),
        make_(std::move(make)) {}

  void set(double s) { equations_.set_time_step(s * h_), s_ = s; }
  const Assembly& equations() const { return equations_; }

  /// ∂E/∂(row J)
  const std::vector<double>& jacobian(const Vector& row) {
    make_(s_, row, ring_);
    equations_.jacobian(ring_, J_, values_);
    return values_;
  }
  const std::vector<double>& residual(const Vector& row) {
    make_(s_, row, ring_);
    equations_.residual(ring_, J_, E_);
    return E_;
  }
  /// y + by; a fixed wall keeps its value.
  Vector moved(Vector y, const Vector& by) const {
    for (int n = 0; n < equations_.size(); ++n) y[place(n)] += by[place(n)];
    return y;
  }
  /// y −= change
  void take(Vector& row, std::span<const double> change) const {
    for (int n = 0; n < equations_.size(); ++n) row[place(n)] -= change[static_cast<std::size_t>(n)];
  }

 private:
  int place(int n) const { return equations_.place(equations_.unknown(n)); }

  double h_, s_ = 1;
  std::int64_t J_;
  SectionRing ring_;
  Assembly equations_;
  MakeRows make_;
  std::vector<double> values_, E_;
};

struct Newton {
  bool converged = false;
  /// Every correction is at most a share `tame_ratio` of the one before, and the determinant keeps its sign.
  bool tame = true;
  int iterations = 0;
  Vector y;
  int sign = 0;  ///< of the determinant at the root
};

/// Whether corrections of this size say that the iteration has arrived. Those that stopped shrinking below a few hundred
/// units of round-off have: the matrix is ill-conditioned, not the iteration lost.
bool arrived(double size, double last, double absolute_tolerance, double round_off) {
  return size <= absolute_tolerance || size <= round_off || (size > 0.5 * last && size <= 64 * round_off);
}
double round_off_of(const Vector& y) { return 8 * std::numeric_limits<double>::epsilon() * largest(y); }

Newton newton(SlabProblem& problem, Vector y, double absolute_tolerance, int max_iterations,
              double tame_ratio = 0.5) {
  Newton result;
  const Assembly& equations = problem.equations();
  double last = std::numeric_limits<double>::infinity();
  Matrix J(equations.size(), equations.size());
  std::vector<Eigen::Triplet<double>> triplets;
  for (int it = 1; it <= max_iterations; ++it) {
    const std::vector<double>& values = problem.jacobian(y);
    triplets.clear();
    for (std::size_t n = 0; n < values.size(); ++n)
      if (values[n] != 0) triplets.emplace_back(equations.places()[n].equation, equations.places()[n].unknown, values[n]);
    J.setFromTriplets(triplets.begin(), triplets.end());
    SparseLU lu;
    result.iterations = it;
    if (!factor(lu, J)) break;
    const Vector change = lu.solve(as_vector(problem.residual(y)));
    if (lu.info() != Eigen::Success || !change.allFinite()) break;
    problem.take(y, as_row(change));
    const int sign = static_cast<int>(lu.signDeterminant());
    if (it > 1 && sign != result.sign) result.tame = false;
    result.sign = sign;
    const double size = largest(change), round_off = round_off_of(y);
    result.converged = arrived(size, last, absolute_tolerance, round_off);
    if (result.converged) break;
    if (size > tame_ratio * last && size > 64 * round_off) result.tame = false;
    last = size;
  }
  result.y = std::move(y);
  return result;
}

/// y ← y − J⁻¹E(y) with the Jacobian where it begins, while each correction is at most a tenth of the one before: then
/// no other root is near. Not converged where it does not contract like that.
Newton chord(SlabProblem& problem, Vector y, double absolute_tolerance, int max_iterations) {
  Newton result;
  const std::vector<double>& values = problem.jacobian(y);
  std::vector<char> present;
  for (const double value : values) present.push_back(value != 0);
  BlockSolver solver = solver_of(problem.equations(), present);
  if (!solver.factor(values)) return result;
  double last = std::numeric_limits<double>::infinity();
  std::vector<double> change;
  for (int it = 1; it <= max_iterations && !result.converged; ++it) {
    result.iterations = it;
    solver.solve(problem.residual(y), change);
    const double size = largest(as_vector(change));
    if (!std::isfinite(size)) return result;
    problem.take(y, change);
    const double round_off = round_off_of(y);
    result.converged = arrived(size, last, absolute_tolerance, round_off);
    if (!result.converged && size > 0.1 * last && size > 64 * round_off) return result;
    last = size;
  }
  result.y = std::move(y);
  return result;
}

/// Newton's method, with one Jacobian where that is enough.
Newton at_once(SlabProblem& problem, const Vector& predicted, double absolute_tolerance, int max_iterations) {
  const Newton quick = chord(problem, predicted, absolute_tolerance, max_iterations);
  if (quick.converged) return quick;
  Newton direct = newton(problem, predicted, absolute_tolerance, max_iterations);
  direct.iterations += quick.iterations;
  direct.converged = direct.converged && direct.tame;
  return direct;
}

/// Follows the root of the problem from s near 0 to s = 1. A stride is taken once and in two halves: both ways must
/// be tame and end at the same root, because Newton's method may by accident arrive quickly at a root that is far
/// away. Stops where the determinant changes sign, because there two roots meet.
Newton follow(SlabProblem& problem, const std::function<Vector(double)>& predict, double absolute_tolerance,
              int max_iterations) {
  constexpr double first = 1. / 16, largest_stride = 1. / 8, least_stride = 1. / 65536, tame_ratio = 1. / 8;
  double s = 0, stride = first;
  Newton at;
  Vector offset = 0 * predict(0);  // of the root from its prediction
  int iterations = 0, sign = 0;
  const auto root_at = [&](double where, const Vector& off) {
    problem.set(where);
    Newton found = newton(problem, predict(where) + off, absolute_tolerance,
                          std::min(max_iterations, enough_iterations), tame_ratio);
    iterations += found.iterations;
    found.converged = found.converged && found.tame && (sign == 0 || found.sign == sign);
    return found;
  };
  while (s < 1) {
    const double next = std::min(1.0, s + stride), middle = (s + next) / 2;
    Newton once = root_at(next, offset);
    bool same = false;
    if (once.converged)
      if (const Newton half = root_at(middle, offset); half.converged)
        if (const Newton twice = root_at(next, half.y - predict(middle)); twice.converged)
          same = largest(twice.y - once.y) <= 1e-6 * (1e-300 + largest(once.y)) + 4 * absolute_tolerance &&
                 half.sign == once.sign;
    if (!same) {
      stride /= 2;
      if (stride < least_stride) {
        at.converged = false;
        break;
      }
      continue;
    }
    sign = once.sign;
    s = next;
    offset = once.y - predict(s);
    at = std::move(once);
    stride = std::min(2 * stride, largest_stride);
  }
  at.iterations = iterations;
  return at;
}

NewtonResult as_result(const Newton& found, int iterations) {
  NewtonResult result{found.converged, iterations, {}};
  if (found.converged) result.row = as_row(found.y);
  return result;
}

}  // namespace

std::string remedy_for(int max_iterations) {
  return max_iterations < enough_iterations
             ? fmt::format("scheme.max_iterations = {} leaves it too few: raise it", max_iterations)
             : "reduce lattice.courant or lattice.time_step";
}

NewtonResult solve_slab(const LatticeSystem& system, const SolvePlan& plan, const Window& past, double tolerance,
                        int max_iterations, bool followed) {
  const std::int64_t J = past.last_row() + 1;
  const int rows = static_cast<int>(past.rows.size());
  const Vector newest = as_vector(past.rows.back());
  const Vector increment = newest - as_vector(past.rows[past.rows.size() - 2]);
  // With the step s·h the rows before the newest are as far away as the same velocities put them.
  SlabProblem problem(system, Assembly::slab(plan, parity_of(plan, J), rows, 0, past.turn), J,
                      [&](double s, const Vector& y, SectionRing& ring) {
                        for (int r = 0; r < rows; ++r) {
                          const auto& row = past.rows[static_cast<std::size_t>(r)];
                          double* const to = ring.row(past.first_row + r);
                          for (std::size_t i = 0; i < row.size(); ++i)
                            to[i] = past.rows.back()[i] - s * (past.rows.back()[i] - row[i]);
                        }
                        std::copy(y.begin(), y.end(), ring.row(J));
                      });
  const auto predict = [&](double s) { return problem.moved(newest, s * increment); };
  const double absolute = tolerance * std::max(largest(newest), largest(predict(1)));
  const Newton found = followed ? follow(problem, predict, absolute, max_iterations)
                                : at_once(problem, predict(1), absolute, max_iterations);
  return as_result(found, found.iterations);
}

NewtonResult solve_centred_start(const LatticeSystem& system, const SolvePlan& plan, const Window& row0,
                                 const std::vector<double>& velocity, bool followed, double tolerance,
                                 int max_iterations) {
  const Vector y0 = as_vector(row0.rows.back()), phi_t = as_vector(velocity);
  const double h = system.time_step();
  // Row −1 moves with row 1: its values are the same unknowns.
  Assembly::Parts parts = Assembly::slab(plan, parity_of(plan, 1), 2, 0, row0.turn);
  for (const Node& unknown : std::vector<Node>(parts.unknowns))
    parts.unknowns.push_back({unknown.site - Site{2, 0}, unknown.component});
  parts.copies = 2;
  SlabProblem problem(system, std::move(parts), 1, [&](double s, const Vector& y1, SectionRing& ring) {
    Eigen::Map<Vector>(ring.row(-1), y1.size()) = y1 - 2 * s * h * phi_t;
    std::copy(y0.begin(), y0.end(), ring.row(0));
    std::copy(y1.begin(), y1.end(), ring.row(1));
  });
  const auto predict = [&](double s) { return problem.moved(y0, s * h * phi_t); };
  const double absolute = tolerance * std::max(largest(y0), largest(predict(1)));
  int iterations = 0;
  if (!followed) {
    const Newton found = at_once(problem, predict(1), absolute, max_iterations);
    iterations = found.iterations;
    if (found.converged) return as_result(found, iterations);
  }
  const Newton root = follow(problem, predict, absolute, max_iterations);
  if (!root.converged)
    throw NoConvergence(
        "the starting row of initial.start = centred was not found: Newton's method did not converge; " +
        remedy_for(max_iterations));
  return as_result(root, iterations + root.iterations);
}

}  // namespace delf
