// SPDX-License-Identifier: MIT
#include "schemes/stepping/semi_discrete.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "jets/simd/scratch_rows.hpp"
#include "schemes/solvers/newton.hpp"
#include "schemes/solvers/sparse_lu.hpp"

namespace delf {
namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

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
        t_(system.times()->time(row)) {
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

/// ∂G/∂y over the unknowns at `places`, and the forces that go with it, one column for each bond.
struct BoundRows {
  Sparse J, forces;
  Vector rates;

  BoundRows(const std::vector<int>& places, const Bonds& bonds) {
    std::map<int, int> number, bond;
    for (std::size_t i = 0; i < places.size(); ++i) number[places[i]] = static_cast<int>(i);
    std::vector<Eigen::Triplet<double>> equations, reactions;
    for (const MatrixEntry& e : bonds.entries) {
      const auto own = number.find(e.row), column = number.find(e.column);
      if (own == number.end() || column == number.end()) continue;
      const auto [row, fresh] = bond.try_emplace(e.row, static_cast<int>(bond.size()));
      equations.emplace_back(row->second, column->second, e.value);
      if (fresh && bonds.slaved) reactions.emplace_back(own->second, row->second, 1);
    }
    const auto n = static_cast<Eigen::Index>(places.size()), m = static_cast<Eigen::Index>(bond.size());
    J.resize(m, n), J.setFromTriplets(equations.begin(), equations.end());
    rates = Vector::Zero(m);
    for (const auto& [own, row] : bond)
      if (const auto rate = bonds.rates.find(own); rate != bonds.rates.end()) rates[row] = rate->second;
    forces = J.transpose();
    if (bonds.slaved) forces.setFromTriplets(reactions.begin(), reactions.end());
  }
  /// (mass, forces; J, 0)
  Sparse beside(const Sparse& mass) const {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](const Sparse& part, Eigen::Index row, Eigen::Index column) {
      for (Eigen::Index c = 0; c < part.outerSize(); ++c)
        for (Sparse::InnerIterator it(part, c); it; ++it)
          entries.emplace_back(static_cast<int>(row + it.row()), static_cast<int>(column + it.col()), it.value());
    };
    const Eigen::Index n = J.cols();
    add(mass, 0, 0), add(forces, 0, n), add(J, n, 0);
    Sparse all(n + J.rows(), n + J.rows());
    all.setFromTriplets(entries.begin(), entries.end());
    return all;
  }
};

}  // namespace

namespace {

/// Of the unknowns.
Vector on_unknowns(const LowerSide& side, std::span<const double> p) {
  Vector own(static_cast<Eigen::Index>(side.places().size()));
  for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = p[at(side.places()[static_cast<std::size_t>(i)])];
  return own;
}

/// p − ∂L/∂v(v) − C μ = 0 and r − J v = 0 for the velocities v and the forces μ.
struct VelocityEquations {
  const LowerSide& side;
  const BoundRows& bound;
  const Vector& wanted;
  bool varies;  ///< the mass, with v
  Vector v = Vector::Zero(wanted.size()), force = Vector::Zero(bound.J.rows());
  Vector p = {};
  Sparse mass = {};
  SparseLU lu = {};

  bool linearise(const NewtonProgress& at) {
    const bool fresh = varies || at.iteration == 1;
    p = side.momenta(v, fresh ? &mass : nullptr);
    if (!fresh) return true;
    const Sparse A = force.size() == 0 ? mass : bound.beside(mass);
    return at.iteration == 1 ? factor(lu, A) : factor_again(lu, A);
  }
  Vector residual() const {
    Vector gap(v.size() + force.size());
    gap << wanted - p - bound.forces * force, bound.rates - bound.J * v;
    return gap;
  }
  Vector solve(const Vector& gap) const { return lu.solve(gap); }
  void apply(const Vector& change, NewtonProgress& at) {
    v += change.head(v.size()), force += change.tail(force.size());
    at.finite = change.allFinite();
    at.take(change.head(v.size()).lpNorm<Eigen::Infinity>(), v.lpNorm<Eigen::Infinity>());
  }
};

/// The velocities v that have the momenta p and keep the bonds; nothing where there are none.
std::optional<Vector> velocities(const LowerSide& side, const BatchDensity& density, const Vector& wanted,
                                 const Bonds& bonds) {
  const BoundRows bound(side.places(), bonds);
  VelocityEquations equations{side, bound, wanted, density.nonlinearity() == Nonlinearity::all};
  NewtonProgress at;
  const Stop stop = newton(equations, at, Overflows{}, Converged{}, Rounding{}, OutOfIterations{most_iterations});
  return has_root(stop) ? std::optional(std::move(equations.v)) : std::nullopt;
}

/// ℓ = θ(φ)·φ_t − H(φ, φ_x)
bool is_linear_in_velocities(const BatchDensity& density) {
  const int d = density.components();
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b)
      if (!density.is_zero(d + a, d + b)) return false;
  return true;
}

}  // namespace

EnergyMomentum semi_discrete_energy(const JetFamily& family, const LatticeSystem& system, const Window& window,
                                    std::int64_t row, std::span<const double> p, const Bonds& bonds) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const LowerSide side(family, system, window, row);
  const Vector wanted = on_unknowns(side, p);
  // p·v − L(y, v) = H(y) at any v where p = θ(y)
  if (is_linear_in_velocities(family.density())) return side.energy(wanted, Vector::Zero(wanted.size()));
  const auto v = velocities(side, family.density(), wanted, bonds);
  if (!v) return {none, none};
  return side.energy(bonds.entries.empty() ? wanted : side.momenta(*v, nullptr), *v);
}

std::vector<double> semi_discrete_rates(const JetFamily& family, const LatticeSystem& system, const Window& window,
                                        std::int64_t row, std::span<const double> p, const Bonds& bonds) {
  const LowerSide side(family, system, window, row);
  std::vector<double> rates(p.size(), 0.0);
  const auto v = velocities(side, family.density(), on_unknowns(side, p), bonds);
  if (!v) std::ranges::fill(rates, std::numeric_limits<double>::quiet_NaN());
  else
    for (Eigen::Index i = 0; i < v->size(); ++i) rates[at(side.places()[static_cast<std::size_t>(i)])] = (*v)[i];
  return rates;
}

}  // namespace delf
