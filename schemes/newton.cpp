// SPDX-License-Identifier: MIT
#include "schemes/newton.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "schemes/row_kernel.hpp"

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
        for (int a = 0; a < d; ++a)
          if (solved(i, a)) system_.jacobian(window, row_of(i, a), i, a, dependent.row, h_, entries);
        for (const auto& e : entries) triplets.emplace_back(e.row, e.column, dependent.factor * e.value);
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
  bool converged = false;
  bool tame = true;  ///< every correction is at most a share `tame_ratio` of the one before, the determinant keeps its sign
  int iterations = 0;
  Vector y;
  int sign = 0;  ///< of the determinant at the root
};

Newton newton(const SlabEquations& equations, Vector y, double absolute_tolerance, int max_iterations,
              double tame_ratio = 0.5) {
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
    const int sign = static_cast<int>(lu.signDeterminant());
    if (it > 1 && sign != result.sign) result.tame = false;
    result.sign = sign;
    const double size = largest(change);
    const double round_off = 8 * std::numeric_limits<double>::epsilon() * largest(y);
    if (size <= absolute_tolerance || size <= round_off) {
      result.converged = true;
      break;
    }
    // Corrections that stopped shrinking below a few hundred units of round-off have arrived: the matrix is
    // ill-conditioned, not the iteration lost.
    if (size > 0.5 * last && size <= 64 * round_off) {
      result.converged = true;
      break;
    }
    if (size > tame_ratio * last && size > 64 * round_off) result.tame = false;
    last = size;
  }
  result.y = std::move(y);
  return result;
}

/// Follows the root of equations_at(s) from s near 0 to s = 1. A stride is taken once and in two halves: both ways must
/// be tame and end at the same root, because Newton's method may by accident arrive quickly at a root that is far
/// away. Stops where the determinant changes sign, because there two roots meet.
Newton follow(const std::function<SlabEquations(double)>& equations_at, const std::function<Vector(double)>& predict,
              double absolute_tolerance, int max_iterations) {
  constexpr double first = 1. / 16, largest_stride = 1. / 8, least_stride = 1. / 65536, tame_ratio = 1. / 8;
  double s = 0, stride = first;
  Newton at;
  Vector offset = 0 * predict(0);  // of the root from its prediction
  int iterations = 0, sign = 0;
  const auto root_at = [&](double where, const Vector& off) {
    Newton found = newton(equations_at(where), predict(where) + off, absolute_tolerance, std::min(max_iterations, 12),
                          tame_ratio);
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

Vector as_vector(const std::vector<double>& row) {
  return Eigen::Map<const Vector>(row.data(), static_cast<Eigen::Index>(row.size()));
}
std::vector<double> as_row(const Vector& v) { return {v.data(), v.data() + v.size()}; }

NewtonResult as_result(const Newton& found, int iterations) {
  NewtonResult result{found.converged, iterations, {}};
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
  return as_result(followed, followed.iterations);
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
    if (direct.converged && direct.tame) return as_result(direct, iterations);
  }
  const Newton followed = follow(equations_at, predict, absolute, max_iterations);
  return as_result(followed, iterations + followed.iterations);
}

std::optional<FixedPointBound> fixed_point_bound(const LatticeSystem& system, const SolvePlan& plan,
                                                 double amplitude) {
  for (const auto& family : system.families())
    if (family->row_kernel()->nonlinearity() == Nonlinearity::all) return std::nullopt;
  FixedPointBound bound{0, std::numeric_limits<double>::infinity()};
  const int d = system.components(), site = system.lattice().sites() / 2;
  Window uniform{&system.lattice(), d, 0, 0, {}};
  uniform.rows.resize(1, std::vector<double>(static_cast<std::size_t>(system.lattice().sites() * d)));
  for (int row = 0; row < (system.placement() == Placement::brick_wall ? 2 : 1); ++row)
    for (int a = 0; a < d; ++a) {
      const int unknown_row = row + plan.shift(site, a);
      std::map<int, double> constant;  // A₊ by column
      double dominance = 0;            // |A_ii| − Σ |A_ij|
      for (const Coefficient& c : system.linearised({row, site}, a)) {
        if (row + c.offset.time != unknown_row) continue;
        const bool own = c.offset.space == 0 && c.component == a;
        dominance += own ? std::abs(c.value) : -std::abs(c.value);
        const int i = site + c.offset.space;
        constant[(system.lattice().is_circle() ? system.lattice().wrapped(i) : i) * d + c.component] += c.value;
      }
      // The fixed point contracts by at most Σ |J_ij − A_ij| / dominance; J at uniform fields.
      bound.dominance = std::min(bound.dominance, dominance);
      constexpr int fields = 16;
      for (int f = 0; f <= fields; ++f) {
        const double value = amplitude * (2.0 * f / fields - 1);
        std::ranges::fill(uniform.rows[0], value);
        std::vector<LatticeSystem::Entry> entries;
        system.jacobian(uniform, row, site, a, unknown_row, system.time_step(), entries);
        std::map<int, double> rest = constant;
        for (auto& [column, entry] : rest) entry = -entry;
        for (const auto& e : entries)
          if (e.row == site * d + a) rest[e.column] += e.value;
        double sum = 0;
        for (const auto& [column, entry] : rest) sum += std::abs(entry);
        if (std::isfinite(sum)) bound.nonlinear = std::max(bound.nonlinear, sum);
      }
    }
  return bound;
}

}  // namespace delf
