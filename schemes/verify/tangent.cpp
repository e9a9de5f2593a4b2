// SPDX-License-Identifier: MIT
#include "schemes/verify/tangent.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "lattice/error.hpp"
#include "schemes/block_solver.hpp"
#include "schemes/slab_equations.hpp"
#include "schemes/slab_extent.hpp"

namespace delf {

namespace {

NoConvergence singular(std::int64_t row) {
  return NoConvergence("the linearised equations of the slab at row " + std::to_string(row) + " are singular");
}

}  // namespace

struct Tangent::Parity {
  SlabEquations equations;
  BlockSolver solver;
};

Tangent::~Tangent() = default;

int Tangent::least_rows(const LatticeSystem& system, const SolvePlan& plan) {
  const SlabExtent extent = slab_extent(system, plan);
  return std::max({plan.history, extent.below, 1}) + extent.above + extent.equation_lag + 1;
}

Tangent::Tangent(const LatticeSystem& system, const SolvePlan& plan, int rows, double turn)
    : system_(system), rows_(rows) {
  const SlabExtent extent = slab_extent(system, plan);
  data_ = std::max({plan.history, extent.below, 1});
  future_ = extent.above;
  lag_ = extent.equation_lag;
  const std::size_t size = static_cast<std::size_t>(system.lattice().sites() * system.components());
  for (int p = 0; p < plan.table.parities; ++p) {
    SlabEquations equations(system, plan, p, data_, future_, turn);
    std::vector<std::pair<int, int>> places;
    for (const auto& place : equations.places()) places.emplace_back(place.equation, place.unknown);
    BlockSolver solver(equations.size(), places, equations.present(size, data_ + future_ + 1), equations.matched());
    parities_.push_back(std::make_unique<Parity>(Parity{std::move(equations), std::move(solver)}));
  }
}

std::vector<Window> Tangent::evolve(const Window& y, int count, std::mt19937_64& random) {
  const int N = system_.lattice().sites(), C = system_.components();
  const std::size_t size = static_cast<std::size_t>(N * C);
  SectionRing section(rows_, size);
  for (std::size_t r = 0; r < y.rows.size(); ++r)
    std::ranges::copy(y.rows[r], section.row(y.first_row + static_cast<std::int64_t>(r)));

  std::normal_distribution<double> normal;
  std::vector<SectionRing> V(static_cast<std::size_t>(count), SectionRing(rows_, size));
  for (SectionRing& v : V)
    for (int r = 0; r < rows_; ++r)
      for (int i = 0; i < N; ++i)
        for (int c = 0; c < C; ++c)
          v.row(y.first_row + r)[i * C + c] = system_.is_held(i, c) ? 0.0 : normal(random);

  std::vector<std::vector<double>> E;
  std::vector<double> values, change;
  for (std::int64_t J = y.first_row + data_; J <= y.last_row() - future_; ++J) {
    Parity& p = *parities_[static_cast<std::size_t>(J) % parities_.size()];
    for (SectionRing& v : V)
      for (int n = 0; n < p.equations.size(); ++n) p.equations.value(v, J, n) = 0;
    // A V_unknown = −Σ_known ∂E/∂y_a V_a; once more for what rounding left
    for (int pass = 0; pass < 2; ++pass) {
      p.equations.linearised(section, J, V, E, values);
      if (pass == 0 && !p.solver.factor(values)) throw singular(J);
      for (std::size_t v = 0; v < V.size(); ++v) {
        p.solver.solve(E[v], change);
        double changed = 0, size = 0;
        for (int n = 0; n < p.equations.size(); ++n) {
          double& value = p.equations.value(V[v], J, n);
          value -= change[static_cast<std::size_t>(n)];
          changed = std::max(changed, std::abs(change[static_cast<std::size_t>(n)]));
          size = std::max(size, std::abs(value));
        }
        // What the first pass left is rounding, unless the matrix is singular but for rounding.
        if (pass == 1 && !(changed <= 1e-6 * size)) throw singular(J);
      }
    }
  }
  std::vector<Window> windows;
  for (SectionRing& v : V) {
    std::vector<std::vector<double>> rows;
    for (int r = 0; r < rows_; ++r)
      rows.emplace_back(v.row(y.first_row + r), v.row(y.first_row + r) + size);
    windows.push_back(system_.window(y.first_row, std::move(rows), 0));
  }
  return windows;
}

}  // namespace delf
