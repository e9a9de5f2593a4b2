// SPDX-License-Identifier: MIT
#include "schemes/stability/mesh_frequency.hpp"

#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <cmath>
#include <map>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/system/assembly.hpp"

namespace delf {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// The largest eigenvalue of a symmetric matrix; 0 if it is not finite, or Lanczos's method does not converge.
double largest_eigenvalue(const Matrix& K) {
  // Squares of what is near the ends of the range overflow.
  const double size = K.nonZeros() == 0 ? 0 : K.coeffs().abs().maxCoeff();
  if (!(size > 0) || !std::isfinite(size)) return 0;
  if (size > 1e100 || size < 1e-100) return size * largest_eigenvalue(K / size);
  constexpr int few = 32, basis = 24, most_iterations = 1000;
  if (K.rows() <= few)
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(K), Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
  Spectra::SparseSymMatProd<double> product(K);
  Spectra::SymEigsSolver<Spectra::SparseSymMatProd<double>> lanczos(product, 1, basis);
  lanczos.init();
  lanczos.compute(Spectra::SortRule::LargestAlge, most_iterations, 1e-8);
  return lanczos.info() == Spectra::CompInfo::Successful ? lanczos.eigenvalues()[0] : 0;
}

/// ∂E/∂y of the fields at rest: of the equations of one row by the values of the row so many rows above, with such a step.
std::vector<MatrixEntry> derivatives(const LatticeSystem& system, int above, double time_step) {
  const int N = system.lattice().sites(), C = system.components();
  std::vector<Node> equations, unknowns;
  for (int i = 0; i < N; ++i)
    for (int c = 0; c < C; ++c) {
      if (system.component(c).role != Role::field || system.is_held(i, c)) continue;
      equations.push_back({{0, i}, c}), unknowns.push_back({{above, i}, c});
    }
  Assembly assembly(system,
                    {.equations = std::move(equations), .unknowns = std::move(unknowns), .past = 1, .future = 1});
  assembly.set_time_step(time_step);
  std::vector<double> values;
  assembly.jacobian(SectionRing(3, at(N * C)), 1, values);
  std::vector<MatrixEntry> entries;
  for (std::size_t n = 0; n < assembly.places().size(); ++n)
    entries.push_back({assembly.places()[n].equation, assembly.places()[n].unknown, values[n]});
  return entries;
}

}  // namespace

std::optional<double> longest_step(const LatticeSystem& system) {
  // E = −(M/h) (y₊ − 2y + y₋) − h K y: of a long step ∂E/∂y is −h K, and ∂E/∂y₊ is −M/h of any.
  constexpr double long_step = 0x1p60;
  std::map<int, double> mass;
  for (const MatrixEntry& e : derivatives(system, 1, 1))
    if (e.row == e.column) mass[e.row] = -e.value;
  std::vector<Eigen::Triplet<double>> scaled;
  for (const MatrixEntry& e : derivatives(system, 0, long_step))
    if (const double masses = mass[e.row] * mass[e.column]; masses > 0)
      scaled.emplace_back(e.row, e.column, -e.value / long_step / std::sqrt(masses));
  const auto n = static_cast<int>(mass.size());
  Matrix K(n, n);
  K.setFromTriplets(scaled.begin(), scaled.end());
  const double eigenvalue = largest_eigenvalue(K);
  return eigenvalue > 0 ? std::optional(2 / std::sqrt(eigenvalue)) : std::nullopt;
}

}  // namespace delf
