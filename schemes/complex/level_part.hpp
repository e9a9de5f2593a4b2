// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "schemes/solvers/block_solver.hpp"
#include "schemes/solvers/newton.hpp"
#include "schemes/system/assembly.hpp"

namespace delf {

/// Some blocks of one level, solved together. Nothing in them depends on other blocks of the level, but their stencils
/// may hold values of those: all parts of a level find their values before any writes them.
class ComplexSolver::LevelPart {
 public:
  /// Blocks first … last − 1 of a plan, all of one level.
  LevelPart(const ComplexSystem& system, const Touching& touching, const ComplexPlan& plan, int first_block,
            int last_block) {
    const int d = system.components();
    const std::int32_t first = plan.first[first_block], last = plan.first[last_block];
    Assembly::Parts parts{.equations = {}, .matched = true, .stencils = std::vector<Assembly::Anchor>()};
    std::vector<std::int32_t> stencils;
    for (std::int32_t n = first; n < last; ++n) {
      const auto touched = touching[plan.equations[n]];
      stencils.insert(stencils.end(), touched.begin(), touched.end());
      for (int a = 0; a < d; ++a) {
        parts.equations.push_back({{0, plan.equations[n]}, a});
        parts.unknowns.push_back({{0, plan.unknowns[n]}, a});
      }
    }
    sort_unique(stencils);
    for (const auto stencil : stencils) {
      parts.stencils->push_back(system.anchor(stencil));
      const auto vertices = system.complex().vertices(stencil);
      sites_.insert(sites_.end(), vertices.begin(), vertices.end());
    }
    sort_unique(sites_);
    parts.place = [this](Site site) {
      return static_cast<int>(std::ranges::lower_bound(sites_, site.space) - sites_.begin());
    };
    equations_.emplace(system.row(), std::move(parts));
    y_.resize(sites_.size() * at(d));
    for (int n = 0; n < equations_->size(); ++n) unknowns_.push_back(equations_->place(equations_->unknown(n)));
    for (int b = first_block; b <= last_block; ++b) first_.push_back((plan.first[b] - first) * d);
    for (const auto* list : {&plan.equations, &plan.unknowns}) {
      std::vector<int>& sites = list == &plan.equations ? places_.of_rows : places_.of_columns;
      for (std::int32_t n = first; n < last; ++n) sites.insert(sites.end(), at(d), list->at(n));
    }
    for (int b = first_block; b < last_block; ++b)
      largest_ = std::max(largest_, first_[b + 1 - first_block] - first_[b - first_block]);
    if (!is_small()) join_places(system.complex());
    direct_ = equations_->is_linear();
    if (!direct_) return;
    linearise();
    require(!is_singular_to_rounding());
  }

  bool is_direct() const { return direct_; }
  /// Frees the factors of a Newton step, which no other step needs.
  void forget() {
    if (!direct_) solver_.reset();
  }
  std::size_t bytes() const {
    return equations_->bytes() + (solver_ ? solver_->bytes() : 0) + 8 * (y_.size() + J_.size()) +
           4 * (sites_.size() + unknowns_.size() + first_.size());
  }

  /// Finds the unknowns from the other values of y, without writing them there: other parts may read y.
  Report find(std::span<const double> y, const Options& options) {
    const std::size_t d = y_.size() / std::max<std::size_t>(1, sites_.size());
    for (std::size_t n = 0; n < y_.size(); ++n) y_[n] = y[at(sites_[n / d]) * d + n % d];
    options_ = &options;
    report_ = {};
    if (is_to_end()) return {.iterations = 1, .ended = true};
    evaluate();
    size_ = norm(E_);
    NewtonProgress at;
    const auto if_true = [](const bool& flag, Stop stop) {
      return [&flag, stop](const NewtonProgress&) { return flag ? stop : Stop::no; };
    };
    const auto if_to_end = [&](const NewtonProgress&) {
      report_.ended = is_to_end();
      return report_.ended ? Stop::rounding : Stop::no;
    };
    const Stop stop = newton(*this, at, if_true(undetermined_, Stop::rounding), if_true(direct_, Stop::converged),
                             Converged{.relative = options.tolerance}, Rounding{.most = rounding, .ratio = 0.5},
                             if_true(stuck_, Stop::stalls), OutOfIterations{options.max_iterations}, if_to_end);
    report_.iterations = at.iteration;
    report_.correction = at.size > 0 ? at.correction / at.size : 0;
    require(stop != Stop::singular);
    if (!has_root(stop))
      throw NoConvergence(
          fmt::format("Newton's method on a block of {} unknowns stopped at a relative correction of {:.2g}; start "
                      "nearer to a solution, or allow more scheme.max_iterations",
                      unknowns_.size(), report_.correction));
    return report_;
  }

  /// Writes what was found.
  void write(std::span<double> y) const {
    const std::size_t d = y_.size() / std::max<std::size_t>(1, sites_.size());
    for (const int u : unknowns_) y[at(sites_[at(u) / d]) * d + at(u) % d] = y_[u];
  }

  // Newton's equations at y: the solver is that of J there.
  bool linearise(const NewtonProgress& = {}) {
    if (direct_ && solver_) return true;
    equations_->jacobian(section(), 0, J_);
    if (!solver_) {
      std::vector<std::pair<int, int>> places;
      for (const auto& [equation, unknown] : equations_->places()) places.emplace_back(equation, unknown);
      solver_.emplace(first_, places, present(), places_);
    }
    if (solver_->factor(J_)) return true;
    require(!direct_);
    return false;
  }
  const std::vector<double>& residual() const { return E_; }
  const std::vector<double>& solve(const std::vector<double>& E) {
    solver_->solve(E, change_);
    return change_;
  }
  /// A step as long as |E| falls by Armijo's rule, or as corrections are shorter behind it: along a valley, as a kink's place
  /// is one, |E| rises by its curvature. The natural monotonicity test, Deuflhard, Newton Methods for Nonlinear Problems (2004),
  /// section 3.3.
  void apply(const std::vector<double>& change, NewtonProgress& at) {
    const double most = largest(change);
    if (!std::isfinite(most)) throw NotFinite("a value is not finite; use a shorter step, or another start");
    const std::vector<double> before = values();
    const auto relative = [&] { return most == 0 ? 0 : most / std::max(largest_value(), most); };
    double share = 1;
    for (;; share /= 2) {
      for (std::size_t u = 0; u < unknowns_.size(); ++u) y_[unknowns_[u]] = before[u] - share * change[u];
      if (direct_) break;
      evaluate();
      if (norm(E_) <= (1 - 1e-4 * share) * size_ || share < shortest || relative() <= rounding) break;
      const double length = norm(change);
      std::vector<double> next;
      solver_->solve(E_, next);
      if (norm(next) <= (1 - share / 2) * length) break;
    }
    stuck_ = share < shortest;
    undetermined_ = !direct_ && norm(E_) > size_ / 2 && relative() > rounding && is_rounding(before);
    if (undetermined_) report_.undetermined = relative();
    size_ = norm(E_);
    at.take(share * most, std::max(largest_value(), share * most));
  }

 private:
  static constexpr int small_block = 8;      ///< unknowns: a dense matrix
  static constexpr double rounding = 1e-10;  ///< of a correction: below it |E| is rounding too
  static constexpr double shortest = 1e-6;   ///< part of a step

  static void sort_unique(std::vector<std::int32_t>& list) {
    std::ranges::sort(list);
    list.erase(std::ranges::unique(list).begin(), list.end());
  }
  static void require(bool regular) {
    if (!regular)
      throw NoConvergence(
          "a block of the complex is singular: its equations leave some of its values free, as those of a natural "
          "boundary leave a constant; give other data");
  }
  static double largest(const std::vector<double>& all) {
    double most = 0;
    for (const double x : all) most = larger_or_nan(std::abs(x), most);
    return most;
  }
  static double norm(const std::vector<double>& all) {
    double sum = 0;
    for (const double x : all) sum += x * x;
    return std::sqrt(sum);
  }

  /// Values of a point of spacetime may be sites of their own: their place is where they lie.
  void join_places(const Complex& complex) {
    std::map<Complex::Position, int> number;
    for (auto* sites : {&places_.of_columns, &places_.of_rows})
      for (int& site : *sites)
        site = number.try_emplace(complex.position(site), static_cast<int>(number.size())).first->second;
  }

  bool is_small() const { return largest_ <= small_block; }
  /// The entries that a solver of large blocks needs, those that are not zero: of direct equations, whose J is the same
  /// everywhere, those that are not zero now.
  std::vector<char> present() const {
    if (is_small()) return std::vector<char>(J_.size(), true);
    if (!direct_) return equations_->present();
    std::vector<char> found;
    for (const double value : J_) found.push_back(value != 0);
    return found;
  }

  /// True if J x = r, for some r of size 1, has an x as large as only rounding in J makes it.
  bool is_singular_to_rounding() {
    constexpr double most = 1e14;
    if (is_small()) return false;  // pivots say it
    std::vector<double> r(unknowns_.size());
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = std::cos(static_cast<double>(i) * static_cast<double>(i));
    return !(largest(solve(r)) * largest(J_) < most);
  }

  bool is_to_end() const { return options_->is_to_end && options_->is_to_end(); }
  SectionView section() const { return {y_.data(), 1, y_.size()}; }
  void evaluate() { equations_->residual(section(), 0, E_); }

  /// True if a step from `before`, with |E| = size_, to y has come to where |E| is rounding: from a thousand times that, a
  /// step of Newton's method would end at it, unless the matrix is nearly singular. A static kink on a fine lattice may
  /// stand anywhere. Then y is the better one of both.
  bool is_rounding(const std::vector<double>& before) {
    const double after = norm(E_), least = std::min(size_, after);
    if (!(least <= 1e3 * rounding_of_residual())) return false;
    for (std::size_t u = 0; u < unknowns_.size() && after > size_; ++u) y_[unknowns_[u]] = before[u];
    return true;
  }
  /// The least |E| that there can be, since values have 53 bits: 8 ε |Σ_j |∂E_i/∂y_j| |y_j||.
  double rounding_of_residual() {
    constexpr double few = 8 * std::numeric_limits<double>::epsilon();
    Assembly::Variation all{section()};
    std::vector<double> J;
    equations_->linearised(section(), 0, {&all, 1}, J);
    return few * norm(all.absolute);
  }

  std::vector<double> values() const {
    std::vector<double> now;
    for (const int u : unknowns_) now.push_back(y_[u]);
    return now;
  }
  double largest_value() const {
    double most = 0;
    for (const int u : unknowns_) most = std::max(most, std::abs(y_[u]));
    return most;
  }

  std::vector<std::int32_t> sites_;  ///< that the stencils read, ascending
  std::optional<Assembly> equations_;
  bool direct_ = false;                     ///< with data given, the equations are linear
  std::vector<double> y_, E_, J_, change_;  ///< y of these sites
  std::vector<int> unknowns_;               ///< places in y_
  std::vector<int> first_;                  ///< unknown of each block, and the end
  int largest_ = 0;                         ///< block
  BlockSolver::Sites places_;
  std::optional<BlockSolver> solver_;

  const Options* options_ = nullptr;
  Report report_;
  double size_ = 0;  ///< |E|
  bool undetermined_ = false, stuck_ = false;
};

}  // namespace delf
