// SPDX-License-Identifier: MIT
#include "schemes/stepping/newton.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "schemes/solvers/cyclic_band_lu.hpp"
#include "schemes/families/row_kernel.hpp"

namespace delf {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

double largest(const Vector& v) { return v.size() ? v.lpNorm<Eigen::Infinity>() : 0; }

Vector as_vector(const std::vector<double>& row) {
  return Eigen::Map<const Vector>(row.data(), static_cast<Eigen::Index>(row.size()));
}
std::vector<double> as_row(const Vector& v) { return {v.data(), v.data() + v.size()}; }

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
    Vector E = Vector::Zero(y.size());
    // A fixed wall keeps its value: y_wall − y = 0, of the sign that the equations' ∂E/∂y_{j+1} has.
    for (int i = 0; i < system_.lattice().sites(); ++i)
      for (int a = 0; a < d; ++a)
        if (!solved(i, a)) E[i * d + a] = window(unknown_row_ - 1, i, a) - y[i * d + a];
    std::vector<double> values, r;
    for_each_stencil([&](const StencilFamily& family, std::int64_t row, int site) {
      const Cell cell = system_.gather(family, window, row, site, h_, values);
      r.resize(values.size());
      family.residual(cell, values, r);
      for (int m = 0; m < family.size(); ++m)
        if (const int at = equations_[static_cast<std::size_t>(m)]; at >= 0) E[at] += r[static_cast<std::size_t>(m)];
    });
    return E;
  }

  /// ∂E/∂(unknown row), entry by entry; those of one place are to be added.
  std::vector<LatticeSystem::Entry> jacobian_entries(const Vector& y) const {
    const Window window = make_(y);
    const int d = system_.components();
    std::vector<LatticeSystem::Entry> entries;
    for (int i = 0; i < system_.lattice().sites(); ++i)
      for (int a = 0; a < d; ++a)
        if (!solved(i, a)) entries.push_back({i * d + a, i * d + a, -1.0});
    std::vector<double> values, J;
    for_each_stencil([&](const StencilFamily& family, std::int64_t row, int site) {
      if (std::ranges::none_of(factors_, [](double f) { return f != 0; })) return;
      const Cell cell = system_.gather(family, window, row, site, h_, values);
      const auto size = static_cast<std::size_t>(family.size());
      J.resize(size * size);
      family.jacobian(cell, values, J);
      for (std::size_t m = 0; m < size; ++m)
        for (std::size_t n = 0; n < size && equations_[m] >= 0; ++n)
          if (factors_[n] != 0 && J[m * size + n] != 0)
            entries.push_back({equations_[m], places_[n], factors_[n] * J[m * size + n]});
    });
    return entries;
  }

  Matrix jacobian(const Vector& y) const {
    std::vector<Eigen::Triplet<double>> triplets;
    for (const auto& e : jacobian_entries(y)) triplets.emplace_back(e.row, e.column, e.value);
    Matrix J(y.size(), y.size());
    J.setFromTriplets(triplets.begin(), triplets.end());
    return J;
  }

  const Lattice& lattice() const { return system_.lattice(); }

 private:
  bool solved(int i, int a) const { return plan_.solved(i, a); }
  std::int64_t row_of(int i, int a) const {
    return unknown_row_ - plan_.shift(i, a, static_cast<int>(unknown_row_ & 1));
  }

  /// Every stencil that has an equation of the slab, once: it costs the same whichever of its equations is asked for.
  /// Of its values: their places in a row, the equations that are theirs (−1: none), and how much they change with the
  /// unknown row.
  template <class Visit>
  void for_each_stencil(const Visit& visit) const {
    const Lattice& lattice = system_.lattice();
    const int d = system_.components(), N = lattice.sites();
    constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
    std::vector<std::int64_t> rows;  // of the equations, by place
    std::int64_t lowest = unknown_row_, highest = lowest;
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < d; ++a) {
        rows.push_back(solved(i, a) ? row_of(i, a) : none);
        if (rows.back() != none) lowest = std::min(lowest, rows.back()), highest = std::max(highest, rows.back());
      }
    for (const auto& family : system_.families()) {
      const auto [first, last] = std::ranges::minmax(family->pattern().vertices, {}, &Site::time);
      const auto size = static_cast<std::size_t>(family->size());
      places_.resize(size), equations_.resize(size), factors_.resize(size);
      for (std::int64_t anchor = lowest - last.time; anchor <= highest - first.time; ++anchor) {
        for (std::size_t m = 0; m < size; ++m) {
          factors_[m] = 0;
          for (const Dependent& dependent : dependents_)
            if (anchor + family->site(static_cast<int>(m)).time == dependent.row) factors_[m] += dependent.factor;
        }
        for (int i = 0; i < N; ++i) {
          if (!system_.has_stencil(*family, anchor, i)) continue;
          bool any = false;
          for (std::size_t m = 0; m < size; ++m) {
            const Site vertex = family->site(static_cast<int>(m));
            const int x = i + vertex.space, home = lattice.is_circle() ? lattice.wrapped(x) : x;
            places_[m] = home * d + family->values()[m].component;
            const bool there = rows[static_cast<std::size_t>(places_[m])] == anchor + vertex.time;
            equations_[m] = there ? places_[m] : -1;
            any = any || there;
          }
          if (any) visit(*family, anchor, i);
        }
      }
    }
  }

  const LatticeSystem& system_;
  const SolvePlan& plan_;
  std::int64_t unknown_row_;
  double h_;
  MakeWindow make_;
  std::vector<Dependent> dependents_;
  mutable std::vector<int> places_, equations_;
  mutable std::vector<double> factors_;
};

struct Newton {
  bool converged = false;
  /// Every correction is at most a share `tame_ratio` of the one before, and the determinant keeps its sign.
  bool tame = true;
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

/// LU of a band; nothing where there is no band, or it is not safe without pivoting.
std::optional<CyclicBandLU> factor_band(const Lattice& lattice, int size,
                                        const std::vector<LatticeSystem::Entry>& entries) {
  const Bandwidth band = bandwidth(lattice, size, entries);
  // What joins the ends of a circle must stay narrow, or the border is no border.
  if (band.lower + band.upper > 64) return std::nullopt;
  return CyclicBandLU::factor(size, band, lattice.is_circle(), entries);
}

/// y ← y − J⁻¹E(y) with the Jacobian where it begins, while each correction is at most a tenth of the one before: then
/// no other root is near. Not converged where it does not contract like that, or the matrix is no band.
Newton chord(const SlabEquations& equations, Vector y, double absolute_tolerance, int max_iterations) {
  Newton result;
  const auto lu = factor_band(equations.lattice(), static_cast<int>(y.size()), equations.jacobian_entries(y));
  double last = std::numeric_limits<double>::infinity();
  std::vector<double> change;
  for (int it = 1; lu && it <= max_iterations; ++it) {
    result.iterations = it;
    change = as_row(equations.residual(y));
    lu->solve(change);
    const Vector by = as_vector(change);
    if (!by.allFinite()) return result;
    y -= by;
    const double size = largest(by), round_off = 8 * std::numeric_limits<double>::epsilon() * largest(y);
    if (size <= absolute_tolerance || size <= round_off || (size > 0.5 * last && size <= 64 * round_off)) {
      result.converged = true;
      break;
    }
    if (size > 0.1 * last && size > 64 * round_off) return result;
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
    const Newton quick = chord(equations_at(1), predict(1), absolute, max_iterations);
    if (quick.converged) return as_result(quick, quick.iterations);
    const Newton direct = newton(equations_at(1), predict(1), absolute, max_iterations);
    iterations = quick.iterations + direct.iterations;
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
