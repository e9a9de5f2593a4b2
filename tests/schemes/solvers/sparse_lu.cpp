// SPDX-License-Identifier: MIT
#include "schemes/solvers/sparse_lu.hpp"

#include <vector>

#include "tests/catch.hpp"

using namespace delf;

namespace {

/// 1 on the diagonal from `first` on, and 0.5 right of it.
Eigen::SparseMatrix<double> bidiagonal(int size, int first) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = first; i < size; ++i) {
    entries.emplace_back(i, i, 1.0);
    if (i + 1 < size) entries.emplace_back(i, i + 1, 0.5);
  }
  Eigen::SparseMatrix<double> A(size, size);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

}  // namespace

// Eigen alone does not return from the matrices of 21 and more columns with next to no entries.
TEST_CASE("a sparse matrix with an empty column is singular, however few entries it has") {
  for (const int size : {1, 20, 21, 30, 1000})
    for (const int entries : {0, 1, size / 2, size - 1}) {
      CAPTURE(size, entries);
      SparseLU lu;
      CHECK(factor(lu, bidiagonal(size, size - entries)) == (entries == size));
    }
}

TEST_CASE("what is factored solves, and a matrix that is singular by its numbers is not factored") {
  SparseLU lu;
  const auto A = bidiagonal(30, 0);
  REQUIRE(factor(lu, A));
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(30, -1, 2), found = lu.solve(Eigen::VectorXd(A * x));
  CHECK((found - x).lpNorm<Eigen::Infinity>() < 1e-14);

  Eigen::SparseMatrix<double> zero = A;
  zero.coeffs() *= 0;
  CHECK_FALSE(factor(lu, zero));
}
