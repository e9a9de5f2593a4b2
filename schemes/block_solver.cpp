// SPDX-License-Identifier: MIT
#include "schemes/block_solver.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <span>

#include "jets/pack.hpp"
#include "lattice/block_order.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
using Entries = std::span<const BlockSolver::Entry>;

/// Rows and columns in groups round a circle, as many of each in every group, such that an entry lies in one group or
/// between neighbours.
struct Groups {
  std::vector<int> of_row, of_column;
  std::vector<int> sizes;

  int count() const { return static_cast<int>(sizes.size()); }
  int reach(Entries entries) const {
    int most = 0;
    for (const auto& e : entries) {
      const int apart = std::abs(of_row[at(e.row)] - of_column[at(e.column)]);
      most = std::max(most, std::min(apart, count() - apart));
    }
    return most;
  }
  /// As many neighbours in one group as it takes.
  void merge(int together) {
    const int groups = count() / together;
    std::vector<int> merged(at(groups), 0);
    for (int g = 0; g < count(); ++g) merged[at(std::min(g / together, groups - 1))] += sizes[at(g)];
    for (auto* of : {&of_row, &of_column})
      for (int& g : *of) g = std::min(g / together, groups - 1);
    sizes = std::move(merged);
  }
};

std::optional<Groups> grouped(const std::vector<int>& row_sites, const std::vector<int>& column_sites,
                              Entries entries) {
  Groups groups;
  std::map<int, int> number;
  for (const int site : column_sites) number[site] = 0;
  int next = 0;
  for (auto& [site, n] : number) n = next++;
  groups.sizes.assign(number.size(), 0);
  std::vector<int> rows(number.size(), 0);
  for (const int site : column_sites) ++groups.sizes[at(groups.of_column.emplace_back(number[site]))];
  for (const int site : row_sites) {
    const auto found = number.find(site);
    if (found == number.end()) return std::nullopt;
    ++rows[at(groups.of_row.emplace_back(found->second))];
  }
  if (rows != groups.sizes) return std::nullopt;
  const int reach = groups.reach(entries);
  if (reach > 3 || groups.count() < 4 * std::max(reach, 1)) return std::nullopt;
  if (reach > 1) groups.merge(reach);
  return groups;
}

/// A matrix of groups that are coupled with their neighbours alone, round a circle. It is cut into as many arcs as
/// there are lanes by separators of a group or more; lane l eliminates arc l from its left end to its right one,
///
///     D_t ← D_t − L_t W_{t−1},    W_t = D_t⁻¹ U_t,    z_t = D_t⁻¹ (r_t − L_t z_{t−1}),    x_t = z_t − W_t x_{t+1},
///
/// and what is left is a dense matrix for the separators s, to which arcs are coupled at their ends:
///
///     x = A⁻¹ r − P s_left − Q s_right.
///
/// Rows are exchanged within groups only, alike in all lanes: a factorisation is looked at before it is trusted.
class Arcs {
 public:
  static std::unique_ptr<Arcs> make(const Groups& groups, Entries entries) {
    auto arcs = std::make_unique<Arcs>();
    return arcs->place(groups, entries) ? std::move(arcs) : nullptr;
  }

  bool factor(const std::vector<double>& values, Entries entries) {
    std::ranges::fill(pool_, Pack(0.0));
    std::ranges::fill(couplings_, 0.0);
    double* const pool = reinterpret_cast<double*>(pool_.data());
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const double value = values[at(entries[e].place)];
      (where_[e] >= 0 ? pool[where_[e]] : couplings_[static_cast<std::size_t>(-1 - where_[e])]) = value;
    }
    return eliminate() && join() && is_accurate(values, entries);
  }

  void solve(const double* rhs, double* x) const {
    if (b_ == 2) solve_groups_of<2>(rhs, x);
    else if (b_ == 3) solve_groups_of<3>(rhs, x);
    else if (b_ == 4) solve_groups_of<4>(rhs, x);
    else solve_groups_of<0>(rhs, x);
  }

  std::size_t bytes() const {
    return (pool_.size() + z_.size()) * sizeof(Pack) +
           (couplings_.size() + static_cast<std::size_t>(inverse_.size())) * sizeof(double) +
           (where_.size() + row_.size() + column_.size()) * sizeof(int);
  }

 private:
  static constexpr int largest_group = 12, most_separated = 256;
  enum Part { diagonal, lower, upper, left, right, parts };

  struct Separator {
    int first_group, groups;
    int first, first_size;  ///< its first group's numbers among the separators'
    int last, last_size;
  };

  std::size_t block(Part part, int t) const { return (at(t) * parts + at(part)) * at(b_ * b_); }
  Pack* part(Part p, int t) { return pool_.data() + block(p, t); }
  const Pack* part(Part p, int t) const { return pool_.data() + block(p, t); }
  std::size_t coupling(int separator, bool next) const {
    return at(separated_) * at(separated_) + at(2 * separator + next) * at(b_ * b_);
  }

  /// False if it does not lie like this.
  bool place(const Groups& groups, Entries entries) {
    const int G = groups.count();
    std::map<int, int> how_many;
    for (const int size : groups.sizes) ++how_many[size];
    b_ = std::ranges::max_element(how_many, {}, [](const auto& s) { return s.second; })->first;
    if (b_ > largest_group) return false;
    // What is not like the others goes into the first separator: after the longest stretch of others.
    std::vector<int> odd;
    for (int g = 0; g < G; ++g)
      if (groups.sizes[at(g)] != b_) odd.push_back(g);
    int begin = 0, length = 1;
    if (!odd.empty()) {
      int longest = -1;
      for (std::size_t i = 0; i < odd.size(); ++i) {
        const int next = i + 1 < odd.size() ? odd[i + 1] : odd[0] + G;
        if (next - odd[i] > longest) longest = next - odd[i], begin = next % G;
      }
      length = G - longest + 1;
    }
    arc_ = (G - length - (lanes - 1)) / lanes;
    if (arc_ < 2) return false;
    int spare = G - length - (lanes - 1) - arc_ * lanes;

    struct Home {
      int separator = -1, lane = 0, t = 0;
    };
    std::vector<Home> home(at(G));
    std::vector<int> number_in_separators(at(G), 0);
    int g = begin;
    separated_ = 0;
    for (int l = 0; l < lanes; ++l) {
      Separator s{g, l == 0 ? length : 1, 0, 0, 0, 0};
      if (l > 0 && spare > 0) ++s.groups, --spare;
      for (int i = 0; i < s.groups; ++i, ++g) {
        const int group = g % G, size = groups.sizes[at(group)];
        // Its end groups' couplings have the room of a usual group.
        if (size > b_ && (i == 0 || i == s.groups - 1)) return false;
        home[at(group)].separator = l;
        number_in_separators[at(group)] = separated_;
        if (i == 0) s.first = separated_, s.first_size = size;
        s.last = separated_, s.last_size = size;
        separated_ += size;
      }
      for (int t = 0; t < arc_; ++t, ++g) home[at(g % G)] = {-1, l, t};
      separators_.push_back(s);
    }
    if (separated_ > most_separated) return false;

    pool_.resize(block(diagonal, arc_));
    couplings_.resize(coupling(lanes, false));
    z_.resize(at(arc_ * b_));
    inverse_.resize(separated_, separated_);
    separated_rhs_.resize(separated_), separated_x_.resize(separated_);
    std::vector<int> row_in_group, column_in_group;
    list_members(groups.of_row, G, home, number_in_separators, row_, separated_row_, row_in_group);
    list_members(groups.of_column, G, home, number_in_separators, column_, separated_column_, column_in_group);

    for (const auto& e : entries) {
      const int from = groups.of_row[at(e.row)], to = groups.of_column[at(e.column)];
      const int i = row_in_group[at(e.row)], m = column_in_group[at(e.column)];
      const Home row = home[at(from)], column = home[at(to)];
      std::ptrdiff_t where;
      const auto in_pool = [&](Part p) {
        return static_cast<std::ptrdiff_t>((block(p, row.t) + at(i * b_ + m)) * lanes + at(row.lane));
      };
      const auto in_couplings = [](std::size_t n) { return -1 - static_cast<std::ptrdiff_t>(n); };
      if (row.separator >= 0 && column.separator >= 0) {
        where = in_couplings(at(number_in_separators[at(from)] + i) * at(separated_) +
                             at(number_in_separators[at(to)] + m));
      } else if (row.separator >= 0) {
        where = in_couplings(coupling(row.separator, to == (from + 1) % G) + at(i * b_ + m));
      } else if (column.separator >= 0) {
        where = in_pool(to == (from + 1) % G ? right : left);
      } else {
        where = in_pool(from == to ? diagonal : to == (from + 1) % G ? upper : lower);
      }
      where_.push_back(static_cast<int>(where));
    }
    return true;
  }

  template <class Home>
  void list_members(const std::vector<int>& group_of, int G, const std::vector<Home>& home,
                    const std::vector<int>& number, std::vector<int>& in_arcs, std::vector<int>& separated,
                    std::vector<int>& in_group) const {
    std::vector<int> next(at(G), 0);
    in_arcs.resize(at(arc_ * b_ * lanes));
    separated.resize(at(separated_));
    for (std::size_t n = 0; n < group_of.size(); ++n) {
      const int group = group_of[n], i = next[at(group)]++;
      const Home& h = home[at(group)];
      in_group.push_back(i);
      if (h.separator >= 0) separated[at(number[at(group)] + i)] = static_cast<int>(n);
      else in_arcs[at((h.t * b_ + i) * lanes + h.lane)] = static_cast<int>(n);
    }
  }

  /// a −= l · u
  void subtract_product(Pack* a, const Pack* l, const Pack* u) const {
    for (int i = 0; i < b_; ++i)
      for (int c = 0; c < b_; ++c)
        for (int m = 0; m < b_; ++m) a[i * b_ + c] -= l[i * b_ + m] * u[m * b_ + c];
  }
  /// a ← l · a
  void multiply(const Pack* l, Pack* a) const {
    Pack column[largest_group];
    for (int c = 0; c < b_; ++c) {
      for (int i = 0; i < b_; ++i) {
        column[i] = Pack(0.0);
        for (int m = 0; m < b_; ++m) column[i] += l[i * b_ + m] * a[m * b_ + c];
      }
      for (int i = 0; i < b_; ++i) a[i * b_ + c] = column[i];
    }
  }

  static double least(Pack a) {
    double smallest = std::abs(a[0]);
    for (int l = 1; l < lanes; ++l) smallest = std::min(smallest, std::abs(a[l]));
    return smallest;
  }
  /// a ← a⁻¹ by Gauss and Jordan; the pivot is the row whose smallest lane is largest. False if it is zero.
  bool invert(Pack* a) const {
    Pack rest[largest_group][2 * largest_group];
    for (int i = 0; i < b_; ++i)
      for (int c = 0; c < b_; ++c) rest[i][c] = a[i * b_ + c], rest[i][b_ + c] = Pack(i == c ? 1.0 : 0.0);
    for (int p = 0; p < b_; ++p) {
      int best = p;
      double size = least(rest[p][p]);
      for (int i = p + 1; i < b_; ++i)
        if (const double other = least(rest[i][p]); other > size) best = i, size = other;
      if (!(size > 0)) return false;
      if (best != p) std::swap_ranges(rest[p] + p, rest[p] + 2 * b_, rest[best] + p);
      const Pack scale = Pack(1.0) / rest[p][p];
      for (int c = p; c < 2 * b_; ++c) rest[p][c] *= scale;
      for (int i = 0; i < b_; ++i) {
        if (i == p) continue;
        const Pack by = rest[i][p];
        for (int c = p; c < 2 * b_; ++c) rest[i][c] -= by * rest[p][c];
      }
    }
    for (int i = 0; i < b_; ++i)
      for (int c = 0; c < b_; ++c) a[i * b_ + c] = rest[i][b_ + c];
    return true;
  }

  bool eliminate() {
    for (int t = 0; t < arc_; ++t) {
      Pack* const D = part(diagonal, t);
      if (t > 0) {
        subtract_product(D, part(lower, t), part(upper, t - 1));
        subtract_product(part(left, t), part(lower, t), part(left, t - 1));
      }
      if (!invert(D)) return false;
      multiply(D, part(upper, t));
      multiply(D, part(left, t));
      if (t + 1 == arc_) multiply(D, part(right, t));
    }
    for (int t = arc_ - 2; t >= 0; --t) {
      subtract_product(part(left, t), part(upper, t), part(left, t + 1));
      subtract_product(part(right, t), part(upper, t), part(right, t + 1));
    }
    return true;
  }

  /// The separators' own matrix, with what goes through the arcs.
  bool join() {
    Eigen::MatrixXd S(separated_, separated_);
    for (int i = 0; i < separated_; ++i)
      for (int c = 0; c < separated_; ++c) S(i, c) = couplings_[at(i) * at(separated_) + at(c)];
    for (int l = 0; l < lanes; ++l) {
      const Separator &s = separators_[at(l)], &after = separators_[at((l + 1) % lanes)];
      const double *forward = &couplings_[coupling(l, true)], *back = &couplings_[coupling((l + 1) % lanes, false)];
      const auto subtract = [&](int row, int rows, const double* by, const Pack* through, int column, int columns) {
        for (int i = 0; i < rows; ++i)
          for (int c = 0; c < columns; ++c)
            for (int m = 0; m < b_; ++m) S(row + i, column + c) -= by[i * b_ + m] * through[m * b_ + c][l];
      };
      subtract(s.last, s.last_size, forward, part(left, 0), s.last, s.last_size);
      subtract(s.last, s.last_size, forward, part(right, 0), after.first, after.first_size);
      subtract(after.first, after.first_size, back, part(left, arc_ - 1), s.last, s.last_size);
      subtract(after.first, after.first_size, back, part(right, arc_ - 1), after.first, after.first_size);
    }
    if (!S.allFinite()) return false;
    inverse_ = S.partialPivLu().inverse();
    return inverse_.allFinite();
  }

  /// Solves for a vector that is known: A x = b is to hold up to rounding.
  bool is_accurate(const std::vector<double>& values, Entries entries) const {
    const std::size_t n = row_.size() + separated_row_.size();
    std::vector<double> b(n, 0.0), size(n, 0.0), x(n), left_over;
    for (std::size_t i = 0; i < n; ++i)
      x[i] = 1 - 0.5 * static_cast<double>(i % 3) + 0.125 * static_cast<double>(i % 5);
    for (const auto& e : entries) b[at(e.row)] += values[at(e.place)] * x[at(e.column)];
    left_over = b;
    solve(b.data(), x.data());
    for (const auto& e : entries) {
      const double term = values[at(e.place)] * x[at(e.column)];
      left_over[at(e.row)] -= term;
      size[at(e.row)] += std::abs(term);
    }
    for (std::size_t i = 0; i < n; ++i)
      if (!(std::abs(left_over[i]) <= 1e-12 * size[i])) return false;
    return true;
  }

  template <int size>
  void solve_groups_of(const double* rhs, double* x) const {
    const int b = size > 0 ? size : b_;
    Pack r[largest_group];
    const auto gather = [&](int t) {
      for (int i = 0; i < b; ++i)
        for (int l = 0; l < lanes; ++l) r[i].v[l] = rhs[row_[at((t * b + i) * lanes + l)]];
    };
    for (int t = 0; t < arc_; ++t) {
      gather(t);
      const Pack *D = part(diagonal, t), *L = part(lower, t);
      Pack* const z = z_.data() + t * b;
      if (t > 0)
        for (int m = 0; m < b; ++m)
          for (int i = 0; i < b; ++i) r[i] -= L[i * b + m] * z[m - b];
      for (int i = 0; i < b; ++i) z[i] = D[i * b] * r[0];
      for (int m = 1; m < b; ++m)
        for (int i = 0; i < b; ++i) z[i] += D[i * b + m] * r[m];
    }
    for (int t = arc_ - 2; t >= 0; --t) {
      const Pack* W = part(upper, t);
      Pack* const z = z_.data() + t * b;
      for (int m = 0; m < b; ++m)
        for (int i = 0; i < b; ++i) z[i] -= W[i * b + m] * z[b + m];
    }
    Pack s_left[largest_group], s_right[largest_group];
    solve_separators(rhs, x, s_left, s_right);
    for (int t = 0; t < arc_; ++t) {
      const Pack *P = part(left, t), *Q = part(right, t);
      for (int i = 0; i < b; ++i) {
        Pack value = z_[at(t * b + i)];
        for (int m = 0; m < b; ++m) value -= P[i * b + m] * s_left[m] + Q[i * b + m] * s_right[m];
        for (int l = 0; l < lanes; ++l) x[column_[at((t * b + i) * lanes + l)]] = value[l];
      }
    }
  }

  void solve_separators(const double* rhs, double* x, Pack* s_left, Pack* s_right) const {
    for (int i = 0; i < separated_; ++i) separated_rhs_[i] = rhs[separated_row_[at(i)]];
    for (int l = 0; l < lanes; ++l) {
      const Separator &s = separators_[at(l)], &after = separators_[at((l + 1) % lanes)];
      const double *forward = &couplings_[coupling(l, true)], *back = &couplings_[coupling((l + 1) % lanes, false)];
      for (int i = 0; i < s.last_size; ++i)
        for (int m = 0; m < b_; ++m) separated_rhs_[s.last + i] -= forward[i * b_ + m] * z_[at(m)][l];
      for (int i = 0; i < after.first_size; ++i)
        for (int m = 0; m < b_; ++m)
          separated_rhs_[after.first + i] -= back[i * b_ + m] * z_[at((arc_ - 1) * b_ + m)][l];
    }
    separated_x_.noalias() = inverse_ * separated_rhs_;
    for (int i = 0; i < separated_; ++i) x[separated_column_[at(i)]] = separated_x_[i];
    for (int m = 0; m < b_; ++m) {
      s_left[m] = s_right[m] = Pack(0.0);
      for (int l = 0; l < lanes; ++l) {
        const Separator &s = separators_[at(l)], &after = separators_[at((l + 1) % lanes)];
        if (m < s.last_size) s_left[m].v[l] = separated_x_[s.last + m];
        if (m < after.first_size) s_right[m].v[l] = separated_x_[after.first + m];
      }
    }
  }

  int b_ = 0, arc_ = 0, separated_ = 0;  ///< of a group; groups of an arc; unknowns of all separators
  std::vector<Separator> separators_;    ///< separator l is before arc l
  std::vector<Pack> pool_;         ///< the parts of each t, rows · b + columns; `diagonal` is D⁻¹, `upper` is W
  std::vector<double> couplings_;  ///< the separators' own entries, then theirs with the arcs before and after
  Eigen::MatrixXd inverse_;
  std::vector<int> where_;  ///< of each entry: in pool_ by lanes, or −1 − where in couplings_
  std::vector<int> row_, column_, separated_row_, separated_column_;
  mutable std::vector<Pack> z_;
  mutable Eigen::VectorXd separated_rhs_, separated_x_;
};

}  // namespace

/// A block that is too large to be dense.
struct BlockSolver::Large {
  int size;
  std::unique_ptr<Arcs> arcs;
  bool by_arcs = false;
  Eigen::SparseMatrix<double> matrix;
  std::vector<int> where;  ///< of the entries, in matrix.valuePtr()
  std::unique_ptr<Eigen::SparseLU<Eigen::SparseMatrix<double>>> sparse;
  mutable Eigen::VectorXd x;

  Large(int n, Entries entries, const std::vector<int>& row_sites, const std::vector<int>& column_sites) : size(n) {
    if (row_sites.empty()) return;
    auto groups = grouped(row_sites, column_sites, entries);
    // Row n is solved for column n: it may as well lie where its column does.
    if (!groups) groups = grouped(column_sites, column_sites, entries);
    if (groups) arcs = Arcs::make(*groups, entries);
    by_arcs = arcs != nullptr;
  }

  bool factor(const std::vector<double>& values, Entries entries) {
    by_arcs = arcs && arcs->factor(values, entries);
    if (by_arcs) return true;
    if (!sparse) prepare(entries);
    for (std::size_t e = 0; e < entries.size(); ++e) matrix.valuePtr()[where[e]] = values[at(entries[e].place)];
    sparse->factorize(matrix);
    return sparse->info() == Eigen::Success;
  }

  void prepare(Entries entries) {
    std::vector<Eigen::Triplet<double>> triplets;
    for (const Entry& e : entries) triplets.emplace_back(e.row, e.column, 1.0);
    matrix.resize(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    matrix.makeCompressed();
    for (const Entry& e : entries) {
      const int* first = matrix.innerIndexPtr() + matrix.outerIndexPtr()[e.column];
      const int* last = matrix.innerIndexPtr() + matrix.outerIndexPtr()[e.column + 1];
      where.push_back(static_cast<int>(std::lower_bound(first, last, e.row) - matrix.innerIndexPtr()));
    }
    sparse = std::make_unique<Eigen::SparseLU<Eigen::SparseMatrix<double>>>();
    sparse->analyzePattern(matrix);
  }

  /// `part`: b, then x behind it.
  void solve(double* part) const {
    if (by_arcs) {
      arcs->solve(part, part + size);
      return;
    }
    x = sparse->solve(Eigen::Map<const Eigen::VectorXd>(part, size));
    std::copy_n(x.data(), size, part + size);
  }

  std::size_t bytes() const {
    std::size_t total = arcs ? arcs->bytes() : 0;
    if (sparse)
      total += static_cast<std::size_t>(matrix.nonZeros() + sparse->nnzL() + sparse->nnzU()) *
               (sizeof(double) + sizeof(int));
    return total;
  }
};

BlockSolver::~BlockSolver() = default;
BlockSolver::BlockSolver(BlockSolver&&) noexcept = default;
BlockSolver& BlockSolver::operator=(BlockSolver&&) noexcept = default;

BlockSolver::BlockSolver(int n, const std::vector<std::pair<int, int>>& places, const std::vector<char>& present,
                         bool matched, const Sites& sites) {
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
  for (const auto& block : members) {
    const int size = static_cast<int>(block.size());
    blocks_.push_back({.first = static_cast<int>(members_.size()), .size = size});
    largest_ = std::max(largest_, size);
    members_.insert(members_.end(), block.begin(), block.end());
  }
  list_entries(n, places, present);
  pivots_.resize(members_.size());
  part_.resize(at(2 * largest_));
  std::size_t factors = 0;
  for (Block& b : blocks_) {
    b.factors = factors;
    if (b.size <= largest_dense) {
      factors += at(b.size * b.size);
      continue;
    }
    std::vector<int> row_sites, column_sites;
    for (int i = 0; i < b.size && !sites.of_row.empty(); ++i) {
      row_sites.push_back(sites.of_row[at(members_[at(b.first + i)])]);
      column_sites.push_back(sites.of_column[at(members_[at(b.first + i)])]);
    }
    b.large = static_cast<int>(large_.size());
    large_.push_back(std::make_unique<Large>(b.size, Entries(inside_).subspan(b.inside, b.inside_end - b.inside),
                                             row_sites, column_sites));
  }
  factors_.resize(factors);
}

/// Entries block by block, those within and those that couple a block to what was solved before it.
void BlockSolver::list_entries(int n, const std::vector<std::pair<int, int>>& places,
                               const std::vector<char>& present) {
  std::vector<int> block(at(n)), position(at(n));
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int i = 0; i < blocks_[b].size; ++i) {
      const int member = members_[at(blocks_[b].first + i)];
      block[at(member)] = static_cast<int>(b);
      position[at(member)] = i;
    }
  const auto for_each = [&](const auto& visit) {
    for (std::size_t p = 0; p < places.size(); ++p) {
      if (!present[p]) continue;
      const auto [row, column] = places[p];
      visit(blocks_[at(block[at(row)])], block[at(row)] == block[at(column)], static_cast<int>(p), row, column);
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
    if (is_inside) inside_[b.inside_end++] = {position[at(row)], position[at(column)], p};
    else outside_[b.outside_end++] = {position[at(row)], column, p};
  });
}

bool BlockSolver::factor(const std::vector<double>& values) {
  values_ = values;
  for (const Block& b : blocks_) {
    const Entries entries = Entries(inside_).subspan(b.inside, b.inside_end - b.inside);
    if (!(b.large >= 0 ? large_[at(b.large)]->factor(values, entries) : factor_dense(b, values))) return false;
  }
  return true;
}

/// L and U in place, row by row, rows exchanged for the largest pivot; 1/U_pp on the diagonal.
bool BlockSolver::factor_dense(const Block& block, const std::vector<double>& values) {
  const int n = block.size;
  double* const a = factors_.data() + block.factors;
  std::fill_n(a, n * n, 0.0);
  for (std::size_t e = block.inside; e < block.inside_end; ++e)
    a[inside_[e].row * n + inside_[e].column] = values[at(inside_[e].place)];
  for (int p = 0; p < n; ++p) {
    int best = p;
    for (int i = p + 1; i < n; ++i)
      if (std::abs(a[i * n + p]) > std::abs(a[best * n + p])) best = i;
    pivots_[at(block.first + p)] = best;
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
  for (int p = 0; p < n; ++p) std::swap(x[p], x[pivots_[at(block.first + p)]]);
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
    for (int i = 0; i < b.size; ++i) part_[at(i)] = rhs[at(member[i])];
    for (std::size_t e = b.outside; e < b.outside_end; ++e)
      part_[at(outside_[e].row)] -= values_[at(outside_[e].place)] * x[at(outside_[e].column)];
    const double* result = part_.data();
    if (b.large >= 0) large_[at(b.large)]->solve(part_.data()), result += b.size;
    else solve_dense(b);
    for (int i = 0; i < b.size; ++i) x[at(member[i])] = result[i];
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
  const bool sparse = std::ranges::any_of(large_, [](const auto& large) { return !large->by_arcs; });
  const std::string kind = largest_ <= largest_dense ? "dense" : sparse ? "sparse" : "block tridiagonal";
  const std::string size = std::to_string(largest_);
  if (blocks() == 1) return kind + " LU of " + size + " unknowns";
  return std::to_string(blocks()) + " blocks in turn, " +
         (largest_ == 1 ? "a division each" : kind + " LU of at most " + size + " unknowns each");
}

}  // namespace delf
