// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace delf {

/// A square matrix of fixed structure, solved block by block: the strongly connected components of its graph, each after
/// those that it needs. Small blocks are dense, large ones sparse.
class BlockSolver {
 public:
  /// `places`: (row, column) of each entry. With `matched`, row n is solved for column n, and the blocks are found from
  /// that; without, all is one block. A place that is not `present` is zero whatever its value says.
  BlockSolver(int n, const std::vector<std::pair<int, int>>& places, const std::vector<char>& present, bool matched);

  /// False if a block is singular. `values` in the order of places.
  bool factor(const std::vector<double>& values);
  /// x = A⁻¹ b
  void solve(const std::vector<double>& b, std::vector<double>& x) const;

  int blocks() const { return static_cast<int>(blocks_.size()); }
  int largest_block() const { return largest_; }
  /// Allocated; the sparse factors are counted once there are any.
  std::size_t bytes() const;
  std::string name() const;

 private:
  struct Entry {
    int row, column, place;  ///< row and column within the block, or column of the whole
  };
  struct Block {
    std::vector<int> members;
    std::vector<Entry> inside, outside;
    Eigen::PartialPivLU<Eigen::MatrixXd> dense;
    std::unique_ptr<Eigen::SparseLU<Eigen::SparseMatrix<double>>> sparse;
    Eigen::SparseMatrix<double> matrix;
    std::vector<int> where;  ///< of the inside entries, in matrix.valuePtr()
  };
  static constexpr int largest_dense = 24;

  std::vector<Block> blocks_;
  std::vector<double> values_;
  int largest_ = 0;
  bool factored_ = false;
  mutable Eigen::VectorXd part_;
};

}  // namespace delf
