// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace delf {

/// A square matrix of fixed structure, solved block by block: the strongly connected components of its graph, each
/// after those that it needs. Small blocks are dense. Large ones are bands where they can be, round a circle too, and
/// sparse where not.
class BlockSolver {
 public:
  /// `places`: (row, column) of each entry. With `matched`, row n is solved for column n, and the blocks are found from
  /// that; without, all is one block. A place that is not `present` is zero whatever its value says.
  BlockSolver(int n, const std::vector<std::pair<int, int>>& places, const std::vector<char>& present, bool matched);
  /// Blocks that are known, one after the other, of as many rows as columns: entries between blocks are zero. Rows and
  /// columns lie at sites, by which large blocks are eliminated.
  struct Sites {
    std::vector<int> of_rows, of_columns;
  };
  BlockSolver(const std::vector<int>& first, const std::vector<std::pair<int, int>>& places, std::vector<char> present,
              const Sites&);
  ~BlockSolver();
  BlockSolver(BlockSolver&&) noexcept;
  BlockSolver& operator=(BlockSolver&&) noexcept;

  /// False if a block is singular. `values` in the order of places.
  bool factor(const std::vector<double>& values);
  /// x = A⁻¹ b. Allocates nothing but where a large block is sparse.
  void solve(const std::vector<double>& b, std::vector<double>& x) const;

  /// The values that were factored last; none before.
  const std::vector<double>& values() const { return values_; }

  int blocks() const { return static_cast<int>(blocks_.size()); }
  int largest_block() const { return largest_; }
  /// Allocated; the sparse factors are counted once there are any.
  std::size_t bytes() const;
  std::string name() const;

  struct Entry {
    int row, column, place;  ///< row and column within the block, or column of the whole
  };
  using Entries = std::span<const Entry>;

 private:
  struct Large;
  struct Block {
    int first = 0, size = 0;                   ///< into members_
    std::size_t inside = 0, inside_end = 0;    ///< into inside_
    std::size_t outside = 0, outside_end = 0;  ///< into outside_
    std::size_t factors = 0;                   ///< into factors_, if it is dense
    int large = -1;                            ///< into large_, if not
  };
  static constexpr int largest_dense = 24;

  void prepare(const std::vector<std::vector<int>>& blocks, const std::vector<std::pair<int, int>>& places,
               const std::vector<char>& present, const Sites*);
  void list_entries(int n, const std::vector<std::pair<int, int>>& places, const std::vector<char>& present);
  bool factor_dense(const Block&, const std::vector<double>& values);
  void solve_dense(const Block&) const;

  std::vector<Block> blocks_;
  std::vector<int> members_, pivots_;
  std::vector<Entry> inside_, outside_;
  std::vector<double> values_, factors_;
  std::vector<std::unique_ptr<Large>> large_;
  int largest_ = 0;
  mutable std::vector<double> part_;
};

}  // namespace delf
