// SPDX-License-Identifier: MIT
#include "schemes/solvers/sparse_lu.hpp"

template class Eigen::internal::SparseLUImpl<double, int>;
template class Eigen::SparseLU<Eigen::SparseMatrix<double>>;
