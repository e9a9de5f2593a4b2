// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "lattice/index.hpp"
#include "tools/bench/by_hand/mixed_number.hpp"
#include "tools/bench/by_hand/packed_band.hpp"

namespace delf::bench {

/// A value that a stencil Lagrangian reads: row and site from its anchor, and component.
struct StencilValue {
  int time, space, component;
};

/// Sites of a packed slab: in a line between two walls that are held, or round a circle, which is folded flat so that
/// neighbours are two apart at most.
struct PackedLine {
  int sites;
  bool circle;

  int first() const { return circle ? 0 : 1; }
  int nodes() const { return circle ? sites : sites - 2; }
  int node(int s) const {
    if (circle) return s < (sites + 1) / 2 ? 2 * s : 2 * (sites - s) - 1;
    return s >= 1 && s <= nodes() ? s - 1 : -1;
  }
};

/// The slabs of a system of stencil Lagrangians, written for speed and for nothing else: what the engine's slab stepper
/// is held against. Everything is known when it is compiled: the stencils, which values have equations and which are
/// unknown, the width of the band. Residual and Jacobian come from one sweep of second derivatives over packs of
/// stencils, equations × unknowns; they are added into a band by lists of indices; Newton's method starts from a
/// polynomial of order eight and ends by an estimate.
///
/// `System` lists, for each component, the rows of its equation and of its unknown in a slab from row j, and whether it
/// is a multiplier; and the width of the band.
template <class System>
class PackedSlab {
 public:
  using Rows = std::array<double*, 3>;  ///< j − 1, j, j + 1, component by component

  template <class... Lagrangians>
  PackedSlab(PackedLine line, double tolerance, bool keeps_jacobian, const Lagrangians&... lagrangians)
      : line_(line),
        tolerance_(tolerance),
        keeps_(keeps_jacobian),
        n_(components * line.nodes()),
        band_(n_),
        E_(at(n_) + 1),
        known_(E_) {
    for (int r = 0; r < depth; ++r) ring_[r].assign(components * line.sites + lanes, 0.0);
    for (int s = line.first(); s < line.first() + line.nodes(); ++s) numbers_.push_back(components * line.node(s));
    (add_family(lagrangians), ...);
  }

  /// Rows as the engine has them, row[i · components + c].
  void start(const std::vector<std::vector<double>>& rows) {
    j_ = 1, has_factor_ = false, curvature_ = -1, unseen_ = 0, last_iterations_ = fresh_iterations_ = 0;
    for (auto& row : ring_) std::ranges::fill(row, 0.0);
    for (int r = 0; r < 2; ++r)
      for (int i = 0; i < line_.sites; ++i)
        for (int c = 0; c < components; ++c)
          row(r)[c * line_.sites + i] = System::multiplier[c] ? 0 : rows[r][i * components + c];
  }

  void step() {
    predict();
    const Rows rows{row(j_ - 1), row(j_), row(j_ + 1)};
    std::ranges::fill(known_, 0.0);
    for (const auto& b : batches_)
      if (!b->has_unknown) b->add(rows, known_.data(), nullptr);
    bool refactor = !keeps_ || !has_factor_ || last_iterations_ > fresh_iterations_ + 1, fresh = false;
    double before = 0;
    for (int iteration = 1;; ++iteration) {
      std::ranges::copy(known_, E_.begin());
      if (refactor) band_.set_zero();
      for (const auto& b : batches_)
        if (b->has_unknown) b->add(rows, E_.data(), refactor ? band_.numbers() : nullptr);
      if (refactor) {
        if (!band_.factor()) throw std::runtime_error("packed slab: singular");
        has_factor_ = fresh = true;
      }
      band_.solve(E_.data());
      const double change = take(rows), ratio = iteration > 1 ? change / before : 1;
      if (!(change < 1e3) || iteration > 40) throw std::runtime_error("packed slab: no convergence");
      if (iteration > 1) curvature_ = std::max(change / (before * before), 0.5 * curvature_), unseen_ = 0;
      else ++unseen_;
      last_iterations_ = iteration;
      if (fresh) fresh_iterations_ = iteration;
      if (change <= tolerance_) break;
      if (iteration > 3 && change > 0.3 * before && change < 1e-10) break;  // rounding
      // One matrix leaves ρ/(1 − ρ) of the correction, a new one each time C times its square.
      if (keeps_ && ratio < 0.5 && 2 * ratio / (1 - ratio) * change <= tolerance_) break;
      if (!keeps_ && (iteration > 1 || unseen_ < 8) && curvature_ >= 0 &&
          4 * curvature_ * change * change <= tolerance_)
        break;
      refactor = !keeps_ || (iteration > 1 && ratio > 0.2);
      before = change;
    }
    ++j_;
  }

  /// The newest row of a component.
  const double* newest(int component) { return row(j_) + component * line_.sites; }

 private:
  static constexpr int components = System::components, order = 8, depth = order + 3;

  /// The stencils of one Lagrangian that stand in one row of anchors.
  struct Batch {
    bool has_unknown = false;
    virtual ~Batch() = default;
    virtual void add(const Rows&, double* E, double* band) const = 0;  ///< E, and the Jacobian if there is a band
  };
  /// Bit i: value i of stencils anchored at this row has its equation, or is unknown, in the slab.
  template <class L, int anchor, bool equations>
  static constexpr unsigned mask() {
    unsigned m = 0;
    for (std::size_t i = 0; i < L::values.size(); ++i) {
      const StencilValue& v = L::values[i];
      if (anchor + v.time == (equations ? System::equation : System::unknown)[v.component]) m |= 1u << i;
    }
    return m;
  }
  template <class L, int anchor>
  class BatchOf final : public Batch {
    static constexpr int size = static_cast<int>(L::values.size());
    static constexpr unsigned E_ = mask<L, anchor, true>(), U_ = mask<L, anchor, false>();
    static constexpr int ne = std::popcount(E_), nu = std::popcount(U_);
    static constexpr int rank(unsigned m, int i) { return std::popcount(m & ((1u << i) - 1)); }

   public:
    BatchOf(const L& lagrangian, const PackedLine& line, const PackedBand<System::half_band>& band)
        : lagrangian_(lagrangian) {
      this->has_unknown = nu > 0;
      int low = 0, high = 0;
      for (const StencilValue& v : L::values) low = std::min(low, v.space), high = std::max(high, v.space);
      std::vector<int> sites;
      for (int s = 0; s < line.sites; ++s)
        if (line.circle || (s + low >= 0 && s + high < line.sites)) sites.push_back(s);
      const int count = static_cast<int>(sites.size()), C = components;
      packs_ = (count + lanes - 1) / lanes;
      for (int p = 0; p < packs_; ++p) {
        const auto site = [&](int i, int l) {
          return (sites[at(std::min(p * lanes + l, count - 1))] + L::values[i].space + line.sites) % line.sites;
        };
        const auto number = [&](int i, int l) {
          const int node = p * lanes + l < count ? line.node(site(i, l)) : -1;
          return node < 0 ? -1 : C * node + L::values[i].component;
        };
        for (int i = 0; i < size; ++i) {
          bool follow = true;
          for (int l = 0; l < lanes; ++l) {
            places_.push_back(L::values[i].component * line.sites + site(i, l));
            follow = follow && site(i, l) == site(i, 0) + l;
          }
          follow_.push_back(follow);
          if (!(E_ >> i & 1)) continue;
          for (int l = 0; l < lanes; ++l) equations_.push_back(number(i, l) < 0 ? C * line.nodes() : number(i, l));
          for (int m = 0; m < size; ++m)
            for (int l = 0; l < lanes && (U_ >> m & 1); ++l)
              entries_.push_back(number(i, l) < 0 || number(m, l) < 0 ? band.beyond()
                                                                      : band.place(number(i, l), number(m, l)));
        }
      }
    }
    void add(const Rows& rows, double* E, double* band) const override {
      if (band && nu > 0) add_all<nu>(rows, E, band);
      else add_all<0>(rows, E, band);
    }

   private:
    template <int unknowns>
    [[gnu::flatten, gnu::noinline]] void add_all(const Rows& rows, double* E, [[maybe_unused]] double* band) const {
      const int *equation = equations_.data(), *entry = entries_.data();
      const auto spread = [](const Pack& x, double* to, const int*& where) __attribute__((always_inline)) {
        each<lanes>([&](auto l) { to[where[l]] += x[int(l)]; });
        where += lanes;
      };
      for (int p = 0; p < packs_; ++p) {
        using Number = Mixed<ne, unknowns>;
        Number y[size];
        each<size>([&](auto i) __attribute__((always_inline)) {
          const double* const row = rows[at(anchor + L::values[i].time + 1)];
          const int* const place = places_.data() + (p * size + i) * lanes;
          Pack x;
          if (follow_[p * size + i]) std::memcpy(&x, row + *place, sizeof x);
          else each<lanes>([&](auto l) { x.v[int(l)] = row[place[l]]; });
          y[i] = Number(x);
          if constexpr (E_ >> i & 1) y[i].e[rank(E_, i)] = Pack(1.0);
          if constexpr (unknowns > 0 && (U_ >> i & 1)) y[i].u[rank(U_, i)] = Pack(1.0);
        });
        const Number r = lagrangian_(static_cast<const Number*>(y));
        each<ne>([&](auto i) __attribute__((always_inline)) { spread(r.e[i], E, equation); });
        if constexpr (unknowns > 0)
          each<ne * nu>([&](auto k) __attribute__((always_inline)) { spread(r.m[k], band, entry); });
      }
    }

    L lagrangian_;
    int packs_;
    std::vector<int> places_, equations_, entries_;
    std::vector<char> follow_;  ///< the places of a pack follow each other
  };

  template <class L>
  void add_family(const L& lagrangian) {
    each<3>([&](auto k) {
      constexpr int anchor = k - 1;
      if constexpr (mask<L, anchor, true>() != 0)
        batches_.push_back(std::make_unique<BatchOf<L, anchor>>(lagrangian, line_, band_));
    });
  }
  double* row(long r) { return ring_[r % depth].data(); }

  /// The polynomial through eight values, or as many as there are.
  void predict() {
    std::copy_n(row(j_), components * line_.sites, row(j_ + 1));
    for (int c = 0; c < components; ++c) {
      const long to = j_ + System::unknown[c];
      const int points = static_cast<int>(std::min<long>(order, System::multiplier[c] ? j_ - 1 : j_ + 1));
      const int from = c * line_.sites + line_.first();
      double *const y = row(to) + from, weight = -1;
      std::fill_n(y, line_.nodes(), 0.0);
      for (int b = 1; b <= points; ++b) {
        weight *= -static_cast<double>(points - b + 1) / b;
        const double* const r = row(to - b) + from;
        for (int i = 0; i < line_.nodes(); ++i) y[i] += weight * r[i];
      }
    }
  }
  /// y −= correction; the largest, multipliers apart.
  double take(const Rows& rows) {
    double most = 0;
    for (int c = 0; c < components; ++c) {
      double *const y = rows[at(1 + System::unknown[c])] + c * line_.sites + line_.first(), size = 0;
      for (int i = 0; i < line_.nodes(); ++i) {
        const double by = E_[numbers_[i] + c];
        y[i] -= by, size = std::max(size, std::abs(by));
      }
      if (!System::multiplier[c]) most = std::max(most, size);
    }
    return most;
  }

  PackedLine line_;
  double tolerance_;
  bool keeps_;
  int n_;
  PackedBand<System::half_band> band_;
  std::vector<double> E_, known_;
  std::vector<std::unique_ptr<Batch>> batches_;
  std::array<std::vector<double>, depth> ring_;
  std::vector<int> numbers_;
  long j_ = 1;
  bool has_factor_ = false;
  int last_iterations_ = 0, fresh_iterations_ = 0, unseen_ = 0;
  double curvature_ = -1;
};

}  // namespace delf::bench
