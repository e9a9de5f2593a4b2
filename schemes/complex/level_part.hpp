// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/error.hpp"
#include "schemes/complex/complex_solver.hpp"

namespace delf {

/// Where a plan has each site's equation and value, or −1.
struct ComplexSolver::Places {
  std::vector<std::int32_t> equation, unknown;
};

/// Some blocks of one level, solved together. Nothing in them depends on other blocks of the level, but their stencils
/// may hold values of those: all parts of a level find their values before any writes them.
class ComplexSolver::Part {
 public:
  /// Blocks first … last − 1 of a plan, all of one level.
  Part(const ComplexSystem& system, const Touching& touching, const ComplexPlan& plan, const Places& places,
       int first_block, int last_block)
      : system_(system) {
    const int d = system.components();
    const std::int32_t first = plan.first[at(first_block)], last = plan.first[at(last_block)];
    single_ = d == 1 && last - first == last_block - first_block;
    const auto number = [&](std::int32_t place) { return first <= place && place < last ? place - first : -1; };
    std::vector<std::int32_t> stencils;
    for (std::int32_t n = first; n < last; ++n) {
      const auto touched = touching[plan.equations[at(n)]];
      stencils.insert(stencils.end(), touched.begin(), touched.end());
    }
    const Complex& complex = system.complex();
    std::sort(stencils.begin(), stencils.end(), [&](auto s, auto t) {
      return std::pair(complex.shape_number(s), s) < std::pair(complex.shape_number(t), t);
    });
    stencils.erase(std::unique(stencils.begin(), stencils.end()), stencils.end());
    for (const auto s : stencils)
      for (int i = 0; i < system.family_of(s).size(); ++i) nodes_.push_back(system.node(s, i));
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    y_.resize(nodes_.size());
    const auto place = [&](std::size_t node) {
      return static_cast<std::int32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
    };
    for (std::int32_t n = first; n < last; ++n)
      for (int a = 0; a < d; ++a) unknowns_.push_back(at(place(at(plan.unknowns[at(n)]) * at(d) + at(a))));
    for (const auto s : stencils) {
      const bool linear = system.family_of(s).is_linear();
      Terms& terms = linear ? linear_ : nonlinear_;
      terms.stencils.push_back(s);
      const auto vertices = complex.vertices(s);
      for (std::size_t l = 0; l < vertices.size(); ++l) {
        const int equation = number(places.equation[at(vertices[l])]);
        const int unknown = number(places.unknown[at(vertices[l])]);
        for (int a = 0; a < d; ++a) {
          terms.places.push_back(place(at(vertices[l]) * at(d) + at(a)));
          terms.rows.push_back(equation < 0 ? -1 : equation * d + a);
          terms.columns.push_back(unknown < 0 ? -1 : unknown * d + a);
        }
        for (std::size_t m = 0; m < vertices.size() && !linear; ++m)
          if (equation >= 0 && number(places.unknown[at(vertices[m])]) >= 0 &&
              system.family_of(s).is_varying(static_cast<int>(l), static_cast<int>(m)))
            direct_ = false;
      }
    }
  }

  std::size_t stencils() const { return linear_.stencils.size() + nonlinear_.stencils.size(); }
  bool is_direct() const { return direct_; }

  /// The linear equations, E = r(0) + A y, and the part of A that multiplies the unknowns.
  void refresh() {
    const auto n = static_cast<Eigen::Index>(unknowns_.size());
    y_.setZero();
    std::vector<Triplet> all, of_unknowns;
    at_zero_ = Vector::Zero(n);
    each(linear_, 1, [&](std::size_t i, double r) { at_zero_[linear_.rows[i]] += r; });
    each(linear_, 2, [&](std::size_t i, std::size_t m, double value) {
      all.emplace_back(linear_.rows[i], linear_.places[m], value);
      if (linear_.columns[m] >= 0) of_unknowns.emplace_back(linear_.rows[i], linear_.columns[m], value);
    });
    if (direct_)  // what nonlinear stencils make of the unknowns is constant too
      each(nonlinear_, 2, [&](std::size_t i, std::size_t m, double value) {
        if (nonlinear_.columns[m] >= 0) of_unknowns.emplace_back(nonlinear_.rows[i], nonlinear_.columns[m], value);
      });
    matrix_.resize(n, y_.size());
    matrix_.setFromTriplets(all.begin(), all.end());
    constant_.resize(n, n);
    constant_.setFromTriplets(of_unknowns.begin(), of_unknowns.end());
    diagonal_ = constant_.diagonal();
    if (direct_) {
      if (single_) require(diagonal_.cwiseAbs().minCoeff() > 0);
      else factor(constant_);
    }
    analysed_ = false;
  }

  /// Finds the unknowns from the other values of y, without writing them there: other parts may read y.
  Report find(std::span<const double> y, const Options& options) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) y_[static_cast<Eigen::Index>(n)] = y[nodes_[n]];
    if (direct_ && single_) return solve_one_by_one();
    constexpr double rounding = 1e-10;  // of a correction: below it |E| is rounding too
    Report report;
    Vector E = residual(), change;
    double size = E.norm();
    for (report.iterations = 1;; ++report.iterations) {
      if (!direct_) linearise();
      change = correction(E);
      if (!change.allFinite()) throw NotFinite("a value is not finite; use a shorter step, or another start");
      double share = 1;
      const std::vector<double> before = direct_ ? std::vector<double>() : values();
      for (;; share /= 2) {
        for (std::size_t u = 0; u < unknowns_.size(); ++u)
          unknown(u) = (direct_ ? unknown(u) : before[u]) - share * change[static_cast<Eigen::Index>(u)];
        if (direct_) break;
        E = residual();
        // Armijo's rule on |E|, until rounding is all that is left of it
        if (E.norm() <= (1 - 1e-4 * share) * size || share < 1e-6 || relative(change) <= rounding) break;
        // Along a valley, as a kink's place is one, |E| rises by its curvature, and yet the next correction is shorter:
        // the natural monotonicity test, Deuflhard, Newton Methods for Nonlinear Problems (2004), section 3.3.
        if (correction(E).norm() <= (1 - share / 2) * change.norm()) break;
      }
      report.shortest = std::min(report.shortest, share);
      if (!direct_ && E.norm() > size / 2 && relative(change) > rounding && is_rounding(before, E, size)) {
        report.undetermined = relative(change);
        return report;
      }
      size = E.norm();
      const double last = report.iterations == 1 ? 1.0 : report.correction;
      report.correction = relative(share * change);
      if (direct_ || report.correction <= options.tolerance) return report;
      if (report.correction <= rounding && report.correction > last / 2) return report;  // no digits are left to gain
      if (share < 1e-6 || report.iterations >= options.max_iterations)
        throw NoConvergence(
            fmt::format("Newton's method on a block of {} unknowns stopped at a relative correction of {:.2g}; start "
                        "nearer to a solution, or allow more scheme.max_iterations",
                        unknowns_.size(), report.correction));
    }
  }

  /// Writes what was found.
  void write(std::span<double> y) const {
    for (const std::size_t u : unknowns_) y[nodes_[u]] = y_[static_cast<Eigen::Index>(u)];
  }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  using Vector = Eigen::VectorXd;
  using Triplet = Eigen::Triplet<double>;
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  /// Stencils, and of each value its place in y_, and the row and the column that it belongs to, or −1.
  struct Terms {
    std::vector<std::int32_t> stencils, places;
    std::vector<int> rows, columns;
  };

  /// y_u −= E_u/A_uu, row after row: no equation of a level contains the unknown of another.
  Report solve_one_by_one() {
    sources_ = at_zero_;
    each(nonlinear_, 1, [&](std::size_t i, double r) { sources_[nonlinear_.rows[i]] += r; });
    const int* const first = matrix_.outerIndexPtr();
    const int* const column = matrix_.innerIndexPtr();
    const double* const entry = matrix_.valuePtr();
    double finite = 0;
    for (std::size_t n = 0; n < unknowns_.size(); ++n) {
      double E = sources_[static_cast<Eigen::Index>(n)];
      for (int k = first[n]; k < first[n + 1]; ++k) E += entry[k] * y_[column[k]];
      const double change = E / diagonal_[static_cast<Eigen::Index>(n)];
      unknown(n) -= change;
      finite += change * 0;
    }
    if (!(finite == 0)) throw NotFinite("a value is not finite; use a shorter step, or another start");
    return {1, 0, 1, 0};
  }

  static void require(bool regular) {
    if (!regular)
      throw NoConvergence("a block of the complex is singular: its matching is structural only; give other data");
  }

  template <class Use>
  void each(const Terms& terms, int power, const Use& use) const {
    std::size_t begin = 0;  // of the batch, in values of stencils
    const auto visit = [&](ComplexSystem::Stencils batch, const double* out) {
      const auto size = static_cast<std::size_t>(system_.family_of(batch[0]).size());
      constexpr auto most = static_cast<std::size_t>(PlacedFamily::most);
      for (std::size_t s = 0; s < batch.size(); ++s)
        for (std::size_t i = 0; i < size; ++i) {
          const std::size_t value = begin + s * size + i;
          if (terms.rows[value] < 0) continue;
          if constexpr (std::is_invocable_v<Use, std::size_t, double>) use(value, out[i * most + s]);
          else
            for (std::size_t m = 0; m < size; ++m)
              if (const double entry = out[(i * size + m) * most + s]; entry != 0)
                use(value, begin + s * size + m, entry);
        }
      begin += batch.size() * size;
    };
    const std::span<const double> y{y_.data(), nodes_.size()};
    if (power == 1) system_.each_residual(terms.stencils, y, visit, terms.places);
    else system_.each_jacobian(terms.stencils, y, visit, terms.places);
  }

  Vector residual() const {
    Vector E = at_zero_;
    E.noalias() += matrix_ * y_;
    each(nonlinear_, 1, [&](std::size_t i, double r) { E[nonlinear_.rows[i]] += r; });
    return E;
  }

  void factor(const Matrix& A) {
    if (!analysed_) solver_.analyzePattern(A);
    analysed_ = true;
    solver_.factorize(A);
    require(solver_.info() == Eigen::Success);
  }

  /// The Jacobian at y, factorised.
  void linearise() {
    std::vector<Triplet> entries;
    each(nonlinear_, 2, [&](std::size_t i, std::size_t m, double value) {
      if (nonlinear_.columns[m] >= 0) entries.emplace_back(nonlinear_.rows[i], nonlinear_.columns[m], value);
    });
    Matrix A(constant_.rows(), constant_.cols());
    A.setFromTriplets(entries.begin(), entries.end());
    A += constant_;
    A.makeCompressed();
    if (single_) diagonal_ = A.diagonal();
    else factor(A);
  }

  Vector correction(const Vector& E) const {
    return single_ ? Vector(E.cwiseQuotient(diagonal_)) : Vector(solver_.solve(E));
  }

  /// Whether a step from `before`, with |E| = size, to y has come to where |E| is rounding: from a thousand times that, a
  /// step of Newton's method would end at it, unless the matrix is nearly singular. A static kink on a fine lattice may
  /// stand anywhere. Then y is the better one of both.
  bool is_rounding(const std::vector<double>& before, const Vector& E, double size) {
    const double after = E.norm(), least = std::min(size, after);
    const std::vector<double> better = after <= size ? values() : before;
    if (!(least <= 1e3 * rounding_of_residual())) return false;
    put(better);
    return true;
  }
  /// What |E| cannot be less than, since values have 53 bits: 8 ε |Σ_j |∂E_i/∂y_j| |y_j||.
  double rounding_of_residual() const {
    constexpr double few = 8 * std::numeric_limits<double>::epsilon();
    Vector sum = matrix_.cwiseAbs() * y_.cwiseAbs();
    each(nonlinear_, 2, [&](std::size_t i, std::size_t m, double value) {
      sum[nonlinear_.rows[i]] += std::abs(value * y_[nonlinear_.places[m]]);
    });
    return few * sum.norm();
  }

  double& unknown(std::size_t u) { return y_[static_cast<Eigen::Index>(unknowns_[u])]; }
  void put(const std::vector<double>& unknowns) {
    for (std::size_t u = 0; u < unknowns_.size(); ++u) unknown(u) = unknowns[u];
  }
  std::vector<double> values() const {
    std::vector<double> now;
    for (const std::size_t u : unknowns_) now.push_back(y_[static_cast<Eigen::Index>(u)]);
    return now;
  }
  double relative(const Vector& change) const {
    double largest = 0;
    for (const std::size_t u : unknowns_) largest = std::max(largest, std::abs(y_[static_cast<Eigen::Index>(u)]));
    const double most = change.size() == 0 ? 0 : change.lpNorm<Eigen::Infinity>();
    return most == 0 ? 0 : most / std::max(largest, most);
  }

  const ComplexSystem& system_;
  bool single_ = false, direct_ = true, analysed_ = false;
  std::vector<std::size_t> nodes_;     ///< that its stencils read
  Vector y_;                           ///< their values here
  std::vector<std::size_t> unknowns_;  ///< places in y_
  Terms linear_, nonlinear_;
  Vector at_zero_, diagonal_, sources_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_;
  Matrix constant_;
  Eigen::SparseLU<Matrix> solver_;
};

}  // namespace delf
