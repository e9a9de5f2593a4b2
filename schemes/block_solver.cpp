// SPDX-License-Identifier: MIT
#include "schemes/block_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lattice/block_order.hpp"

namespace delf {

BlockSolver::BlockSolver(int n, const std::vector<std::pair<int, int>>& places, const std::vector<char>& present,
                         bool matched) {
  std::vector<std::vector<int>> members;
  if (matched) {
    std::vector<std::pair<int, int>> edges;
    for (std::size_t p = 0; p < places.size(); ++p)
      if (present[p]) edges.push_back(places[p]);
    members = blocks_in_order(n, edges);
  } else {
    members.emplace_back(static_cast<std::size_t>(n));
    std::iota(members[0].begin(), members[0].end(), 0);
  }
  std::vector<int> block(static_cast<std::size_t>(n)), position(block.size());
  for (std::size_t b = 0; b < members.size(); ++b)
    for (std::size_t i = 0; i < members[b].size(); ++i) {
      block[static_cast<std::size_t>(members[b][i])] = static_cast<int>(b);
      position[static_cast<std::size_t>(members[b][i])] = static_cast<int>(i);
    }
  blocks_.resize(members.size());
  for (std::size_t b = 0; b < members.size(); ++b) {
    largest_ = std::max(largest_, static_cast<int>(members[b].size()));
    blocks_[b].members = std::move(members[b]);
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (!present[p]) continue;
    const auto [row, column] = places[p];
    const auto r = static_cast<std::size_t>(row), c = static_cast<std::size_t>(column);
    Block& home = blocks_[static_cast<std::size_t>(block[r])];
    const bool inside = block[r] == block[c];
    (inside ? home.inside : home.outside)
        .push_back({position[r], inside ? position[c] : column, static_cast<int>(p)});
  }
  for (Block& b : blocks_) {
    const auto size = static_cast<Eigen::Index>(b.members.size());
    if (size <= largest_dense) {
      b.dense = Eigen::PartialPivLU<Eigen::MatrixXd>(size);
      continue;
    }
    std::vector<Eigen::Triplet<double>> triplets;
    for (const Entry& e : b.inside) triplets.emplace_back(e.row, e.column, 1.0);
    b.matrix.resize(size, size);
    b.matrix.setFromTriplets(triplets.begin(), triplets.end());
    b.matrix.makeCompressed();
    for (const Entry& e : b.inside) {
      const int* first = b.matrix.innerIndexPtr() + b.matrix.outerIndexPtr()[e.column];
      const int* last = b.matrix.innerIndexPtr() + b.matrix.outerIndexPtr()[e.column + 1];
      b.where.push_back(static_cast<int>(std::lower_bound(first, last, e.row) - b.matrix.innerIndexPtr()));
    }
    b.sparse = std::make_unique<Eigen::SparseLU<Eigen::SparseMatrix<double>>>();
    b.sparse->analyzePattern(b.matrix);
  }
}

bool BlockSolver::factor(const std::vector<double>& values) {
  values_ = values;
  factored_ = true;
  Eigen::MatrixXd matrix;
  for (Block& b : blocks_) {
    const auto size = static_cast<Eigen::Index>(b.members.size());
    if (b.sparse) {
      for (std::size_t e = 0; e < b.inside.size(); ++e)
        b.matrix.valuePtr()[b.where[e]] = values[static_cast<std::size_t>(b.inside[e].place)];
      b.sparse->factorize(b.matrix);
      if (b.sparse->info() != Eigen::Success) return false;
      continue;
    }
    matrix.setZero(size, size);
    for (const Entry& e : b.inside) matrix(e.row, e.column) = values[static_cast<std::size_t>(e.place)];
    b.dense.compute(matrix);
    for (Eigen::Index i = 0; i < size; ++i) {
      const double pivot = b.dense.matrixLU()(i, i);
      if (pivot == 0 || !std::isfinite(pivot)) return false;
    }
  }
  return true;
}

void BlockSolver::solve(const std::vector<double>& rhs, std::vector<double>& x) const {
  x.resize(rhs.size());
  for (const Block& b : blocks_) {
    const auto size = static_cast<Eigen::Index>(b.members.size());
    part_.resize(size);
    for (Eigen::Index i = 0; i < size; ++i)
      part_[i] = rhs[static_cast<std::size_t>(b.members[static_cast<std::size_t>(i)])];
    for (const Entry& e : b.outside)
      part_[e.row] -= values_[static_cast<std::size_t>(e.place)] * x[static_cast<std::size_t>(e.column)];
    if (b.sparse) part_ = b.sparse->solve(part_).eval();
    else part_ = b.dense.solve(part_).eval();
    for (Eigen::Index i = 0; i < size; ++i)
      x[static_cast<std::size_t>(b.members[static_cast<std::size_t>(i)])] = part_[i];
  }
}

std::size_t BlockSolver::bytes() const {
  std::size_t total = values_.size() * sizeof(double);
  for (const Block& b : blocks_) {
    const std::size_t size = b.members.size();
    total += size * sizeof(int) + (b.inside.size() + b.outside.size()) * sizeof(Entry);
    if (b.sparse)
      total += static_cast<std::size_t>(b.matrix.nonZeros() + (factored_ ? b.sparse->nnzL() + b.sparse->nnzU() : 0)) *
               (sizeof(double) + sizeof(int));
    else
      total += size * size * sizeof(double);
  }
  return total;
}

std::string BlockSolver::name() const {
  const std::string size = std::to_string(largest_);
  if (blocks() == 1) return (largest_ <= largest_dense ? "dense LU of " : "sparse LU of ") + size + " unknowns";
  return std::to_string(blocks()) + " blocks in turn, " +
         (largest_ == 1 ? "a division each"
                        : (largest_ <= largest_dense ? "dense LU of at most " : "sparse LU of at most ") + size +
                              " unknowns each");
}

}  // namespace delf
