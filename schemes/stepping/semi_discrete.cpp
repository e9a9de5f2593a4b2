// SPDX-License-Identifier: MIT
#include "schemes/stepping/semi_discrete.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "jets/simd/scratch_rows.hpp"

namespace delf {
namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_iterations = 50;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The cells of a row, the values at their lower sides, and the velocities that are unknown.
class LowerSide {
 public:
  LowerSide(const JetFamily& family, const LatticeSystem& system, const Window& window, std::int64_t row)
      : density_(family.density()),
        points_(family.table().lower_side),
        d_(density_.components()),
        m_(density_.variables()),
        k_(system.lattice().space_step()),
        t_(static_cast<double>(row) * system.time_step()) {
    const StencilTable& table = family.table();
    const Lattice& lattice = system.lattice();
    std::vector<Site> vertices;
    for (const Site& v : table.pattern.vertices)
      if (v.time == 0 && table.nodes[at(v.node)].time == 0) vertices.push_back(v);
    std::vector<int> number(at(lattice.sites() * system.components()), -1);
    for (int cell = 0; cell < lattice.sites(); ++cell) {
      if (!system.has_stencil(family, row, cell)) continue;
      x_.push_back(lattice.position(cell));
      for (const Site& v : vertices)
        for (int a = 0; a < d_; ++a) {
          const int c = v.node * d_ + a, home = lattice.home(cell + v.space), place = home * system.components() + c;
          y_.push_back(window(row, cell + v.space, c));
          if (!system.is_held(home, c) && number[at(place)] < 0) {
            number[at(place)] = static_cast<int>(places_.size());
            places_.push_back(place);
          }
          unknown_.push_back(number[at(place)]);
        }
    }
    values_ = static_cast<int>(vertices.size()) * d_;
    cells_ = static_cast<int>(x_.size());
    padded_ = (cells_ + lanes - 1) / lanes * lanes;
  }

  /// Where the unknowns lie in a row: site · C + component.
  const std::vector<int>& places() const { return places_; }

  /// ∂L/∂v, and ∂²L/∂v∂v if `mass` is asked for.
  Vector momenta(const Vector& v, Sparse* mass) const {
    Vector p = Vector::Zero(v.size());
    std::vector<Eigen::Triplet<double>> entries;
    const ScratchRows H(mass ? m_ * m_ : 0, padded_);
    each_point(v, [&](const TablePoint& point, const JetBatch& jets, double* const* g, const double*) {
      if (mass) density_.hessian(jets, H.data());
      for (int cell = 0; cell < cells_; ++cell)
        for (const auto& [b, left] : point[JetSlot::phi])
          for (int a = 0; a < d_; ++a) {
            const int row = unknown(cell, b, a);
            if (row < 0) continue;
            p[row] += k_ * point.weight * left * g[d_ + a][cell];
            if (!mass) continue;
            for (const auto& [c, right] : point[JetSlot::phi])
              for (int e = 0; e < d_; ++e)
                if (const int column = unknown(cell, c, e); column >= 0 && !density_.is_zero(d_ + a, d_ + e))
                  entries.emplace_back(row, column, k_ * point.weight * left * right * H[(d_ + a) * m_ + d_ + e][cell]);
          }
    });
    if (mass) {
      mass->resize(v.size(), v.size());
      mass->setFromTriplets(entries.begin(), entries.end());
    }
    return p;
  }

  EnergyMomentum energy(const Vector& p, const Vector& v) const {
    EnergyMomentum sum{p.dot(v), 0};  // p·v − L
    each_point(v, [&](const TablePoint& point, const JetBatch& jets, double* const* g, const double* l) {
      for (int cell = 0; cell < cells_; ++cell) {
        sum.energy -= k_ * point.weight * l[cell];
        for (int a = 0; a < d_; ++a) sum.momentum -= k_ * point.weight * jets.slots[2 * d_ + a][cell] * g[d_ + a][cell];
      }
    });
    return sum;
  }

 private:
  int unknown(int cell, int vertex, int a) const { return unknown_[at(cell * values_ + vertex * d_ + a)]; }

  /// The jets of all cells at each point, with the density's gradient and value.
  template <class Visit>
  void each_point(const Vector& v, const Visit& visit) const {
    const ScratchRows jet(m_ + 1, padded_), g(m_ + 1, padded_);
    for (const TablePoint& point : points_) {
      for (int i = 0; i < m_; ++i) std::fill_n(jet[i], padded_, 0.0);
      for (int cell = 0; cell < padded_; ++cell) {
        const int from = std::min(cell, cells_ - 1);  // the last pack is filled up
        for (int a = 0; a < d_; ++a) {
          for (const auto& [b, weight] : point[JetSlot::phi]) {
            jet[a][cell] += weight * y_[at(from * values_ + b * d_ + a)];
            if (const int n = unknown(from, b, a); n >= 0) jet[d_ + a][cell] += weight * v[n];
          }
          for (const auto& [b, weight] : point[JetSlot::phi_x])
            jet[2 * d_ + a][cell] += weight / k_ * y_[at(from * values_ + b * d_ + a)];
        }
        jet[m_][cell] = x_[at(from)] + point.space * k_;
      }
      const JetBatch jets{padded_, jet.data(), t_, jet[m_]};
      density_.gradient(jets, g.data(), g[m_]);
      visit(point, jets, g.data(), g[m_]);
    }
  }

  const BatchDensity& density_;
  const std::vector<TablePoint>& points_;
  int d_, m_, values_ = 0, cells_ = 0, padded_ = 0;
  double k_, t_;
  std::vector<double> x_, y_;
  std::vector<int> unknown_, places_;
};

/// The equations `tangent` over the unknowns at `places`.
Sparse bound_rows(const std::vector<int>& places, std::span<const MatrixEntry> tangent, const Vector& unknowns) {
  std::map<int, int> number;
  for (std::size_t i = 0; i < places.size(); ++i) number[places[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (const MatrixEntry& e : tangent)
    if (const auto row = number.find(e.row), column = number.find(e.column);
        row != number.end() && column != number.end())
      entries.emplace_back(row->second, column->second, e.value);
  Sparse bound(unknowns.size(), unknowns.size());
  bound.setFromTriplets(entries.begin(), entries.end());
  return bound;
}
/// Rows of `bound` that have entries, in place of those of `mass` and of what is left of it.
void replace_rows(const Sparse& bound, const Vector& v, Vector& gap, Sparse& mass) {
  std::vector<bool> replaced(static_cast<std::size_t>(v.size()));
  std::vector<Eigen::Triplet<double>> entries;
  const auto each = [](const Sparse& matrix, const auto& take) {
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
      for (Sparse::InnerIterator it(matrix, column); it; ++it)
        take(static_cast<int>(it.row()), static_cast<int>(it.col()), it.value());
  };
  each(bound, [&](int row, int column, double value) {
    replaced[static_cast<std::size_t>(row)] = true, entries.emplace_back(row, column, value);
  });
  each(mass, [&](int row, int column, double value) {
    if (!replaced[static_cast<std::size_t>(row)]) entries.emplace_back(row, column, value);
  });
  mass.setFromTriplets(entries.begin(), entries.end());
  const Vector of_bound = -(bound * v);
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (replaced[static_cast<std::size_t>(i)]) gap[i] = of_bound[i];
}

}  // namespace

EnergyMomentum semi_discrete_energy(const JetFamily& family, const LatticeSystem& system, const Window& window,
                                    std::int64_t row, std::span<const double> p, std::span<const MatrixEntry> tangent) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const LowerSide side(family, system, window, row);
  const auto n = static_cast<Eigen::Index>(side.places().size());
  Vector wanted(n), v = Vector::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) wanted[i] = p[at(side.places()[static_cast<std::size_t>(i)])];
  const bool varies = family.density().nonlinearity() == Nonlinearity::all;
  Sparse mass;
  const Sparse bound = bound_rows(side.places(), tangent, wanted);
  Eigen::SparseLU<Sparse> lu;
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const bool factor = varies || iteration == 0;
    Vector gap = wanted - side.momenta(v, factor ? &mass : nullptr);
    if (!tangent.empty()) replace_rows(bound, v, gap, mass);
    if (factor) lu.compute(mass);
    if (lu.info() != Eigen::Success) return {none, none};
    const Vector change = lu.solve(gap);
    if (!change.allFinite()) return {none, none};
    v += change;
    const double size = change.lpNorm<Eigen::Infinity>(), scale = v.lpNorm<Eigen::Infinity>();
    // corrections that no longer shrink are rounding, if they are small
    if (size <= 4 * epsilon * scale || (size > 0.25 * before && size <= 512 * epsilon * scale))
      return side.energy(tangent.empty() ? wanted : side.momenta(v, nullptr), v);
    before = size;
  }
  return {none, none};
}

}  // namespace delf
