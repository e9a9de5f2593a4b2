// SPDX-License-Identifier: MIT
#include "schemes/complex/complex_solver.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "lattice/error.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;
using Triplet = Eigen::Triplet<double>;

}  // namespace

class ComplexSolver::Level {
 public:
  /// The unknowns and equations first … last − 1 of a plan, each in a block of its own or not.
  Level(const ComplexSystem& system, const Touching& touching, const ComplexPlan& plan, std::size_t first,
        std::size_t last, bool single)
      : system_(system), single_(single && system.components() == 1) {
    const int d = system.components();
    std::unordered_map<int, int> row, column;
    const bool dense = last - first > at(system.complex().sites()) / 16;
    std::vector<int> rows(dense ? at(system.complex().sites()) : 0, -1), columns(rows);
    const auto put = [&](auto& map, auto& list, int site, int number) {
      dense ? list[at(site)] = number : map[site] = number;
    };
    const auto get = [&](const auto& map, const auto& list, int site) {
      if (dense) return list[at(site)];
      const auto found = map.find(site);
      return found == map.end() ? -1 : found->second;
    };
    std::vector<std::int32_t> stencils;
    for (std::size_t n = first; n < last; ++n) {
      const int number = static_cast<int>(n - first);
      put(row, rows, plan.equations[n], number), put(column, columns, plan.unknowns[n], number);
      for (int a = 0; a < d; ++a) unknowns_.push_back(at(plan.unknowns[n]) * at(d) + at(a));
      const auto touched = touching[plan.equations[n]];
      stencils.insert(stencils.end(), touched.begin(), touched.end());
    }
    const Complex& complex = system.complex();
    std::sort(stencils.begin(), stencils.end(), [&](auto s, auto t) {
      return std::pair(complex.shape_number(s), s) < std::pair(complex.shape_number(t), t);
    });
    stencils.erase(std::unique(stencils.begin(), stencils.end()), stencils.end());
    for (const auto s : stencils) {
      const bool linear = system.family_of(s).is_linear();
      Part& part = linear ? linear_ : nonlinear_;
      part.stencils.push_back(s);
      const auto vertices = complex.vertices(s);
      for (std::size_t l = 0; l < vertices.size(); ++l) {
        const int equation = get(row, rows, vertices[l]);
        for (int a = 0; a < d; ++a) {
          part.rows.push_back(equation < 0 ? -1 : equation * d + a);
          const int unknown = get(column, columns, vertices[l]);
          part.columns.push_back(unknown < 0 ? -1 : unknown * d + a);
        }
        for (std::size_t m = 0; m < vertices.size() && !linear; ++m)
          if (equation >= 0 && get(column, columns, vertices[m]) >= 0 &&
              system.family_of(s).is_varying(static_cast<int>(l), static_cast<int>(m)))
            direct_ = false;
      }
    }
  }

  bool is_direct() const { return direct_; }

  /// The linear equations, E = r(0) + A y, and the part of A that multiplies the unknowns.
  void refresh(std::span<const double> zero) {
    const auto n = static_cast<Eigen::Index>(unknowns_.size());
    std::vector<Triplet> all, of_unknowns;
    at_zero_ = Vector::Zero(n);
    each(linear_, zero, 1, [&](std::size_t i, double r) { at_zero_[linear_.rows[i]] += r; });
    each(linear_, zero, 2, [&](std::size_t i, std::size_t m, std::size_t node, double value) {
      all.emplace_back(linear_.rows[i], static_cast<int>(node), value);
      if (linear_.columns[m] >= 0) of_unknowns.emplace_back(linear_.rows[i], linear_.columns[m], value);
    });
    if (direct_)  // what nonlinear stencils make of the unknowns is constant too
      each(nonlinear_, zero, 2, [&](std::size_t i, std::size_t m, std::size_t, double value) {
        if (nonlinear_.columns[m] >= 0) of_unknowns.emplace_back(nonlinear_.rows[i], nonlinear_.columns[m], value);
      });
    matrix_.resize(n, static_cast<Eigen::Index>(system_.nodes()));
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

  Report solve(std::span<double> y, const Options& options) {
    if (direct_ && single_) return solve_one_by_one(y);
    constexpr double rounding = 1e-10;  // of a correction: below it |E| is rounding too
    Report report;
    Vector E = residual(y), change;
    double size = E.norm();
    for (report.iterations = 1;; ++report.iterations) {
      if (!direct_) linearise(y);
      change = correction(E);
      if (!change.allFinite()) throw NotFinite("a value is not finite; use a shorter step, or another start");
      double share = 1;
      const std::vector<double> before = direct_ ? std::vector<double>() : values(y);
      for (;; share /= 2) {
        for (std::size_t u = 0; u < unknowns_.size(); ++u)
          y[unknowns_[u]] = (direct_ ? y[unknowns_[u]] : before[u]) - share * change[static_cast<Eigen::Index>(u)];
        if (direct_) break;
        E = residual(y);
        // Armijo's rule on |E|, until rounding is all that is left of it
        if (E.norm() <= (1 - 1e-4 * share) * size || share < 1e-6 || relative(y, change) <= rounding) break;
        // Along a valley, as a kink's place is one, |E| rises by its curvature, and yet the next correction is shorter:
        // the natural monotonicity test, Deuflhard, Newton Methods for Nonlinear Problems (2004), section 3.3.
        if (correction(E).norm() <= (1 - share / 2) * change.norm()) break;
      }
      report.shortest = std::min(report.shortest, share);
      if (!direct_ && E.norm() > size / 2 && relative(y, change) > rounding && is_rounding(before, y, E, size)) {
        report.undetermined = relative(y, change);
        return report;
      }
      size = E.norm();
      const double last = report.iterations == 1 ? 1.0 : report.correction;
      report.correction = relative(y, share * change);
      if (direct_ || report.correction <= options.tolerance) return report;
      if (report.correction <= rounding && report.correction > last / 2) return report;  // no digits are left to gain
      if (share < 1e-6 || report.iterations >= options.max_iterations) {
        put(before, y);
        throw NoConvergence(
            fmt::format("Newton's method on a block of {} unknowns stopped at a relative correction of {:.2g}; start "
                        "nearer to a solution, or allow more scheme.max_iterations",
                        unknowns_.size(), report.correction));
      }
    }
  }

 private:
  /// Stencils, and of each value the row and the column that it belongs to, or −1.
  struct Part {
    std::vector<std::int32_t> stencils;
    std::vector<int> rows, columns;
  };

  /// y_u −= E_u/A_uu, row after row: no equation of the level contains the unknown of another.
  Report solve_one_by_one(std::span<double> y) {
    sources_ = at_zero_;
    each(nonlinear_, y, 1, [&](std::size_t i, double r) { sources_[nonlinear_.rows[i]] += r; });
    const int* const first = matrix_.outerIndexPtr();
    const int* const column = matrix_.innerIndexPtr();
    const double* const value = matrix_.valuePtr();
    double finite = 0;
    for (std::size_t n = 0; n < unknowns_.size(); ++n) {
      double E = sources_[static_cast<Eigen::Index>(n)];
      for (int k = first[n]; k < first[n + 1]; ++k) E += value[k] * y[static_cast<std::size_t>(column[k])];
      const double change = E / diagonal_[static_cast<Eigen::Index>(n)];
      y[unknowns_[n]] -= change;
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
  void each(const Part& part, std::span<const double> y, int power, const Use& use) const {
    std::size_t begin = 0;  // of the batch, in values of stencils
    const auto visit = [&](ComplexSystem::Stencils batch, const double* out) {
      const auto size = static_cast<std::size_t>(system_.family_of(batch[0]).size());
      constexpr auto most = static_cast<std::size_t>(PlacedFamily::most);
      for (std::size_t s = 0; s < batch.size(); ++s)
        for (std::size_t i = 0; i < size; ++i) {
          const std::size_t value = begin + s * size + i;
          if (part.rows[value] < 0) continue;
          if constexpr (std::is_invocable_v<Use, std::size_t, double>) use(value, out[i * most + s]);
          else
            for (std::size_t m = 0; m < size; ++m)
              if (const double entry = out[(i * size + m) * most + s]; entry != 0)
                use(value, begin + s * size + m, system_.node(batch[s], static_cast<int>(m)), entry);
        }
      begin += batch.size() * size;
    };
    if (power == 1) system_.each_residual(part.stencils, y, visit);
    else system_.each_jacobian(part.stencils, y, visit);
  }

  Vector residual(std::span<const double> y) const {
    Vector E = at_zero_;
    E.noalias() += matrix_ * Eigen::Map<const Vector>(y.data(), static_cast<Eigen::Index>(y.size()));
    each(nonlinear_, y, 1, [&](std::size_t i, double r) { E[nonlinear_.rows[i]] += r; });
    return E;
  }

  void factor(const Matrix& A) {
    if (!analysed_) solver_.analyzePattern(A);
    analysed_ = true;
    solver_.factorize(A);
    require(solver_.info() == Eigen::Success);
  }

  /// The Jacobian at y, factorised.
  void linearise(std::span<const double> y) {
    std::vector<Triplet> entries;
    each(nonlinear_, y, 2, [&](std::size_t i, std::size_t m, std::size_t, double value) {
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
  bool is_rounding(const std::vector<double>& before, std::span<double> y, const Vector& E, double size) const {
    const double after = E.norm(), least = std::min(size, after);
    const std::vector<double> better = after <= size ? values(y) : before;
    if (!(least <= 1e3 * rounding_of_residual(y))) return false;
    put(better, y);
    return true;
  }
  /// What |E| cannot be less than, since values have 53 bits: 8 ε |Σ_j |∂E_i/∂y_j| |y_j||.
  double rounding_of_residual(std::span<const double> y) const {
    constexpr double few = 8 * std::numeric_limits<double>::epsilon();
    Vector sum =
        matrix_.cwiseAbs() * Eigen::Map<const Vector>(y.data(), static_cast<Eigen::Index>(y.size())).cwiseAbs();
    each(nonlinear_, y, 2, [&](std::size_t i, std::size_t, std::size_t node, double value) {
      sum[nonlinear_.rows[i]] += std::abs(value * y[node]);
    });
    return few * sum.norm();
  }

  void put(const std::vector<double>& unknowns, std::span<double> y) const {
    for (std::size_t u = 0; u < unknowns_.size(); ++u) y[unknowns_[u]] = unknowns[u];
  }
  std::vector<double> values(std::span<const double> y) const {
    std::vector<double> now(unknowns_.size());
    for (std::size_t u = 0; u < now.size(); ++u) now[u] = y[unknowns_[u]];
    return now;
  }
  double relative(std::span<const double> y, const Vector& change) const {
    double largest = 0;
    for (const std::size_t u : unknowns_) largest = std::max(largest, std::abs(y[u]));
    const double most = change.size() == 0 ? 0 : change.lpNorm<Eigen::Infinity>();
    return most == 0 ? 0 : most / std::max(largest, most);
  }

  const ComplexSystem& system_;
  bool single_, direct_ = true, analysed_ = false;
  std::vector<std::size_t> unknowns_;  ///< nodes
  Part linear_, nonlinear_;
  Vector at_zero_, diagonal_, sources_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_;
  Matrix constant_;
  Eigen::SparseLU<Matrix> solver_;
};

ComplexSolver::ComplexSolver(const ComplexSystem& system, Options options)
    : system_(system), options_(options), touching_(system.complex()), plan_(make_plan(system.complex(), touching_)) {
  for (int begin = 0, b = 0; b < plan_.blocks(); begin = b) {
    bool single = true;
    for (; b < plan_.blocks() && plan_.level[at(b)] == plan_.level[at(begin)]; ++b)
      single = single && plan_.first[at(b) + 1] - plan_.first[at(b)] == 1;
    levels_.push_back(
        std::make_unique<Level>(system_, touching_, plan_, at(plan_.first[at(begin)]), at(plan_.first[at(b)]), single));
  }
  refresh();
}

ComplexSolver::~ComplexSolver() = default;
ComplexSolver::ComplexSolver(ComplexSolver&&) noexcept = default;

bool ComplexSolver::is_direct() const {
  return std::ranges::all_of(levels_, [](const auto& level) { return level->is_direct(); });
}

void ComplexSolver::refresh() {
  const std::vector<double> zero(system_.nodes(), 0.0);
  for (const auto& level : levels_) level->refresh(zero);
}

ComplexSolver::Report ComplexSolver::solve(std::span<double> y) const {
  Report all;
  for (const auto& level : levels_) {
    const Report one = level->solve(y, options_);
    all.iterations = std::max(all.iterations, one.iterations);
    all.correction = std::max(all.correction, one.correction);
    all.shortest = std::min(all.shortest, one.shortest);
    all.undetermined = std::max(all.undetermined, one.undetermined);
  }
  return all;
}

}  // namespace delf
