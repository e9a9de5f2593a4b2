// SPDX-License-Identifier: MIT
#include "schemes/complex/first_and_last_step.hpp"

#include <Eigen/Sparse>
#include <algorithm>
#include <array>

#include "lattice/error.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

/// ∂E/∂y at all nodes.
Rows linearised(const ComplexSystem& system, std::span<const double> y) {
  std::vector<Eigen::Triplet<double>> entries;
  system.each_jacobian(system.all_stencils(), y, [&](ComplexSystem::Stencils batch, const double* J) {
    const int size = system.family_of(batch[0]).size();
    for (std::size_t s = 0; s < batch.size(); ++s)
      for (int i = 0; i < size; ++i)
        for (int m = 0; m < size; ++m)
          if (const double value = J[at((i * size + m) * ComplexSystem::most) + s]; value != 0)
            entries.emplace_back(static_cast<int>(system.node(batch[s], i)), static_cast<int>(system.node(batch[s], m)),
                                 value);
  });
  const auto n = static_cast<Eigen::Index>(system.nodes());
  Rows matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

Balance form_of_first_step(const CellSpace& space, std::span<const double> times, std::span<const double> y,
                           std::mt19937_64& random, bool fault) {
  const SpaceRows rows(space, times);
  const Rows E = linearised(rows.system(), y);
  const int d = space.density->components(), n = space.sites() * d, last = rows.rows() - 1;
  std::normal_distribution<double> normal;
  std::array<Vector, 2> variations;
  for (Vector& V : variations) {
    V = Vector::Zero(E.rows());
    for (int i = 0; i < 2 * n; ++i)
      if (!space.fixed[i % n / d]) V[i] = normal(random);
  }
  // Row j + 1 from the equations of row j, whose matrix of row j + 1 has blocks of one site.
  for (int j = 1; j < last; ++j) {
    Matrix above = E.middleRows(j * n, n).middleCols((j + 1) * n, n);
    for (int i = 0; i < n; ++i)
      if (space.fixed[i / d]) {
        above.prune([&](int row, int column, double) { return row != i && column != i; });
        above.coeffRef(i, i) = 1;
      }
    const Eigen::SparseLU<Matrix> solver(above);
    if (solver.info() != Eigen::Success) throw NotFinite("a row does not determine the next one");
    for (Vector& V : variations) {
      Vector right = -(E.middleRows(j * n, n) * V);
      for (int i = 0; i < n; ++i)
        if (space.fixed[i / d]) right[i] = 0;
      V.segment((j + 1) * n, n) = solver.solve(right);
    }
  }
  if (fault) variations[0][last * n + (std::ranges::find(space.fixed, 0) - space.fixed.begin()) * d] += 1e-2;

  // dθ⁺_1 is that of the motion stencils, where V and W are of two rows: the potentials of one row have ∂²V symmetric.
  const SpaceRows step(space, times.first(2));
  const ComplexSystem& system = step.system();
  Balance change;
  for (const int first : {last - 1, 0}) {
    const std::size_t begin = first * n;
    system.each_jacobian(
        step.motion(0), y.subspan(begin, system.nodes()), [&](ComplexSystem::Stencils batch, const double* J) {
          const std::size_t size = system.family_of(batch[0]).size();
          for (std::size_t s = 0; s < batch.size(); ++s) {
            std::vector<double> local(size * size), V(size), W(size);
            for (std::size_t k = 0; k < size * size; ++k) local[k] = J[k * at(ComplexSystem::most) + s];
            for (std::size_t i = 0; i < size; ++i) {
              const auto node = static_cast<Eigen::Index>(begin + system.node(batch[s], static_cast<int>(i)));
              V[i] = variations[0][node], W[i] = variations[1][node];
            }
            Balance here;
            for (std::size_t i = size / 2; i < size; ++i) add_form(here, i, local, V, W);
            change.sum += first == 0 ? -here.sum : here.sum;
            change.absolute += here.absolute, change.count += here.count;
          }
        });
  }
  return change;
}

}  // namespace delf
