// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/assembled_equations.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/complex/sitewise_lu.hpp"

namespace delf {

/// Where a plan has each site's equation and value, or −1.
struct ComplexSolver::Places {
  std::vector<std::int32_t> equation, unknown;
};

/// Some blocks of one level, solved together. Nothing in them depends on other blocks of the level, but their stencils
/// may hold values of those: all parts of a level find their values before any writes them.
class ComplexSolver::LevelPart {
 public:
  /// Blocks first … last − 1 of a plan, all of one level.
  LevelPart(const ComplexSystem& system, const Touching& touching, const ComplexPlan& plan, const Places& places,
            int first_block, int last_block) {
    const int d = system.components();
    const std::int32_t first = plan.first[first_block], last = plan.first[last_block];
    std::vector<std::int32_t> stencils;
    for (std::int32_t n = first; n < last; ++n) {
      const auto touched = touching[plan.equations[n]];
      stencils.insert(stencils.end(), touched.begin(), touched.end());
    }
    const auto number_in = [&](const std::vector<std::int32_t>& place) {
      return [&, d](std::size_t node) {
        const std::int32_t n = place[node / at(d)];
        return first <= n && n < last ? (n - first) * d + static_cast<int>(node % at(d)) : -1;
      };
    };
    equations_.emplace(system, std::move(stencils), (last - first) * d, number_in(places.equation),
                       number_in(places.unknown));
    for (std::int32_t n = first; n < last; ++n)
      for (int a = 0; a < d; ++a) unknowns_.push_back(at(equations_->place_of(at(plan.unknowns[n]) * at(d) + at(a))));
    for (int b = first_block; b < last_block; ++b) {
      const int size = (plan.first[at(b) + 1] - plan.first[b]) * d;
      first_.push_back((plan.first[b] - first) * d);
      begin_.push_back(entries_);
      largest_ = std::max(largest_, size);
      entries_ += at(size) * at(size);
      block_of_.insert(block_of_.end(), at(size), b - first_block);
    }
    first_.push_back(static_cast<int>(unknowns_.size()));
    if (!is_small()) make_solver(system, plan, first, last);
    refresh();
  }

  bool is_direct() const { return equations_->is_direct(); }
  /// Frees the factors of a Newton step, which no other step needs.
  void forget() {
    if (solver_ && !is_direct()) solver_->forget();
  }
  /// Without what a sparse factorisation fills in.
  std::size_t bytes() const {
    const auto numbers = [](const auto&... all) { return (... + (all.capacity() * sizeof(all[0]))); };
    return equations_->bytes() + numbers(unknowns_, first_, block_of_, begin_, blocks_) +
           8 * at(y_.size() + diagonal_.size() + sources_.size());
  }

  /// Finds the unknowns from the other values of y, without writing them there: other parts may read y.
  Report find(std::span<const double> y, const Options& options) {
    equations_->read(y, y_);
    if (is_direct() && largest_ == 1) return solve_one_by_one();
    constexpr double rounding = 1e-10;  // of a correction: below it |E| is rounding too
    const bool direct = is_direct();
    Report report;
    Vector E = equations_->residual(y_), change;
    double size = E.norm();
    for (report.iterations = 1;; ++report.iterations) {
      if (options.is_to_end && options.is_to_end()) {
        report.ended = true;
        return report;
      }
      if (!direct) linearise();
      change = correction(E);
      if (!change.allFinite()) throw NotFinite("a value is not finite; use a shorter step, or another start");
      double share = 1;
      const std::vector<double> before = direct ? std::vector<double>() : values();
      for (;; share /= 2) {
        for (std::size_t u = 0; u < unknowns_.size(); ++u)
          unknown(u) = (direct ? unknown(u) : before[u]) - share * change[static_cast<Eigen::Index>(u)];
        if (direct) break;
        E = equations_->residual(y_);
        // Armijo's rule on |E|, until rounding is all that is left of it
        if (E.norm() <= (1 - 1e-4 * share) * size || share < 1e-6 || relative(change) <= rounding) break;
        // Along a valley, as a kink's place is one, |E| rises by its curvature, and yet the next correction is shorter:
        // the natural monotonicity test, Deuflhard, Newton Methods for Nonlinear Problems (2004), section 3.3.
        if (correction(E).norm() <= (1 - share / 2) * change.norm()) break;
      }
      report.shortest = std::min(report.shortest, share);
      if (!direct && E.norm() > size / 2 && relative(change) > rounding && is_rounding(before, E, size)) {
        report.undetermined = relative(change);
        return report;
      }
      size = E.norm();
      const double last = report.iterations == 1 ? 1.0 : report.correction;
      report.correction = relative(share * change);
      if (direct || report.correction <= options.tolerance) return report;
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
    for (const std::size_t u : unknowns_) y[equations_->nodes()[u]] = y_[static_cast<Eigen::Index>(u)];
  }

 private:
  using Matrix = AssembledEquations::Matrix;
  using Vector = AssembledEquations::Vector;
  static constexpr int small_block = 8;  ///< unknowns: solved as a dense matrix
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, small_block, small_block>;

  /// Values of a point of spacetime may be sites of their own: a place is where they lie.
  void make_solver(const ComplexSystem& system, const ComplexPlan& plan, std::int32_t first, std::int32_t last) {
    std::map<Complex::Position, int> number;
    const auto places = [&](const std::vector<std::int32_t>& sites) {
      std::vector<int> list;
      for (std::int32_t n = first; n < last; ++n) {
        const Complex::Position& position = system.complex().position(sites[n]);
        const int place = number.try_emplace(position, static_cast<int>(number.size())).first->second;
        list.insert(list.end(), at(system.components()), place);
      }
      return list;
    };
    std::vector<int> of_equations = places(plan.equations), of_unknowns = places(plan.unknowns);
    solver_.emplace(std::move(of_equations), std::move(of_unknowns), static_cast<int>(number.size()));
  }

  bool is_small() const { return largest_ <= small_block; }

  /// What is solved for directly.
  void refresh() {
    if (!is_direct()) return;
    if (largest_ > 1) {
      take(equations_->of_unknowns());
      if (!is_small()) require(!is_singular_to_rounding(equations_->of_unknowns()));
      return;
    }
    diagonal_ = equations_->of_unknowns().diagonal();
    require(diagonal_.size() == 0 || diagonal_.cwiseAbs().minCoeff() > 0);
  }

  /// y_u −= E_u/A_uu, row after row: no equation of a level contains the unknown of another.
  Report solve_one_by_one() {
    sources_ = equations_->at_zero();
    equations_->add_nonlinear(y_, sources_);
    const AssembledEquations::Rows& matrix = equations_->matrix();
    const int* const first = matrix.outerIndexPtr();
    const int* const column = matrix.innerIndexPtr();
    const double* const entry = matrix.valuePtr();
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
      throw NoConvergence(
          "a block of the complex is singular: its equations leave some of its values free, as those of a natural "
          "boundary leave a constant; give other data");
  }

  /// Whether A x = r, for some r of size 1, has an x as large as only rounding in A makes it.
  bool is_singular_to_rounding(const Matrix& A) const {
    constexpr double most = 1e14;
    Vector r(A.rows());
    for (Eigen::Index i = 0; i < r.size(); ++i) r[i] = std::cos(static_cast<double>(i) * static_cast<double>(i));
    double largest = 0;
    for (Eigen::Index e = 0; e < A.nonZeros(); ++e) largest = std::max(largest, std::abs(A.valuePtr()[e]));
    return !(solver_->solve(r).lpNorm<Eigen::Infinity>() * largest < most);
  }

  /// The Jacobian at y.
  void linearise() {
    if (is_small()) {
      take(equations_->of_unknowns());
      equations_->each_varying(y_, [&](int i, int m, double value) { entry(i, m) += value; });
      return;
    }
    std::vector<Eigen::Triplet<double>> entries;
    equations_->each_varying(y_, [&](int i, int m, double value) { entries.emplace_back(i, m, value); });
    const Matrix& constant = equations_->of_unknowns();
    Matrix A(constant.rows(), constant.cols());
    A.setFromTriplets(entries.begin(), entries.end());
    A += constant;
    A.makeCompressed();
    factor(A);
  }

  /// A matrix of the unknowns: as dense blocks, if they are small, or factorised.
  void take(const Matrix& A) {
    if (!is_small()) return factor(A);
    blocks_.assign(entries_, 0.0);
    for (Eigen::Index m = 0; m < A.outerSize(); ++m)
      for (Matrix::InnerIterator e(A, m); e; ++e) entry(static_cast<int>(e.row()), static_cast<int>(m)) += e.value();
  }
  double& entry(int i, int m) {
    const std::size_t b = at(block_of_[i]);
    return blocks_[begin_[b] + at((i - first_[b]) * (first_[b + 1] - first_[b]) + m - first_[b])];
  }

  void factor(const Matrix& A) { require(solver_->factorize(A)); }

  Vector correction(const Vector& E) const {
    if (!is_small()) return solver_->solve(E);
    Vector change(E.size());
    for (std::size_t b = 0; b + 1 < first_.size(); ++b) {
      const int size = first_[b + 1] - first_[b];
      const double* const block = blocks_.data() + begin_[b];
      if (size == 1) {
        change[first_[b]] = E[first_[b]] / *block;
        continue;
      }
      const Eigen::PartialPivLU<Small> lu(Eigen::Map<const Small>(block, size, size));
      require(lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 0);
      change.segment(first_[b], size) = lu.solve(E.segment(first_[b], size));
    }
    return change;
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
    return few * equations_->absolute(y_).norm();
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

  std::optional<AssembledEquations> equations_;
  Vector y_;                           ///< of the nodes that they read
  std::vector<std::size_t> unknowns_;  ///< places in y_
  std::vector<int> first_, block_of_;  ///< unknown of each block, and the end; block of each unknown
  int largest_ = 0;                    ///< block
  std::vector<std::size_t> begin_;     ///< of each block in blocks_, where all are small
  std::size_t entries_ = 0;
  std::vector<double> blocks_;
  Vector diagonal_, sources_;
  std::optional<SitewiseLU> solver_;  ///< of blocks that are not small
};

}  // namespace delf
