// SPDX-License-Identifier: MIT
#include "schemes/verify/newton_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "schemes/stepping/gauge.hpp"
#include "schemes/stepping/slab_solver.hpp"
#include "schemes/system/slab_extent.hpp"

namespace delf {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_iterations = 60;  ///< enough for an error that shrinks by 0.6 each time
constexpr double nearest = 1e-4;     ///< of the starts, relative to the field

/// One slab of a solution: its equations, and its unknowns as one vector.
class SolvedSlab {
 public:
  SolvedSlab(const LatticeSystem& system, const SolvePlan& plan, const Window& solution, const SlabExtent& extent)
      : system_(system),
        J_(solution.last_row() - extent.above),
        parity_(static_cast<int>(((J_ % plan.table.parities) + plan.table.parities) % plan.table.parities)),
        equations_(system, Assembly::slab(plan, parity_, extent.past(), extent.above, solution.monodromy)),
        ring_(solution, J_ - extent.past(), J_ + extent.above),
        solver_(solver_of(equations_)) {
    for (int n = 0; n < size(); ++n) solution_.push_back(equations_.value(ring_, J_, n));
  }

  std::int64_t number() const { return J_; }
  int size() const { return equations_.size(); }
  const std::vector<double>& solution() const { return solution_; }

  /// Multipliers have no scale of their own.
  bool is_multiplier(int n) const {
    return system_.component(equations_.unknown(n).component).role == Role::multiplier;
  }
  /// max |y| of the fields, or of the multipliers; 1 if all are zero.
  double scale(bool multipliers) const {
    double largest = 0;
    for (int n = 0; n < size(); ++n)
      if (is_multiplier(n) == multipliers) largest = std::max(largest, std::abs(solution_[n]));
    return largest > 0 ? largest : 1;
  }
  /// max |a − b| of the fields; infinite if it is not a number.
  double distance(const std::vector<double>& a, const std::vector<double>& b) const {
    double largest = 0;
    for (int n = 0; n < size(); ++n) {
      if (is_multiplier(n)) continue;
      const double by = std::abs(a[n] - b[n]);
      largest = std::isfinite(by) ? std::max(largest, by) : std::numeric_limits<double>::infinity();
    }
    return largest;
  }

  /// y − (∂E/∂y)⁻¹ E(y); nothing if the Jacobian is singular.
  std::optional<std::vector<double>> newton_step(std::vector<double> y) {
    for (int n = 0; n < size(); ++n) equations_.value(ring_, J_, n) = y[n];
    equations_.jacobian(ring_, J_, entries_);
    if (!solver_.factor(entries_)) return std::nullopt;
    equations_.residual(ring_, J_, E_);
    solver_.solve(E_, change_);
    for (std::size_t n = 0; n < y.size(); ++n) y[n] -= change_[n];
    return y;
  }

 private:
  const LatticeSystem& system_;
  std::int64_t J_;
  int parity_;
  Assembly equations_;
  SectionRing ring_;
  BlockSolver solver_;
  std::vector<double> solution_, entries_, E_, change_;
};

std::vector<double> perturbed(const SolvedSlab& slab, double amplitude, std::mt19937_64& engine) {
  const double field = slab.scale(false), multiplier = slab.scale(true);
  std::vector<double> y = slab.solution();
  for (int n = 0; n < slab.size(); ++n) {
    const double random = 2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0;
    y[n] += amplitude * (slab.is_multiplier(n) ? multiplier : field) * random;
  }
  return y;
}

/// The errors e_0, e_1, … of Newton's method from y, with what they can be trusted down to.
struct Descent {
  std::vector<double> errors;
  double floor = 0;
};
/// Nothing if it does not converge.
std::optional<Descent> descend(SolvedSlab& slab, std::vector<double> y) {
  const double size = slab.scale(false);
  std::vector<std::vector<double>> iterates{std::move(y)};
  double before = std::numeric_limits<double>::infinity(), change = before;
  for (int n = 0; n < most_iterations; ++n) {
    auto next = slab.newton_step(iterates.back());
    if (!next) return std::nullopt;
    change = slab.distance(*next, iterates.back());
    if (!std::isfinite(change)) return std::nullopt;
    iterates.push_back(std::move(*next));
    // Changes that no longer shrink are rounding, if they are small.
    if (change <= 4 * epsilon * size || (change >= before && change <= 1e-8 * size)) break;
    // Errors that still grow by then began too far away.
    if (n >= 10 && change > before) return std::nullopt;
    before = change;
  }
  if (change > 1e-8 * size) return std::nullopt;
  Descent descent;
  descent.floor = std::max(1e3 * epsilon * size, 100 * change);
  for (const auto& iterate : iterates) descent.errors.push_back(slab.distance(iterate, iterates.back()));
  return descent;
}

/// e_{n−1}, e_n, e_{n+1}
struct Triple {
  double before, now, after;
  double order() const { return std::log(after / now) / std::log(now / before); }
};
/// The last whose errors all are more than rounding.
std::optional<Triple> last_triple(const Descent& descent) {
  const auto& e = descent.errors;
  for (std::size_t n = e.size() - 1; n >= 2; --n)
    if (e[n] > descent.floor && e[n] < e[n - 1] && e[n - 1] < e[n - 2]) return Triple{e[n - 2], e[n - 1], e[n]};
  return std::nullopt;
}

/// The results of the descents from starts that are further and less far away.
struct Descents {
  int tried = 0, converged = 0, at_once = 0;
  std::int64_t steps = 0;  ///< of those that converged
  std::vector<Triple> triples;

  /// The one of the middle order. e_{n+1} = C e_n² with a C that changes with the direction of the error: one triple
  /// alone may be far from order two.
  std::optional<Triple> median() const {
    if (triples.empty()) return std::nullopt;
    std::vector<Triple> sorted = triples;
    std::ranges::sort(sorted, {}, &Triple::order);
    return sorted[sorted.size() / 2];
  }
};
Descents descents(SolvedSlab& slab, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  Descents all;
  for (double amplitude = 1; amplitude > nearest && all.triples.size() < 5 && all.at_once < 3; amplitude *= 0.3) {
    ++all.tried;
    const auto descent = descend(slab, perturbed(slab, amplitude, engine));
    if (!descent) continue;
    ++all.converged;
    all.steps += static_cast<std::int64_t>(descent->errors.size()) - 1;
    all.at_once += descent->errors[1] <= descent->floor;
    if (const auto triple = last_triple(*descent)) all.triples.push_back(*triple);
  }
  return all;
}

}  // namespace

std::optional<Check> check_newton(const LatticeSystem& system, const SolvePlan& whole, const Window& solution,
                                  std::uint64_t seed) {
  const SolvePlan plan = with_gauge(system, whole);
  const SlabExtent extent = slab_extent(system, plan);
  if (static_cast<int>(solution.rows.size()) < extent.past() + extent.above + 1) return std::nullopt;
  SolvedSlab slab(system, plan, solution, extent);
  const Descents all = descents(slab, seed);

  Check check{"Newton: quadratic convergence", fmt::format("slab {}, {} unknowns: ", slab.number(), slab.size()), 0,
              0.4};
  check.count = all.steps, check.samples = all.tried;
  if (all.converged == 0) {
    check.value = 2;
    check.region += "does not converge";
    check.failure = fmt::format(
        "the Jacobian is not the derivative of the equations, or it is singular: Newton does not converge, not even "
        "from starts within {} of the solution",
        nearest);
  } else if (const auto triple = all.median()) {
    check.value = std::max(0.0, 2 - triple->order());
    check.region += fmt::format("errors {:.1e}, {:.1e}, {:.1e}: order {:.2f}", triple->before, triple->now,
                                triple->after, triple->order());
    check.failure = fmt::format(
        "the Jacobian is not the derivative of the equations: Newton converges with order {:.1f}", triple->order());
  } else {
    check.region += all.at_once == all.converged ? "converges at once: linear in the slab"
                                                 : "converges too fast to measure an order";
  }
  return check;
}

}  // namespace delf
