// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/methods/moving_parts.hpp"
#include "schemes/solvers/newton.hpp"
#include "schemes/solvers/sparse_lu.hpp"

namespace delf {
namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// G(a(X), X) = 0 on an interval, where a is the profile of the field.
class StartOfMesh {
 public:
  StartOfMesh(const Lattice& lattice, int d, const Profile& profile)
      : N_(lattice.sites()), profile_(profile), point_(delf::at(d)) {}

  /// G at the sites between the walls; its derivatives by their X, and what it gains by φ_t at sites that stand still.
  void evaluate(const MeshMonitor& monitor, const Vector& X, Vector& G, Sparse& by_X, Vector& by_t) {
    using Number = Dual<double, 4>;  // by X of the left, the own and the right site, and by t
    std::vector<std::vector<FieldPoint>> field;
    for (int i = 0; i < N_; ++i) profile_(X[i], point_), field.push_back(point_);
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 1; i + 1 < N_; ++i) {
      std::vector<Number> q;
      for (int l = 0; l < 3; ++l) {
        const int at = i - 1 + l;
        const bool moves = at > 0 && at + 1 < N_;
        for (const FieldPoint& f : field[at]) {
          Number phi(f.phi);
          if (moves) phi.d[l] = f.phi_x, phi.d[3] = f.phi_t;
          q.push_back(phi);
        }
        q.push_back(moves ? Number::variable(X[at], l) : Number(X[at]));
      }
      const Number g = monitor.change(std::span<const Number>(q));
      G[i - 1] = g.value, by_t[i - 1] = g.d[3];
      for (int l = 0; l < 3; ++l)
        if (const int at = i - 1 + l; at > 0 && at + 1 < N_) entries.emplace_back(i - 1, at - 1, g.d[l]);
    }
    by_X.setFromTriplets(entries.begin(), entries.end());
  }

  /// Newton's method from X, which keeps its order; nothing if it does not arrive.
  std::optional<Vector> solve(const MeshMonitor& monitor, const Vector& X) {
    const Eigen::Index n = N_ - 2;
    MeshEquations equations{*this, monitor, X, Vector(n), Vector(n), Sparse(n, n)};
    const auto tangled = [&](const NewtonProgress&) {
      const Vector& Y = equations.X;
      for (int i = 0; i + 1 < N_; ++i)
        if (!(Y[i] < Y[i + 1])) return Stop::tangled;
      return Stop::no;
    };
    NewtonProgress at;
    const Stop stop =
        newton(equations, at, Overflows{}, tangled, Converged{}, Rounding{rounding}, Diverges{}, OutOfIterations{30});
    return has_root(stop) ? std::optional(std::move(equations.X)) : std::nullopt;
  }

 private:
  static constexpr double rounding = 1e-11;  ///< of corrections: the field is steep in narrow cells
  /// G(X) = 0 for the sites between the walls.
  struct MeshEquations {
    StartOfMesh& start;
    const MeshMonitor& monitor;
    Vector X, G, by_t;
    Sparse by_X;
    SparseLU lu = {};

    bool linearise(const NewtonProgress&) {
      start.evaluate(monitor, X, G, by_X, by_t);
      return factor(lu, by_X);
    }
    const Vector& residual() const { return G; }
    Vector solve(const Vector& E) const { return lu.solve(E); }
    void apply(const Vector& change, NewtonProgress& at) {
      X.segment(1, change.size()) -= change;
      at.finite = change.allFinite();
      at.take(change.lpNorm<Eigen::Infinity>(), X.lpNorm<Eigen::Infinity>());
    }
  };

  int N_;
  const Profile& profile_;
  std::vector<FieldPoint> point_;
};

}  // namespace

MovingSites place_moving_sites(const MeshMonitor& monitor, const Lattice& lattice, int d, const Profile& profile) {
  const int N = lattice.sites();
  StartOfMesh placement(lattice, d, profile);
  Vector X(N);
  for (int i = 0; i < N; ++i) X[i] = lattice.position(i);
  MeshMonitor weaker = monitor;
  constexpr double least = 1. / 4096;
  double strength = 0, stride = 0.25;
  while (strength < 1) {
    const double next = std::min(1.0, strength + stride);
    weaker.strength = next;
    if (const auto found = placement.solve(weaker, X)) {
      X = *found, strength = next, stride *= 2;
      continue;
    }
    stride /= 2;
    if (stride < least)
      throw NoConvergence(
          fmt::format("the mesh of row 0 was not found: from the uniform mesh it can be followed to "
                      "{:.3g} of the strength of mesh.monitor; reduce mesh.alpha, or raise lattice.sites",
                      strength));
  }
  // 0 = Dg·(ẏ, Ẋ) with ẏ = φ_t + φ_x Ẋ, (167)
  const Eigen::Index n = N - 2;
  Vector G(n), by_t(n), rates = Vector::Zero(N);
  Sparse by_X(n, n);
  placement.evaluate(monitor, X, G, by_X, by_t);
  SparseLU lu;
  const bool regular = n == 0 || factor(lu, by_X);
  if (n > 0 && regular) rates.segment(1, n) = lu.solve(-by_t);
  if (!regular || !rates.allFinite())
    throw NoConvergence(
        "the rates of the mesh at row 0 were not found: its constraint is singular there; change mesh.alpha");
  return {{X.begin(), X.end()}, {rates.begin(), rates.end()}};
}

}  // namespace delf
