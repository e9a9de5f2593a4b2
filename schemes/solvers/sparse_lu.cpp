// SPDX-License-Identifier: MIT
#include "schemes/solvers/sparse_lu.hpp"

template class Eigen::internal::SparseLUImpl<double, int>;
template class Eigen::SparseLU<Eigen::SparseMatrix<double>>;

namespace delf {

bool factor(SparseLU& lu, const Eigen::SparseMatrix<double>& A) {
  for (Eigen::Index column = 0; column < A.outerSize(); ++column)
    if (!Eigen::SparseMatrix<double>::InnerIterator(A, column)) return false;
  lu.compute(A);
  return lu.info() == Eigen::Success;
}
bool factor_again(SparseLU& lu, const Eigen::SparseMatrix<double>& A) {
  lu.factorize(A);
  return lu.info() == Eigen::Success;
}

}  // namespace delf
