// SPDX-License-Identifier: MIT
#include "schemes/solvers/lane_band_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace delf {
namespace {

using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, LaneBandSolver::widest,
                            LaneBandSolver::widest>;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

int owned_sites(const RowLayout& layout, int lane) {
  return (lane + 1 < lanes ? layout.start(lane + 1) : layout.sites()) - layout.start(lane);
}
int shortest_arc(const RowLayout& layout) {
  int shortest = layout.sites();
  for (int l = 0; l < lanes; ++l) shortest = std::min(shortest, owned_sites(layout, l));
  return shortest;
}

/// Block number `which` of one lane.
Block get(const std::vector<Pack>& blocks, int which, int lane, int rows, int columns) {
  Block m(rows, columns);
  const Pack* const p = blocks.data() + index(which) * index(rows * columns);
  for (int e = 0; e < rows * columns; ++e) m.data()[e] = p[e][lane];
  return m;
}
void put(std::vector<Pack>& blocks, int which, int lane, const Block& m) {
  Pack* const p = blocks.data() + index(which) * index(static_cast<int>(m.size()));
  for (int e = 0; e < m.size(); ++e) p[e].v[lane] = m.data()[e];
}

/// Makes zero what is below 1e-19 of the largest value of the same entry in any block and lane; so nothing becomes
/// subnormal, which would be slow. Entry by entry, because components may have different units.
void drop_small(std::vector<Pack>& blocks, int size) {
  for (std::size_t e = 0; e < index(size); ++e) {
    double largest = 0;
    for (std::size_t at = e; at < blocks.size(); at += index(size))
      for (int l = 0; l < lanes; ++l) largest = std::max(largest, std::abs(blocks[at][l]));
    for (std::size_t at = e; at < blocks.size(); at += index(size))
      for (int l = 0; l < lanes; ++l)
        if (!(std::abs(blocks[at][l]) > 1e-19 * largest)) blocks[at].v[l] = 0;
  }
}
bool is_zero(const Pack* block, int size) {
  return std::all_of(block, block + size, [](Pack p) { return sum(abs(p)) == 0; });
}
/// Blocks of a spike up to the last that is not zero; returns how many.
int cut(std::vector<Pack>& blocks, int size) {
  drop_small(blocks, size);
  int count = static_cast<int>(blocks.size()) / size;
  while (count > 0 && is_zero(blocks.data() + index(count - 1) * index(size), size)) --count;
  blocks.resize(index(count) * index(size));
  blocks.shrink_to_fit();
  return count;
}

/// K⁻¹ through (D⁻¹KD)⁻¹ with rows and columns of about the same size: pivots then do not depend on the units of the
/// components. Parlett–Reinsch (1969), doi:10.1007/BF02165404.
Eigen::MatrixXd balanced_inverse(Eigen::MatrixXd K) {
  Eigen::VectorXd D = Eigen::VectorXd::Ones(K.rows());
  for (int sweep = 0; sweep < 5; ++sweep)
    for (Eigen::Index i = 0; i < K.rows(); ++i) {
      const double own = std::abs(K(i, i)), row = K.row(i).lpNorm<1>() - own, column = K.col(i).lpNorm<1>() - own;
      const double f = std::sqrt(row / column);
      if (!(f > 0) || !std::isfinite(f)) continue;
      D[i] *= f;
      K.col(i) *= f;
      K.row(i) /= f;
    }
  return D.asDiagonal() * K.partialPivLu().inverse() * D.cwiseInverse().asDiagonal();
}

/// y += A x. With constant sizes everything stays in registers, and x, which comes late, is used column by column.
template <bool constant>
[[gnu::always_inline]] inline void add_product(Pack* y, const Pack* A, const Pack* x, int rows, int columns) {
  if constexpr (!constant) {
    for (int i = 0; i < rows; ++i) {
      Pack total = y[i];
      for (int j = 0; j < columns; ++j) total += A[i * columns + j] * x[j];
      y[i] = total;
    }
    return;
  }
#pragma GCC unroll 8
  for (int j = 0; j < columns; ++j)
#pragma GCC unroll 8
    for (int i = 0; i < rows; ++i) y[i] += A[i * columns + j] * x[j];
}

/// The newest block comes in front of what is kept of the sweep.
[[gnu::always_inline]] inline void remember(Pack* kept, const Pack* newest, int d, int n) {
#pragma GCC unroll 8
  for (int c = n - 1; c >= d; --c) kept[c] = kept[c - d];
#pragma GCC unroll 8
  for (int c = 0; c < d; ++c) kept[c] = newest[c];
}

}  // namespace

/// The matrix by sites: blocks A(i, k) = ∂(equations of site i)/∂(unknowns of site i + k), |k| ≤ s.
struct LaneBandSolver::Band {
  int d, s = 1, lower = 0, upper = 0;
  int shortest;  ///< of the arcs that the lanes own
  bool cyclic;
  std::vector<double> values;

  Band(const Lattice& lattice, const RowLayout& layout, int components,
       const std::vector<LatticeSystem::Entry>& entries)
      : d(components), shortest(shortest_arc(layout)), cyclic(lattice.is_circle()) {
    const int N = lattice.sites();
    const auto offset = [&](const LatticeSystem::Entry& e) {
      const int k = e.column / d - e.row / d;
      return !cyclic ? k : k > N / 2 ? k - N : k < -(N / 2) ? k + N : k;
    };
    for (const auto& e : entries) {
      const int k = offset(e), unknowns = k * d + e.column % d - e.row % d;
      s = std::max(s, std::abs(k));
      lower = std::max(lower, -unknowns);
      upper = std::max(upper, unknowns);
    }
    if (shortest < 2 * s + 1 || d * s > widest) return;
    values.assign(index(N) * index((2 * s + 1) * d * d), 0.0);
    for (const auto& e : entries) values[at(e.row / d, offset(e)) + index(e.row % d * d + e.column % d)] += e.value;
  }
  bool fits() const { return !values.empty(); }
  int width() const { return d * s; }
  std::size_t at(int i, int k) const { return (index(i) * index(2 * s + 1) + index(k + s)) * index(d * d); }
  Eigen::Map<const Block> block(int i, int k) const { return {values.data() + at(i, k), d, d}; }
  std::string name() const {
    return std::string("LU of a ") + (cyclic ? "cyclic " : "") + "band of width " + std::to_string(lower) + "+" +
           std::to_string(upper) + " by lanes";
  }
};

/// The factors of one lane's arc, as they are put into the packs.
class LaneBandSolver::LaneFactors {
 private:
  template <class Matrix>
  auto columns(Matrix& m, int k) const {
    return m.middleCols((k - 1) * d_, d_);
  }

 public:
  LaneFactors(LaneBandSolver& solver, const Band& band, int lane)
      : f_(solver),
        band_(band),
        lane_(lane),
        d_(band.d),
        s_(band.s),
        n_(band.width()),
        start_(solver.layout_->start(lane)),
        owned_(owned_sites(*solver.layout_, lane)) {}

  /// Block LU with U's diagonal 1, in the order of Crout: Λ_k and P are what rows before have left of A,
  ///     Λ_k = A_{−k} − Σ_{j>k} Λ_j U_{v−j, j−k},  P = A_0 − Σ_j Λ_j U_{v−j, j},
  ///     U_{v,k} = P⁻¹(A_k − Σ_j Λ_j U_{v−j, j+k}),
  /// where the stored U has the opposite sign. The spike obeys the same recurrence as z, with B for f.
  void eliminate() {
    for (int v = 0; v < owned_; ++v) {
      const int known = std::min(v, s_);  // blocks to the left within the arc
      Block lambda = Block::Zero(d_, n_);
      for (int k = known; k >= 1; --k) columns(lambda, k) = schur(v, -k, known, lambda);
      const Block Q = schur(v, 0, known, lambda).inverse();
      Block U(d_, n_), G = Block::Zero(d_, n_);
      for (int k = 1; k <= s_; ++k) columns(U, k) = -Q * schur(v, k, known, lambda);
      const Block L = -Q * lambda;
      for (int k = v + 1; k <= s_; ++k) columns(G, s_ + v - k + 1) = -Q * band_.block(start_ + v, -k);
      for (int k = 1; k <= known; ++k) G += columns(L, k) * get(f_.left_, v - k, lane_, d_, n_);
      put(f_.inverse_, v, lane_, Q);
      put(f_.lower_, v, lane_, L);
      put(f_.upper_, v, lane_, U);
      put(f_.left_, v, lane_, G);
    }
    part_from_the_next();
    for (int v = owned_; v < f_.layout_->packs(); ++v) put(f_.inverse_, v, lane_, Block::Identity(d_, d_));
  }

  /// Φ (`from` = 0) or Ψ (`from` = n_l − s): rows of U⁻¹, which give s sites from z, slots `from` and on;
  /// Y U⁻¹ = E gives Y_v = E_v + Σ_k Y_{v−k} U_{v−k,k}. Adds what a and b contribute to those sites.
  void invert_rows(int from, std::vector<Pack>& to, int first_slot, Block& alpha, Block& beta) {
    alpha = beta = Block::Zero(n_, n_);
    for (int v = from; v < owned_; ++v) {
      Block Y = Block::Zero(n_, d_);
      if (v < from + s_) Y.middleRows((v - from) * d_, d_).setIdentity();
      for (int k = 1; k <= std::min(v - from, s_); ++k) {
        const Block U = get(f_.upper_, v - k, lane_, d_, n_);
        Y += get(to, v - k - first_slot, lane_, n_, d_) * columns(U, k);
      }
      put(to, v - first_slot, lane_, Y);
      alpha += Y * get(f_.left_, v, lane_, d_, n_);
      if (v >= tail()) beta += Y * get(f_.right_, v - tail(), lane_, d_, n_);
    }
  }
  int owned() const { return owned_; }

 private:
  /// H and Ψ are kept from this slot on.
  int tail() const { return f_.layout_->packs() - f_.ends_; }
  /// A(v, k) without what the rows before take away.
  Block schur(int v, int k, int known, const Block& lambda) const {
    Block A = band_.block(start_ + v, k);
    for (int j = std::max(1, 1 - k); j <= known && j + k <= s_; ++j) {
      const Block U = get(f_.upper_, v - j, lane_, d_, n_);
      A += columns(lambda, j) * columns(U, j + k);
    }
    return A;
  }
  /// What U takes from beyond the arc goes to H.
  void part_from_the_next() {
    for (int v = owned_ - s_; v < owned_; ++v) {
      Block U = get(f_.upper_, v, lane_, d_, n_), H = Block::Zero(d_, n_);
      for (int k = owned_ - v; k <= s_; ++k) {
        columns(H, v + k - owned_ + 1) = columns(U, k);
        columns(U, k).setZero();
      }
      put(f_.upper_, v, lane_, U);
      put(f_.right_, v - tail(), lane_, H);
    }
  }

  LaneBandSolver& f_;
  const Band& band_;
  int lane_, d_, s_, n_, start_, owned_;
};

LaneBandSolver::LaneBandSolver(const RowLayout& layout, const Band& band)
    : layout_(&layout), d_(band.d), s_(band.s), ends_(layout.packs() - band.shortest + band.s), name_(band.name()) {
  const int n = band.width();
  const std::size_t packs = index(layout.packs()), ends = index(ends_);
  inverse_.assign(packs * index(d_ * d_), Pack(0.0));
  lower_.assign(packs * index(d_ * n), Pack(0.0));
  upper_ = left_ = first_ = lower_;
  right_.assign(ends * index(d_ * n), Pack(0.0));
  last_ = right_;
}

/// The first and the last s sites of every arc from Φz and Ψz:
///     first_l = (Φz)_l + α_l last_{l−1} + β_l first_{l+1},   last_l = (Ψz)_l + γ_l last_{l−1} + δ_l first_{l+1}
/// and R, the rows of the inverse that give each lane its a_l = last_{l−1} and b_l = first_{l+1}.
void LaneBandSolver::close(const Band& band) {
  const int n = band.width(), all = 2 * n * lanes;
  Eigen::MatrixXd K = Eigen::MatrixXd::Identity(all, all);
  for (int l = 0; l < lanes; ++l) {
    LaneFactors lane(*this, band, l);
    lane.eliminate();
    const int before = (l + lanes - 1) % lanes, after = (l + 1) % lanes;
    Block from_before, from_after;
    lane.invert_rows(0, first_, 0, from_before, from_after);
    K.block(2 * n * l, 2 * n * before + n, n, n) -= from_before;
    K.block(2 * n * l, 2 * n * after, n, n) -= from_after;
    lane.invert_rows(lane.owned() - s_, last_, layout_->packs() - ends_, from_before, from_after);
    K.block(2 * n * l + n, 2 * n * before + n, n, n) -= from_before;
    K.block(2 * n * l + n, 2 * n * after, n, n) -= from_after;
  }
  const Eigen::MatrixXd inverse = balanced_inverse(std::move(K));
  reduced_.assign(index(lanes) * index(4 * n * n), Pack(0.0));
  for (int l = 0; l < lanes; ++l)
    for (int shift = 0; shift < lanes; ++shift) {
      const int before = (l + lanes - 1) % lanes, after = (l + 1) % lanes, cause = (l + shift) % lanes;
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> R(2 * n, 2 * n);
      R << inverse.block(2 * n * before + n, 2 * n * cause, n, 2 * n),
          inverse.block(2 * n * after, 2 * n * cause, n, 2 * n);
      // Beyond a wall there is nothing.
      if (!band.cyclic && l == 0) R.topRows(n).setZero();
      if (!band.cyclic && l == lanes - 1) R.bottomRows(n).setZero();
      for (int e = 0; e < 4 * n * n; ++e) reduced_[index(shift) * index(4 * n * n) + index(e)].v[l] = R.data()[e];
    }
  keep_what_matters();
}

void LaneBandSolver::keep_what_matters() {
  const int n = d_ * s_, size = 4 * n * n;
  first_packs_ = cut(first_, n * d_);
  left_packs_ = cut(left_, n * d_);
  drop_small(reduced_, size);
  std::vector<Pack> kept;
  for (int shift = 0; shift < lanes; ++shift) {
    const Pack* const block = reduced_.data() + index(shift) * index(size);
    if (is_zero(block, size)) continue;
    shifts_.push_back(shift);
    kept.insert(kept.end(), block, block + size);
  }
  reduced_ = std::move(kept);
}

std::unique_ptr<LaneBandSolver> LaneBandSolver::factor(const Lattice& lattice, const RowLayout& layout, int components,
                                                       const std::vector<LatticeSystem::Entry>& entries) {
  const Band band(lattice, layout, components, entries);
  if (!band.fits()) return nullptr;
  std::unique_ptr<LaneBandSolver> solver(new LaneBandSolver(layout, band));
  solver->close(band);
  // Without pivoting the rounding errors are those of |Λ||U| (Higham 2002, doi:10.1137/1.9780898718027, theorem 9.3),
  // and arcs may be singular where the whole is not. Small pivots do not tell: they may be a matter of units, and
  // harmless ones may add up. The residual of one solve sees all of it, what spikes were cut short included; it must be
  // ten times below what is asked of a solve, 1e-12, as it varies with the right side. It does not see a singular
  // matrix, whose solutions are large and fit well: that shows in their size.
  const Trial t = trial(*solver, layout, components, entries);
  return t.residual < 1e-13 && t.growth < 1e12 ? std::move(solver) : nullptr;
}

std::size_t LaneBandSolver::bytes() const {
  std::size_t packs = 0;
  for (const auto* p : {&inverse_, &lower_, &upper_, &left_, &right_, &first_, &last_, &reduced_}) packs += p->size();
  return packs * sizeof(Pack) + shifts_.size() * sizeof(int);
}

template <int components, int reach>
[[gnu::always_inline]] inline void LaneBandSolver::solve_ends(const Pack* ends, Pack* incoming) const {
  constexpr bool constant = components * reach != 0;
  constexpr int most = constant ? components * reach : widest;
  const int n = constant ? most : d_ * s_, size = 4 * n * n;
  // Every pack twice over, so that lane l + shift is read by an unaligned load.
  double twice[2 * most][2 * lanes];
  for (int e = 0; e < 2 * n; ++e)
    for (int copy = 0; copy < 2; ++copy) std::memcpy(twice[e] + copy * lanes, &ends[e].v, sizeof(Pack));
  for (int e = 0; e < 2 * n; ++e) incoming[e] = Pack(0.0);
  const Pack* R = reduced_.data();
  for (const int shift : shifts_) {
    Pack turned[2 * most];
    for (int e = 0; e < 2 * n; ++e) std::memcpy(&turned[e].v, twice[e] + shift, sizeof(Pack));
    add_product<constant>(incoming, R, turned, 2 * n, 2 * n);
    R += size;
  }
}

template <int components, int reach>
void LaneBandSolver::solve_as(const double* const* rhs, double* const* w) const {
  constexpr bool constant = components * reach != 0;
  constexpr int most = constant ? components * reach : widest;
  constexpr int most_d = components == 0 ? widest : components;
  const int d = components == 0 ? d_ : components, s = reach == 0 ? s_ : reach, n = d * s;
  const int packs = layout_->packs(), tail = packs - ends_, first_packs = first_packs_, left_packs = left_packs_;
  Pack kept[most], block[most_d], raw[most_d], ends[2 * most], incoming[2 * most];

  for (int e = 0; e < n; ++e) kept[e] = Pack(0.0);
  for (int e = 0; e < 2 * n; ++e) ends[e] = Pack(0.0);
  const Pack *Q = inverse_.data(), *L = lower_.data(), *first = first_.data(), *last = last_.data();
  std::ptrdiff_t at = layout_->at(0);
  for (int v = 0; v < packs; ++v, at += lanes, Q += d * d, L += d * n) {
    for (int c = 0; c < d; ++c) raw[c] = Pack::load(rhs[c] + at), block[c] = Pack(0.0);
    add_product<constant>(block, Q, raw, d, d);
    add_product<constant>(block, L, kept, d, n);
    for (int c = 0; c < d; ++c) block[c].store(w[c] + at);
    remember(kept, block, d, n);
    if (v < first_packs) add_product<constant>(ends, first, block, n, d), first += n * d;
    if (v >= tail) add_product<constant>(ends + n, last, block, n, d), last += n * d;
  }

  solve_ends<components, reach>(ends, incoming);

  for (int e = 0; e < n; ++e) kept[e] = Pack(0.0);
  const Pack *U = upper_.data() + index(packs) * index(d * n), *left = left_.data() + left_.size(),
             *right = right_.data() + right_.size();
  for (int v = packs - 1; v >= 0; --v) {
    at -= lanes, U -= d * n;
    for (int c = 0; c < d; ++c) block[c] = Pack::load(w[c] + at);
    if (v < left_packs) left -= d * n, add_product<constant>(block, left, incoming, d, n);
    if (v >= tail) right -= d * n, add_product<constant>(block, right, incoming + n, d, n);
    add_product<constant>(block, U, kept, d, n);
    for (int c = 0; c < d; ++c) block[c].store(w[c] + at);
    remember(kept, block, d, n);
  }
}

void LaneBandSolver::solve(const double* const* rhs, double* const* w) const {
  switch (d_ * 100 + s_) {
    case 101:
      return solve_as<1, 1>(rhs, w);
    case 102:
      return solve_as<1, 2>(rhs, w);
    case 103:
      return solve_as<1, 3>(rhs, w);
    case 201:
      return solve_as<2, 1>(rhs, w);
    case 202:
      return solve_as<2, 2>(rhs, w);
    case 301:
      return solve_as<3, 1>(rhs, w);
    case 401:
      return solve_as<4, 1>(rhs, w);
    default:
      return solve_as<0, 0>(rhs, w);
  }
}

Trial trial(const LinearSolver& solver, const RowLayout& layout, int d,
            const std::vector<LatticeSystem::Entry>& entries) {
  const auto unknowns = index(layout.sites()) * index(d);
  std::vector<double> b(unknowns, 0.0), scale(unknowns, 0.0), site(index(layout.sites()));
  for (const auto& e : entries) scale[index(e.row)] += std::abs(e.value);
  std::mt19937_64 engine(20060201);
  for (std::size_t i = 0; i < unknowns; ++i) b[i] = scale[i] * (static_cast<double>(engine() >> 11) * 0x1p-52 - 1);
  RowBuffer rows(layout, d);
  std::vector<double*> w;
  for (int a = 0; a < d; ++a) {
    for (std::size_t i = 0; i < site.size(); ++i) site[i] = b[i * index(d) + index(a)];
    layout.scatter(site, rows.row(a));
    w.push_back(rows.row(a));
  }
  solver.solve(w.data(), w.data());
  const auto x = [&](int i) { return w[index(i % d)][layout.slot(i / d)]; };
  std::vector<double> residual = b;
  for (std::size_t i = 0; i < unknowns; ++i) scale[i] = std::abs(b[i]);
  for (const auto& e : entries) {
    residual[index(e.row)] -= e.value * x(e.column);
    scale[index(e.row)] += std::abs(e.value * x(e.column));
  }
  Trial t{0, 0};
  for (std::size_t i = 0; i < unknowns; ++i) {
    const double r = std::abs(residual[i]) / scale[i], size = std::abs(x(static_cast<int>(i)));
    if (r > t.residual || std::isnan(r)) t.residual = r;  // a NaN stays
    if (size > t.growth || std::isnan(size)) t.growth = size;
  }
  return t;
}

}  // namespace delf
