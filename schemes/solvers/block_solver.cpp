// SPDX-License-Identifier: MIT
#include "schemes/solvers/block_solver.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "lattice/index.hpp"
#include "lattice/plan/block_order.hpp"
#include "schemes/solvers/band_lu.hpp"
#include "schemes/solvers/sitewise_lu.hpp"
#include "schemes/solvers/sparse_lu.hpp"

namespace delf {
namespace {

/// The place of each unknown in an order in which coupled ones are near each other: Cuthill and McKee's, breadth first
/// from a node at one end. Round a circle it is folded flat. Boost.Graph's ordering takes 5 to 10 times as long, and its bands of two
/// components round a circle are a fifth wider.
std::vector<int> banded_places(int n, BlockSolver::Entries entries) {
  std::vector<std::vector<int>> neighbours(n);
  for (const auto& e : entries)
    if (e.row != e.column) neighbours[e.row].push_back(e.column), neighbours[e.column].push_back(e.row);
  for (auto& list : neighbours) {
    std::ranges::sort(list);
    list.erase(std::ranges::unique(list).begin(), list.end());
  }
  std::vector<int> order;
  const auto from = [&](int start) {
    std::vector<char> seen(n, false);
    order.clear();
    for (int next = -1; next < n; ++next) {
      const int root = next < 0 ? start : next;
      if (seen[root]) continue;
      seen[root] = true, order.push_back(root);
      for (std::size_t i = order.size() - 1; i < order.size(); ++i)
        for (const int m : neighbours[order[i]])
          if (!seen[m]) seen[m] = true, order.push_back(m);
    }
  };
  // The node last found from the node last found lies at an end.
  for (int start = 0, sweep = 0; sweep < 3; ++sweep, start = order.back()) from(start);
  std::vector<int> places(n);
  for (int i = 0; i < n; ++i) places[order[i]] = i;
  return places;
}

/// The numbers of the entries by their row or column, equal ones as they are in `before`; nothing: as they are listed.
std::vector<int> in_order(int BlockSolver::Entry::*key, int size, BlockSolver::Entries entries,
                          const std::vector<int>& before) {
  std::vector<int> first(at(size) + 1, 0), order(entries.size());
  for (const auto& e : entries) ++first[at(e.*key) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  for (std::size_t n = 0; n < entries.size(); ++n) {
    const int entry = before.empty() ? static_cast<int>(n) : before[n];
    order[at(first[at(entries[at(entry)].*key)]++)] = entry;
  }
  return order;
}

}  // namespace

/// A block that is too large to be dense: a band, or sparse where the band is too wide or unknowns have sites.
struct BlockSolver::Large {
  int size;
  std::vector<int> places;  ///< of the unknowns in the band
  std::optional<BandLU> band;
  Eigen::SparseMatrix<double> matrix;
  std::vector<int> where;  ///< of the entries, in the numbers of the band or of the matrix
  std::unique_ptr<SparseLU> sparse;
  std::optional<SitewiseLU> sitewise;
  mutable Eigen::VectorXd x;

  Large(int n, Entries entries) : size(n), places(banded_places(n, entries)) {
    int lower = 0, upper = 0;
    for (const Entry& e : entries) {
      const int offset = places[e.column] - places[e.row];
      lower = std::max(lower, -offset), upper = std::max(upper, offset);
    }
    if (2 * lower + upper > std::max(size / 2, 2 * largest_dense)) return;
    band.emplace(size, lower, upper);
    for (const Entry& e : entries) where.push_back(band->place(places[e.row], places[e.column]));
  }

  Large(SitewiseLU solver, int n, Entries entries) : size(n), sitewise(std::move(solver)) { prepare(entries); }

  bool factor(const std::vector<double>& values, Entries entries) {
    if (!band && !sparse && !sitewise) prepare(entries);
    if (band) band->set_zero();
    double* const numbers = band ? band->numbers() : matrix.valuePtr();
    for (std::size_t e = 0; e < entries.size(); ++e) numbers[where[e]] = values[entries[e].place];
    if (band) return band->factor();
    if (sitewise) return sitewise->factorize(matrix);
    sparse->factorize(matrix);
    return sparse->info() == Eigen::Success;
  }

  void prepare(Entries entries) {
    const std::vector<int> by_column =
        in_order(&Entry::column, size, entries, in_order(&Entry::row, size, entries, {}));
    matrix.resize(size, size);
    matrix.resizeNonZeros(std::ssize(entries));
    std::fill_n(matrix.outerIndexPtr(), size + 1, 0);
    where.resize(entries.size());
    for (std::size_t n = 0; n < by_column.size(); ++n) {
      const Entry& e = entries[by_column[n]];
      matrix.innerIndexPtr()[n] = e.row;
      ++matrix.outerIndexPtr()[e.column + 1];
      where[by_column[n]] = static_cast<int>(n);
    }
    std::partial_sum(matrix.outerIndexPtr(), matrix.outerIndexPtr() + size + 1, matrix.outerIndexPtr());
    if (sitewise) return;
    sparse = std::make_unique<SparseLU>();
    sparse->analyzePattern(matrix);
  }

  /// `part`: b, then x behind it.
  void solve(double* part) const {
    double* const result = part + size;
    if (!band) {
      const Eigen::Map<const Eigen::VectorXd> b(part, size);
      if (sitewise) x = sitewise->solve(b);
      else x = sparse->solve(b);
      std::copy_n(x.data(), size, result);
      return;
    }
    for (int i = 0; i < size; ++i) result[places[i]] = part[i];
    band->solve(result);
    std::copy_n(result, size, part);
    for (int i = 0; i < size; ++i) result[i] = part[places[i]];
  }

  std::size_t bytes() const {
    std::size_t total = (band ? band->bytes() : 0) + (places.size() + where.size()) * sizeof(int);
    if (sitewise) total += at(matrix.nonZeros()) * (sizeof(double) + sizeof(int));
    if (sparse) total += at(matrix.nonZeros() + sparse->nnzL() + sparse->nnzU()) * (sizeof(double) + sizeof(int));
    return total;
  }
};

BlockSolver::~BlockSolver() = default;
BlockSolver::BlockSolver(BlockSolver&&) noexcept = default;
BlockSolver& BlockSolver::operator=(BlockSolver&&) noexcept = default;

BlockSolver::BlockSolver(int n, const std::vector<std::pair<int, int>>& places, const std::vector<char>& present,
                         bool matched) {
  std::vector<std::vector<int>> members;
  if (matched) {
    std::vector<std::pair<int, int>> edges;
    for (std::size_t p = 0; p < places.size(); ++p)
      if (present[p]) edges.push_back(places[p]);
    members = blocks_in_order(n, edges);
  } else {
    members.emplace_back(at(n));
    std::iota(members[0].begin(), members[0].end(), 0);
  }
  prepare(members, places, present, nullptr);
}

BlockSolver::BlockSolver(const std::vector<int>& first, const std::vector<std::pair<int, int>>& places,
                         std::vector<char> present, const Sites& sites) {
  std::vector<std::vector<int>> members;
  std::vector<int> block;
  for (std::size_t b = 0; b + 1 < first.size(); ++b) {
    members.emplace_back(at(first[b + 1] - first[b]));
    std::iota(members[b].begin(), members[b].end(), first[b]);
    block.insert(block.end(), members[b].size(), static_cast<int>(b));
  }
  for (std::size_t p = 0; p < places.size(); ++p)
    if (block[places[p].first] != block[places[p].second]) present[p] = false;
  prepare(members, places, present, &sites);
}

void BlockSolver::prepare(const std::vector<std::vector<int>>& members, const std::vector<std::pair<int, int>>& places,
                          const std::vector<char>& present, const Sites* sites) {
  for (const auto& block : members) {
    const int size = static_cast<int>(block.size());
    blocks_.push_back({.first = static_cast<int>(members_.size()), .size = size});
    largest_ = std::max(largest_, size);
    members_.insert(members_.end(), block.begin(), block.end());
  }
  list_entries(static_cast<int>(members_.size()), places, present);
  pivots_.resize(members_.size());
  part_.resize(2 * largest_);
  std::size_t factors = 0;
  for (Block& b : blocks_) {
    b.factors = factors;
    if (b.size <= largest_dense) {
      factors += at(b.size * b.size);
      continue;
    }
    b.large = static_cast<int>(large_.size());
    const Entries entries = Entries(inside_).subspan(b.inside, b.inside_end - b.inside);
    if (!sites) {
      large_.push_back(std::make_unique<Large>(b.size, entries));
      continue;
    }
    std::vector<int> of_rows, of_columns;
    for (int i = b.first; i < b.first + b.size; ++i) {
      of_rows.push_back(sites->of_rows[members_[i]]);
      of_columns.push_back(sites->of_columns[members_[i]]);
    }
    large_.push_back(std::make_unique<Large>(SitewiseLU(std::move(of_rows), std::move(of_columns)), b.size, entries));
  }
  factors_.resize(factors);
}

/// Entries block by block, those within and those that couple a block to what was solved before it.
void BlockSolver::list_entries(int n, const std::vector<std::pair<int, int>>& places,
                               const std::vector<char>& present) {
  std::vector<int> block(n), position(at(n));
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int i = 0; i < blocks_[b].size; ++i) {
      const int member = members_[blocks_[b].first + i];
      block[member] = static_cast<int>(b);
      position[member] = i;
    }
  const auto for_each = [&](const auto& visit) {
    for (std::size_t p = 0; p < places.size(); ++p) {
      if (!present[p]) continue;
      const auto [row, column] = places[p];
      visit(blocks_[block[row]], block[row] == block[column], static_cast<int>(p), row, column);
    }
  };
  for_each([](Block& b, bool inside, int, int, int) { ++(inside ? b.inside_end : b.outside_end); });
  std::size_t inside = 0, outside = 0;
  for (Block& b : blocks_) {
    b.inside = inside, b.outside = outside;
    inside += b.inside_end, outside += b.outside_end;
    b.inside_end = b.inside, b.outside_end = b.outside;
  }
  inside_.resize(inside), outside_.resize(outside);
  for_each([&](Block& b, bool is_inside, int p, int row, int column) {
    if (is_inside) inside_[b.inside_end++] = {position[row], position[column], p};
    else outside_[b.outside_end++] = {position[row], column, p};
  });
}

bool BlockSolver::factor(const std::vector<double>& values) {
  values_ = values;
  for (const Block& b : blocks_) {
    const Entries entries = Entries(inside_).subspan(b.inside, b.inside_end - b.inside);
    if (!(b.large >= 0 ? large_[b.large]->factor(values, entries) : factor_dense(b, values))) return false;
  }
  return true;
}

/// L and U in place, row by row, rows exchanged for the largest pivot; 1/U_pp on the diagonal.
bool BlockSolver::factor_dense(const Block& block, const std::vector<double>& values) {
  const int n = block.size;
  double* const a = factors_.data() + block.factors;
  std::fill_n(a, n * n, 0.0);
  for (std::size_t e = block.inside; e < block.inside_end; ++e)
    a[inside_[e].row * n + inside_[e].column] = values[inside_[e].place];
  for (int p = 0; p < n; ++p) {
    int best = p;
    for (int i = p + 1; i < n; ++i)
      if (std::abs(a[i * n + p]) > std::abs(a[best * n + p])) best = i;
    pivots_[block.first + p] = best;
    if (best != p) std::swap_ranges(a + p * n, a + (p + 1) * n, a + best * n);
    const double pivot = a[p * n + p];
    if (pivot == 0 || !std::isfinite(pivot)) return false;
    a[p * n + p] = 1 / pivot;
    for (int i = p + 1; i < n; ++i) {
      const double by = a[i * n + p] *= a[p * n + p];
      if (by == 0) continue;
      for (int c = p + 1; c < n; ++c) a[i * n + c] -= by * a[p * n + c];
    }
  }
  return true;
}

void BlockSolver::solve_dense(const Block& block) const {
  const int n = block.size;
  const double* const a = factors_.data() + block.factors;
  double* const x = part_.data();
  for (int p = 0; p < n; ++p) std::swap(x[p], x[pivots_[block.first + p]]);
  for (int i = 1; i < n; ++i)
    for (int c = 0; c < i; ++c) x[i] -= a[i * n + c] * x[c];
  for (int i = n - 1; i >= 0; --i) {
    for (int c = i + 1; c < n; ++c) x[i] -= a[i * n + c] * x[c];
    x[i] *= a[i * n + i];
  }
}

void BlockSolver::solve(const std::vector<double>& rhs, std::vector<double>& x) const {
  x.resize(members_.size());
  for (const Block& b : blocks_) {
    const int* const member = members_.data() + b.first;
    for (int i = 0; i < b.size; ++i) part_[i] = rhs[member[i]];
    for (std::size_t e = b.outside; e < b.outside_end; ++e)
      part_[outside_[e].row] -= values_[outside_[e].place] * x[outside_[e].column];
    const double* result = part_.data();
    if (b.large >= 0) large_[b.large]->solve(part_.data()), result += b.size;
    else solve_dense(b);
    for (int i = 0; i < b.size; ++i) x[member[i]] = result[i];
  }
}

std::size_t BlockSolver::bytes() const {
  std::size_t total = (values_.size() + factors_.size() + part_.size()) * sizeof(double) +
                      (members_.size() + pivots_.size()) * sizeof(int) +
                      (inside_.size() + outside_.size()) * sizeof(Entry) + blocks_.size() * sizeof(Block);
  for (const auto& large : large_) total += large->bytes();
  return total;
}

std::string BlockSolver::name() const {
  const bool sparse = std::ranges::any_of(large_, [](const auto& large) { return !large->band; });
  const std::string kind = largest_ <= largest_dense ? "dense" : sparse ? "sparse" : "band";
  const std::string size = std::to_string(largest_);
  if (blocks() == 1) return kind + " LU of " + size + " unknowns";
  return std::to_string(blocks()) + " blocks in turn, " +
         (largest_ == 1 ? "a division each" : kind + " LU of at most " + size + " unknowns each");
}

}  // namespace delf
