// SPDX-License-Identifier: MIT
#include "schemes/newton.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace delf {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

double largest(const Vector& v) { return v.size() ? v.lpNorm<Eigen::Infinity>() : 0; }

/// The equations of one slab as a function of its unknown row.
class SlabEquations {
 public:
  /// Makes the window for a value of the unknown row: the rows before it, and it.
  using MakeWindow = std::function<Window(const Vector& unknown)>;
  /// ∂(row j)/∂(unknown row), for rows that follow the unknown: {row, factor}.
  struct Dependent {
    std::int64_t row;
    double factor;
  };

  SlabEquations(const LatticeSystem& system, const SolvePlan& plan, std::int64_t unknown_row, double h, MakeWindow make,
                std::vector<Dependent> dependents)
      : system_(system), plan_(plan), unknown_row_(unknown_row), h_(h), make_(std::move(make)),
        dependents_(std::move(dependents)) {}

  Vector residual(const Vector& y) const {
    const Window window = make_(y);
    const int d = system_.components();
    Vector E(y.size());
    for (int i = 0; i < system_.lattice().sites(); ++i)
      for (int a = 0; a < d; ++a) {
        // A fixed wall keeps its value: y_wall − y = 0, of the sign that the equations' ∂E/∂y_{j+1} has.
        if (!solved(i, a)) {
          E[i * d + a] = window(unknown_row_ - 1, i, a) - y[i * d + a];
          continue;
        }
        E[i * d + a] = system_.equation(window, row_of(i, a), i, a, h_).sum;
      }
    return E;
  }

  Matrix jacobian(const Vector& y) const {
    const Window window = make_(y);
    const int d = system_.components();
    std::vector<LatticeSystem::Entry> entries;
    std::vector<Eigen::Triplet<double>> triplets;
    for (int i = 0; i < system_.lattice().sites(); ++i)
      for (int a = 0; a < d; ++a)
        if (!solved(i, a)) triplets.emplace_back(i * d + a, i * d + a, -1.0);
    for (const Dependent& dependent : dependents_)
      for (int i = 0; i < system_.lattice().sites(); ++i) {
        entries.clear();
        system_.jacobian(window, row_of(i, 0), i, dependent.row, h_, entries);
        for (const auto& e : entries)
          if (solved(i, e.row % d)) triplets.emplace_back(e.row, e.column, dependent.factor * e.value);
      }
    Matrix J(y.size(), y.size());
    J.setFromTriplets(triplets.begin(), triplets.end());
    return J;
  }

 private:
  bool solved(int i, int a) const { return plan_.solved(i, a); }
  std::int64_t row_of(int i, int a) const {
    return unknown_row_ - plan_.shift(i, a, static_cast<int>(unknown_row_ & 1));
  }
  const LatticeSystem& system_;
  const SolvePlan& plan_;
  std::int64_t unknown_row_;
  double h_;
  MakeWindow make_;
  std::vector<Dependent> dependents_;
};

struct Newton {
  bool converged = false, tame = true;  ///< tame: every correction at most half of the one before
  int iterations = 0;
  Vector y;
  int sign = 0;  ///< of the determinant at the root
};

Newton newton(const SlabEquations& equations, Vector y, double absolute_tolerance, int max_iterations) {
  Newton result;
  double last = std::numeric_limits<double>::infinity();
  for (int it = 1; it <= max_iterations; ++it) {
    Eigen::SparseLU<Matrix> lu;
    lu.compute(equations.jacobian(y));
    result.iterations = it;
    if (lu.info() != Eigen::Success) break;
    const Vector change = lu.solve(equations.residual(y));
    if (lu.info() != Eigen::Success || !change.allFinite()) break;
    y -= change;
    result.sign = static_cast<int>(lu.signDeterminant());
    const double size = largest(change);
    const double round_off = 8 * std::numeric_limits<double>::epsilon() * largest(y);
    if (size <= absolute_tolerance || size <= round_off) {
      result.converged = true;
      break;
    }
    if (size > 0.5 * last) result.tame = false;
    // Corrections that stopped shrinking below a few hundred units of round-off have arrived: the matrix is
    // ill-conditioned, not the iteration lost.
    if (size > 0.5 * last && size <= 64 * round_off) {
      result.converged = true;
      result.tame = true;
      break;
    }
    last = size;
  }
  result.y = std::move(y);
  return result;
}

/// Follows the root of equations_at(s) from s near 0 to s = 1. Halves the stride where Newton is not tame; stops where
/// the determinant changes sign, because there two roots meet.
Newton follow(const std::function<SlabEquations(double)>& equations_at, const std::function<Vector(double)>& predict,
              double absolute_tolerance, int max_iterations) {
  constexpr double first = 1. / 16, largest_stride = 1. / 4, least_stride = 1. / 65536;
  double s = 0, stride = first;
  Newton at, before;
  Vector offset;
  int iterations = 0, sign = 0;
  while (s < 1) {
    const double next = std::min(1.0, s + stride);
    const SlabEquations equations = equations_at(next);
    Vector seed = predict(next);
    if (offset.size()) seed += offset;
    Newton trial = newton(equations, seed, absolute_tolerance, std::min(max_iterations, 12));
    iterations += trial.iterations;
    const bool turned = sign != 0 && trial.sign != sign;
    if (!trial.converged || !trial.tame || turned) {
      stride /= 2;
      if (stride < least_stride) {
        at.converged = false;
        at.iterations = iterations;
        return at;
      }
      continue;
    }
    sign = trial.sign;
    s = next;
    offset = trial.y - predict(s);
    at = std::move(trial);
    stride = std::min(2 * stride, largest_stride);
  }
  at.iterations = iterations;
  return at;
}

Vector as_vector(const std::vector<double>& row) {
  return Eigen::Map<const Vector>(row.data(), static_cast<Eigen::Index>(row.size()));
}
std::vector<double> as_row(const Vector& v) { return {v.data(), v.data() + v.size()}; }

NewtonResult as_result(const Newton& found, int iterations, bool continued) {
  NewtonResult result{found.converged, iterations, continued, {}};
  if (found.converged) result.row = as_row(found.y);
  return result;
}

}  // namespace

NewtonResult solve_slab(const LatticeSystem& system, const SolvePlan& plan, const Window& past,
                        double tolerance, int max_iterations) {
  const std::int64_t unknown = past.last_row() + 1;
  const Vector newest = as_vector(past.rows.back());
  const Vector increment = newest - as_vector(past.rows[past.rows.size() - 2]);
  // With the step s·h the rows before the newest are as far away as the same velocities put them.
  const auto equations_at = [&](double s) {
    return SlabEquations(
        system, plan, unknown, s * system.time_step(),
        [&past, s](const Vector& y) {
          Window window = past;
          for (auto& row : window.rows)
            for (std::size_t i = 0; i < row.size(); ++i)
              row[i] = past.rows.back()[i] - s * (past.rows.back()[i] - row[i]);
          window.rows.push_back(as_row(y));
          return window;
        },
        {{unknown, 1.0}});
  };
  const auto predict = [&](double s) { return Vector(newest + s * increment); };
  const double absolute = tolerance * std::max(largest(newest), largest(predict(1)));
  const Newton followed = follow(equations_at, predict, absolute, max_iterations);
  return as_result(followed, followed.iterations, true);
}

NewtonResult solve_centred_start(const LatticeSystem& system, const SolvePlan& plan, const Window& row0,
                                 const std::vector<double>& velocity, bool stiff, double tolerance,
                                 int max_iterations) {
  const Vector y0 = as_vector(row0.rows.back()), phi_t = as_vector(velocity);
  const double h = system.time_step();
  const auto equations_at = [&](double s) {
    return SlabEquations(
        system, plan, 1, s * h,
        [&, s](const Vector& y1) {
          Window window = row0;
          window.first_row = -1;
          window.rows = {as_row(y1 - 2 * s * h * phi_t), row0.rows.back(), as_row(y1)};
          return window;
        },
        {{1, 1.0}, {-1, 1.0}});
  };
  const auto predict = [&](double s) { return Vector(y0 + s * h * phi_t); };
  const double absolute = tolerance * std::max(largest(y0), largest(predict(1)));
  int iterations = 0;
  if (!stiff) {
    const Newton direct = newton(equations_at(1), predict(1), absolute, max_iterations);
    iterations = direct.iterations;
    if (direct.converged && direct.tame) return as_result(direct, iterations, false);
  }
  const Newton followed = follow(equations_at, predict, absolute, max_iterations);
  return as_result(followed, iterations + followed.iterations, true);
}

bool is_stiff(const LatticeSystem& system, const SolvePlan& plan) {
  for (const auto& family : system.families())
    if (family->nonlinearity() == Nonlinearity::all) return false;
  const int site = system.lattice().sites() / 2;
  for (int row = 0; row < (system.placement() == Placement::brick_wall ? 2 : 1); ++row)
    for (int a = 0; a < system.components(); ++a) {
      double own = 0, others = 0, variation = 0;
      for (const Coefficient& c : system.linearised({row, site}, a)) {
        if (c.offset.time != plan.shift(site, a)) continue;
        (c.offset.space == 0 && c.component == a ? own : others) += std::abs(c.typical);
        variation += c.variation;
      }
      // A fixed point contracts everywhere if the variation is below own − others; the samples are few.
      if (variation > 0 && !(variation < 0.125 * (own - others))) return true;
    }
  return false;
}

}  // namespace delf
