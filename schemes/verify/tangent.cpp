// SPDX-License-Identifier: MIT
#include "schemes/verify/tangent.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/slab_solver.hpp"
#include "schemes/system/slab_extent.hpp"

namespace delf {

namespace {

NoConvergence singular(std::int64_t row) {
  return NoConvergence("the linearised equations of the slab at row " + std::to_string(row) + " are singular");
}

/// b − A x, and Σ|terms| of each equation.
std::vector<double> remainder(const Assembly& equations, const std::vector<double>& A, const std::vector<double>& b,
                              const std::vector<double>& x, std::vector<double>& absolute) {
  std::vector<double> left = b;
  absolute.assign(b.size(), 0.0);
  for (std::size_t n = 0; n < b.size(); ++n) absolute[n] = std::abs(b[n]);
  for (std::size_t n = 0; n < A.size(); ++n) {
    const auto [equation, unknown] = equations.places()[n];
    const double term = A[n] * x[unknown];
    left[equation] -= term;
    absolute[equation] += std::abs(term);
  }
  return left;
}

}  // namespace

struct Tangent::Parity {
  Assembly equations;
  BlockSolver solver;

  /// Σ|A x| over |b| for a random b is of the order of the condition number, and of 1/ε where A is singular but for
  /// rounding, which the equations' own right sides need not show.
  bool is_singular(const std::vector<double>& A) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::vector<double> b(A.empty() ? 0 : equations.size()), x, terms;
    if (b.empty()) return false;
    for (double& value : b) value = normal(random);
    solver.solve(b, x);
    remainder(equations, A, b, x, terms);
    constexpr double most = 1e12;
    return !(std::ranges::max(terms) <= most);
  }
};

Tangent::~Tangent() = default;

int Tangent::least_rows(const LatticeSystem& system, const SolvePlan& plan) {
  const Range one = solved_rows(system, plan, 0);
  return one.first - one.last + 1;
}

Range Tangent::solved_rows(const LatticeSystem& system, const SolvePlan& plan, int rows) {
  // Slabs past … rows − 1 − above are solved, and an equation at row j is in one of slabs j − lead … j + delay.
  const SlabExtent extent = slab_extent(system, plan);
  return {extent.past() + extent.equation_lead, rows - 1 - extent.above - extent.equation_lag};
}

Tangent::Tangent(const LatticeSystem& system, const SolvePlan& plan, int rows, double monodromy)
    : system_(system), rows_(rows) {
  const SlabExtent extent = slab_extent(system, plan);
  data_ = extent.past();
  above_ = extent.above;
  for (int p = 0; p < plan.table.parities; ++p) {
    Assembly equations(system, Assembly::slab(plan, p, data_, above_, monodromy));
    BlockSolver solver = solver_of(equations);
    parities_.push_back(std::make_unique<Parity>(Parity{std::move(equations), std::move(solver)}));
  }
}

std::vector<Window> Tangent::evolve(const Window& y, int count, std::mt19937_64& random) {
  const int N = system_.lattice().sites(), C = system_.components();
  const std::size_t size = at(N * C);
  SectionRing section(rows_, size);
  for (std::size_t r = 0; r < y.rows.size(); ++r)
    std::ranges::copy(y.rows[r], section.row(y.first_row + static_cast<std::int64_t>(r)));

  std::normal_distribution<double> normal;
  std::vector<SectionRing> V(count, SectionRing(rows_, size));
  for (SectionRing& v : V)
    for (int r = 0; r < rows_; ++r)
      for (int i = 0; i < N; ++i)
        for (int c = 0; c < C; ++c) v.row(y.first_row + r)[i * C + c] = system_.is_held(i, c) ? 0.0 : normal(random);

  std::vector<Assembly::Variation> left_side;
  for (const SectionRing& v : V) left_side.push_back({v});
  std::vector<double> values, x, more, size_of_terms;
  for (std::int64_t J = y.first_row + data_; J <= y.last_row() - above_; ++J) {
    Parity& p = *parities_[at(J) % parities_.size()];
    for (SectionRing& v : V)
      for (int n = 0; n < p.equations.size(); ++n) p.equations.value(v, J, n) = 0;
    p.equations.linearised(section, J, left_side, values);
    if (!p.solver.factor(values) || p.is_singular(values)) throw singular(J);
    for (std::size_t v = 0; v < V.size(); ++v) {
      const std::vector<double>& E = left_side[v].E;
      // A x = Σ_known ∂E/∂y_a V_a, V_unknown = −x; once more for what rounding left
      p.solver.solve(E, x);
      p.solver.solve(remainder(p.equations, values, E, x, size_of_terms), more);
      for (std::size_t n = 0; n < x.size(); ++n) x[n] += more[n];
      // A matrix is singular but for rounding where something of an equation is left even so, or terms grow beyond what
      // they make up: over all stencils and theories up to 6e7 times where it is not, from 2e10 on where it is.
      const std::vector<double> left = remainder(p.equations, values, E, x, size_of_terms);
      constexpr double most_growth = 1e9;
      const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
      if (!x.empty() && std::ranges::max(size_of_terms) > most_growth * std::abs(std::ranges::max(E, smaller)))
        throw singular(J);
      for (std::size_t n = 0; n < left.size(); ++n)
        if (!(std::abs(left[n]) <= 1e-10 * size_of_terms[n])) throw singular(J);
      for (int n = 0; n < p.equations.size(); ++n) p.equations.value(V[v], J, n) = -x[n];
    }
  }
  std::vector<Window> windows;
  for (SectionRing& v : V) {
    std::vector<std::vector<double>> rows;
    for (int r = 0; r < rows_; ++r) rows.emplace_back(v.row(y.first_row + r), v.row(y.first_row + r) + size);
    windows.push_back(system_.window(y.first_row, std::move(rows), 0));
  }
  return windows;
}

}  // namespace delf
