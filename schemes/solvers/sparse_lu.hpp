// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/SparseLU>

/// Sparse LU of a square matrix, with partial pivoting and columns in COLAMD order: Eigen's, compiled in one file. The
/// others that factor would take ten seconds more each.
namespace delf {
using SparseLU = Eigen::SparseLU<Eigen::SparseMatrix<double>>;
}

extern template class Eigen::internal::SparseLUImpl<double, int>;
extern template class Eigen::SparseLU<Eigen::SparseMatrix<double>>;
