// SPDX-License-Identifier: MIT
#include "schemes/system/legendre.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/index.hpp"
#include "schemes/families/mesh_constraint.hpp"
#include "schemes/solvers/newton.hpp"
#include "schemes/solvers/sparse_lu.hpp"
#include "schemes/system/end_work.hpp"

namespace delf {
namespace {

constexpr int most_iterations = 50;

/// The values whose equations a family keeps among the fields of a row alone: multipliers, or what is slaved.
std::vector<int> equations_in_row(const StencilFamily& family, const LatticeSystem& system) {
  std::vector<int> equations;
  for (int i = 0; i < family.size(); ++i) {
    const Component& c = system.component(family.values()[i].component);
    if (family.site(i).time != 0 || c.at.time != 0 || c.momentum) return {};
    const bool keeps = c.role == Role::multiplier || c.role == Role::slaved;
    if (c.role != Role::field && !c.position && c.role != Role::multiplier) return {};
    if (keeps && family.is_varied(i)) equations.push_back(i);
  }
  return equations;
}

}  // namespace

/// ∂G/∂y over the unknowns, and the forces that go with it, one column for each bond.
struct LegendreTransform::BoundRows {
  Sparse J, forces;
  Vector rates;

  BoundRows(const std::vector<int>& places, const Bonds& bonds) {
    std::map<int, int> number, bond;
    for (std::size_t i = 0; i < places.size(); ++i) number[places[i]] = static_cast<int>(i);
    std::vector<Eigen::Triplet<double>> equations, reactions;
    for (const MatrixEntry& e : bonds.entries) {
      const auto own = number.find(e.row), column = number.find(e.column);
      if (column == number.end() || (bonds.slaved && own == number.end())) continue;
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

LegendreTransform::LegendreTransform(const LatticeSystem& system, const Window& window, std::int64_t row)
    : k_(system.lattice().space_step()),
      t_(system.times()->time(row)),
      size_(at(system.lattice().sites() * system.components())) {
  std::vector<int> number(size_, -1);
  for (const auto& [column, end] : driven_ends(system))
    for (int c = 0; c < system.components(); ++c)
      if (system.component(c).role == Role::field && is_given(system, column, c, *end)) {
        driven_.push_back(column * system.components() + c);
        rates_.push_back(end->rate(system.component(c).field, t_, 0, 0));
        number[driven_.back()] = -1 - static_cast<int>(driven_.size());
      }
  for (const auto& family : system.families()) {
    const DensityOnTable* jets = family->made_of();
    if (jets && !jets->table.lower_side.empty()) add_part(*family, system, window, row, number);
  }
  const MeshConstraint* mesh = find_mesh(system.families());
  if (mesh) add_part(*mesh->row, system, window, row, number);
  if (mesh && mesh->delay > 0) {
    bind_delayed(*mesh, system, window, row);
    return;
  }
  for (const auto& family : system.families())
    for (const int equation : equations_in_row(*family, system)) bind(*family, equation, system, window, row);
}

LegendreTransform::LegendreTransform(const BatchDensity& density, std::span<const double> q, double t)
    : t_(t), size_(q.size()) {
  static const TablePoint point = [] {
    TablePoint one{.slots = {}};
    one.set(JetSlot::phi, {1.0});
    return one;
  }();
  const std::size_t points = q.size() / at(density.components());
  places_.resize(q.size());
  std::iota(places_.begin(), places_.end(), 0);
  parts_.push_back({.density = &density,
                    .points = {&point, 1},
                    .values = density.components(),
                    .unknown = places_,
                    .y = {q.begin(), q.end()},
                    .own = {{std::vector(points, 1.0), std::vector(points, 0.0)}}});
}

void LegendreTransform::add_part(const StencilFamily& family, const LatticeSystem& system, const Window& window,
                                 std::int64_t row, std::vector<int>& number) {
  const auto& [table, density] = *family.made_of();
  const Lattice& lattice = system.lattice();
  const int d = density->components();
  std::vector<Site> vertices;
  for (const Site& v : table.pattern.vertices)
    if (v.time == 0 && table.nodes[v.node].time == 0) vertices.push_back(v);
  Part part{.density = density.get(), .points = table.lower_side, .values = static_cast<int>(vertices.size()) * d};
  part.own.resize(table.lower_side.size());
  // A broken element has nodes of its own at τ = 0, which the lower side does not read.
  std::vector<bool> moves(vertices.size(), false);
  for (const TablePoint& point : table.lower_side)
    for (const auto& [vertex, weight] : point[JetSlot::phi]) moves[vertex] = true;
  for (int cell = 0; cell < system.anchors(family); ++cell) {
    if (!system.has_stencil(family, row, cell)) continue;
    for (std::size_t q = 0; q < part.own.size(); ++q) {
      const TablePoint& point = table.lower_side[q];
      part.own[q].weight.push_back(point.weight * family.own_number(point.own.weight, cell));
      part.own[q].x.push_back(point.own.place < 0 ? lattice.position(cell) + point.space * k_
                                                  : family.own_number(point.own.place, cell));
    }
    for (std::size_t n = 0; n < vertices.size(); ++n)
      for (int a = 0; a < d; ++a) {
        const Site& v = vertices[n];
        const int x = family.listed() ? family.listed()->site(cell, v.space) : cell + v.space;
        const int c = v.node * d + a, home = lattice.home(x), place = home * system.components() + c;
        part.y.push_back(window(row, x, c));
        if (moves[n] && !system.is_held(home, c) && number[place] < 0) {
          number[place] = static_cast<int>(places_.size());
          places_.push_back(place);
        }
        part.unknown.push_back(number[place]);
      }
  }
  if (!part.y.empty()) parts_.push_back(std::move(part));
}

/// Σ ∂G/∂y v = 0
void LegendreTransform::bind(const StencilFamily& family, int equation, const LatticeSystem& system,
                             const Window& window, std::int64_t row) {
  const int C = system.components();
  const auto component = [&](int m) { return family.values()[m].component; };
  bonds_.slaved = system.component(component(equation)).role == Role::slaved;
  std::vector<double> y(family.size()), J(y.size());
  for (int i = 0; i < system.lattice().sites(); ++i) {
    if (!system.has_stencil(family, row, i)) continue;
    const auto place = [&](int m) { return i + family.site(m).space; };
    for (int m = 0; m < family.size(); ++m) y[m] = window(row, place(m), component(m));
    family.jacobian_row(equation, {system.time_step(), k_, t_, system.lattice().position(i)}, y, J);
    for (int m = 0; m < family.size(); ++m)
      if (system.component(component(m)).role != Role::multiplier && J[m] != 0) {
        const int own = place(equation) * C + component(equation),
                  other = system.lattice().home(place(m)) * C + component(m);
        bonds_.entries.push_back({own, other, J[m]});
        if (const auto driven = std::ranges::find(driven_, other); driven != driven_.end())
          bonds_.rates[own] -= J[m] * rates_[at(driven - driven_.begin())];
      }
  }
}

/// Ẋ = G/τ
void LegendreTransform::bind_delayed(const MeshConstraint& mesh, const LatticeSystem& system, const Window& window,
                                     std::int64_t row) {
  const int d = mesh.d, C = system.components();
  bonds_.slaved = system.component(d).role == Role::slaved;
  const auto q = [&](int i) {
    std::vector<double> values;
    for (int c = 0; c <= d; ++c) values.push_back(window(row, i, c));
    return values;
  };
  for (int i = 1; i + 1 < system.lattice().sites(); ++i) {
    const std::vector<double> left = q(i - 1), centre = q(i), right = q(i + 1);
    bonds_.entries.push_back({i * C + d, i * C + d, 1});
    bonds_.rates[i * C + d] = mesh.monitor.change<double>(left, centre, right) / mesh.delay;
  }
}

/// The jets of all cells at each point, with the density's gradient and value.
template <class Visit>
void LegendreTransform::each_point(const Part& part, const Vector& v, const Visit& visit) const {
  const int d = part.density->components(), m = part.density->variables(), values = part.values;
  const int cells = part.cells(), padded = (cells + lanes - 1) / lanes * lanes;
  const ScratchRows jet(m + 1, padded), g(m + 1, padded);
  for (std::size_t q = 0; q < part.points.size(); ++q) {
    const TablePoint& point = part.points[q];
    for (int i = 0; i < m; ++i) std::fill_n(jet[i], padded, 0.0);
    for (int cell = 0; cell < padded; ++cell) {
      const int from = std::min(cell, cells - 1);  // the last pack is filled up
      for (int a = 0; a < d; ++a) {
        for (const auto& [b, weight] : point[JetSlot::phi]) {
          jet[a][cell] += weight * part.y[from * values + b * d + a];
          if (const int n = part.unknown[from * values + b * d + a]; n != -1)
            jet[d + a][cell] += weight * (n >= 0 ? v[n] : rates_[at(-2 - n)]);
        }
        for (const auto& [b, weight] : point[JetSlot::phi_x])
          jet[2 * d + a][cell] += weight / k_ * part.y[from * values + b * d + a];
      }
      jet[m][cell] = part.own[q].x[from];
    }
    const JetBatch jets{padded, jet.data(), t_, jet[m]};
    part.density->gradient(jets, g.data(), g[m]);
    visit(point, part.own[q].weight, jets, g.data(), g[m]);
  }
}

LegendreTransform::Vector LegendreTransform::momenta(const Vector& v, Sparse* mass) const {
  Vector p = Vector::Zero(v.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const Part& part : parts_) {
    const BatchDensity& density = *part.density;
    const int d = density.components(), m = density.variables();
    const auto unknown = [&](int cell, int vertex, int a) { return part.unknown[cell * part.values + vertex * d + a]; };
    each_point(part, v,
               [&](const TablePoint& point, const std::vector<double>& weights, const JetBatch& jets, double* const* g,
                   const double*) {
                 const ScratchRows H(mass ? m * m : 0, jets.count);
                 if (mass) density.hessian(jets, H.data());
                 for (int cell = 0; cell < part.cells(); ++cell) {
                   const double weight = k_ * weights[cell];
                   for (const auto& [b, left] : point[JetSlot::phi])
                     for (int a = 0; a < d; ++a) {
                       const int row = unknown(cell, b, a);
                       if (row < 0) continue;
                       p[row] += weight * left * g[d + a][cell];
                       if (!mass) continue;
                       for (const auto& [c, right] : point[JetSlot::phi])
                         for (int e = 0; e < d; ++e)
                           if (const int column = unknown(cell, c, e); column >= 0 && !density.is_zero(d + a, d + e))
                             entries.emplace_back(row, column, weight * left * right * H[(d + a) * m + d + e][cell]);
                     }
                 }
               });
  }
  if (mass) {
    mass->resize(v.size(), v.size());
    mass->setFromTriplets(entries.begin(), entries.end());
  }
  return p;
}

/// p − ∂L/∂v(v) − C μ = 0 and r − J v = 0 for the velocities v and the forces μ.
struct LegendreTransform::VelocityEquations {
  const LegendreTransform& row;
  const BoundRows& bound;
  const Vector& wanted;
  bool varies;  ///< the mass, with v
  Vector v = Vector::Zero(wanted.size()), force = Vector::Zero(bound.J.rows());
  Vector p = {};
  Sparse mass = {};
  SparseLU lu = {};

  bool linearise(const NewtonProgress& at) {
    const bool fresh = varies || at.iteration == 1;
    p = row.momenta(v, fresh ? &mass : nullptr);
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

std::optional<LegendreTransform::Vector> LegendreTransform::velocities(const Vector& wanted) const {
  const BoundRows bound(places_, bonds_);
  const bool varies =
      std::ranges::any_of(parts_, [](const Part& p) { return p.density->nonlinearity() == Nonlinearity::all; });
  VelocityEquations equations{*this, bound, wanted, varies};
  NewtonProgress at;
  const Stop stop = newton(equations, at, Overflows{}, Converged{}, Rounding{}, OutOfIterations{most_iterations});
  return has_root(stop) ? std::optional(std::move(equations.v)) : std::nullopt;
}

/// ℓ = θ(φ)·φ_t − H(φ, φ_x)
bool LegendreTransform::is_linear() const {
  return std::ranges::all_of(parts_, [](const Part& part) {
    const int d = part.density->components();
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b)
        if (!part.density->is_zero(d + a, d + b)) return false;
    return true;
  });
}

LegendreTransform::Vector LegendreTransform::on_unknowns(std::span<const double> row) const {
  Vector own(static_cast<Eigen::Index>(places_.size()));
  for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = row[places_[i]];
  return own;
}
std::vector<double> LegendreTransform::on_row(const Vector& own) const {
  std::vector<double> row(size_, 0.0);
  for (Eigen::Index i = 0; i < own.size(); ++i) row[places_[i]] = own[i];
  return row;
}

std::vector<double> LegendreTransform::momenta(std::span<const double> v) const {
  return on_row(momenta(on_unknowns(v), nullptr));
}
std::optional<std::vector<double>> LegendreTransform::velocities(std::span<const double> p) const {
  const auto v = velocities(on_unknowns(p));
  return v ? std::optional(on_row(*v)) : std::nullopt;
}

double LegendreTransform::given_at(const Vector& v) const {
  double sum = 0;
  if (driven_.empty()) return sum;
  for (const Part& part : parts_) {
    const int d = part.density->components();
    each_point(part, v,
               [&](const TablePoint& point, const std::vector<double>& weights, const JetBatch&, double* const* g,
                   const double*) {
                 for (int cell = 0; cell < part.cells(); ++cell)
                   for (const auto& [b, weight] : point[JetSlot::phi])
                     for (int a = 0; a < d; ++a)
                       if (const int n = part.unknown[cell * part.values + b * d + a]; n <= -2)
                         sum += k_ * weights[cell] * weight * g[d + a][cell] * rates_[at(-2 - n)];
               });
  }
  return sum;
}

double LegendreTransform::work_in_row(std::span<const double> below) const {
  Vector v = Vector::Zero(static_cast<Eigen::Index>(places_.size()));
  if (!is_linear()) {
    const auto found = velocities(on_unknowns(below));
    if (!found) return std::numeric_limits<double>::quiet_NaN();
    v = *found;
  }
  double work = given_at(v);
  for (std::size_t n = 0; n < driven_.size(); ++n) work -= below[at(driven_[n])] * rates_[n];
  return work;
}

EnergyMomentum LegendreTransform::energy(std::span<const double> given) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Vector p = on_unknowns(given), v = Vector::Zero(p.size());
  // p·v − L(y, v) = H(y) at any v where p = θ(y)
  if (!is_linear()) {
    const auto found = velocities(p);
    if (!found) return {none, none};
    v = *found;
    if (!bonds_.entries.empty()) p = momenta(v, nullptr);
  }
  EnergyMomentum sum{p.dot(v) + given_at(v), 0};
  for (const Part& part : parts_) {
    const int d = part.density->components();
    each_point(part, v,
               [&](const TablePoint&, const std::vector<double>& weights, const JetBatch& jets, double* const* g,
                   const double* l) {
                 for (int cell = 0; cell < part.cells(); ++cell) {
                   const double weight = k_ * weights[cell];
                   sum.energy -= weight * l[cell];
                   for (int a = 0; a < d; ++a) sum.momentum -= weight * jets.slots[2 * d + a][cell] * g[d + a][cell];
                 }
               });
  }
  return sum;
}

std::optional<std::vector<double>> velocity_of(const BatchDensity& density, std::span<const double> q,
                                               std::span<const double> p, double t) {
  return LegendreTransform(density, q, t).velocities(p);
}

double hamiltonian(const BatchDensity& density, std::span<const double> q, std::span<const double> p, double t) {
  const LegendreTransform at_point(density, q, t);
  return at_point.velocities(p) ? at_point.energy(p).energy : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace delf
