// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/SparseLU>

/// Sparse LU of a square matrix, with partial pivoting and columns in COLAMD order: Eigen's, compiled in one file. The
/// others that factor would take ten seconds more each.
namespace delf {
using SparseLU = Eigen::SparseLU<Eigen::SparseMatrix<double>>;

/// False where A is singular. Not lu.compute(A): for a matrix with far fewer entries than columns Eigen 3.4 estimates
/// the memory as 0, and then asks for it again without end.
bool factor(SparseLU& lu, const Eigen::SparseMatrix<double>& A);
/// Factors a matrix with the pattern of the last one: its analysis is kept.
bool factor_again(SparseLU& lu, const Eigen::SparseMatrix<double>& A);
}  // namespace delf

extern template class Eigen::internal::SparseLUImpl<double, int>;
extern template class Eigen::SparseLU<Eigen::SparseMatrix<double>>;
