// SPDX-License-Identifier: MIT
#include "schemes/system/legendre.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "jets/simd/scratch_rows.hpp"
#include "schemes/solvers/newton.hpp"

namespace delf {
namespace {

constexpr int most_iterations = 50;

/// A jet (q, q̇, 0, …) at x = 0, and what the density makes of it.
class PointJet {
 public:
  PointJet(const BatchDensity& density, std::span<const double> q, double t)
      : density_(density),
        t_(t),
        d_(density.components()),
        m_(density.variables()),
        jet_(m_ + 1, lanes),
        g_(m_ + 1, lanes),
        H_(m_ * m_, lanes) {
    for (int a = 0; a <= m_; ++a) std::fill_n(jet_[a], lanes, 0.0);
    for (int a = 0; a < d_; ++a) std::fill_n(jet_[a], lanes, q[static_cast<std::size_t>(a)]);
  }
  void set_velocity(const Eigen::VectorXd& v) {
    for (int a = 0; a < d_; ++a) std::fill_n(jet_[d_ + a], lanes, v[a]);
  }
  /// ∂ℓ/∂q̇, and ℓ behind it
  Eigen::VectorXd momentum_and_density() {
    density_.gradient(batch(), g_.data(), g_[m_]);
    Eigen::VectorXd p(d_ + 1);
    for (int a = 0; a < d_; ++a) p[a] = g_[d_ + a][0];
    p[d_] = g_[m_][0];
    return p;
  }
  /// ∂²ℓ/∂q̇∂q̇
  Eigen::MatrixXd mass() {
    density_.hessian(batch(), H_.data());
    Eigen::MatrixXd M(d_, d_);
    for (int a = 0; a < d_; ++a)
      for (int b = 0; b < d_; ++b) M(a, b) = H_[(d_ + a) * m_ + d_ + b][0];
    return M;
  }

 private:
  JetBatch batch() const { return {lanes, jet_.data(), t_, jet_[m_]}; }

  const BatchDensity& density_;
  double t_;
  int d_, m_;
  ScratchRows jet_, g_, H_;
};

/// p − ∂ℓ/∂q̇(q, q̇) = 0 for q̇.
struct VelocityEquations {
  PointJet jet;
  Eigen::VectorXd wanted;
  Eigen::VectorXd v = Eigen::VectorXd::Zero(wanted.size());
  Eigen::FullPivLU<Eigen::MatrixXd> mass = {};

  bool linearise(const NewtonProgress&) {
    jet.set_velocity(v);
    mass.compute(jet.mass());
    return mass.isInvertible();
  }
  Eigen::VectorXd residual() { return wanted - jet.momentum_and_density().head(wanted.size()); }
  Eigen::VectorXd solve(const Eigen::VectorXd& gap) const { return mass.solve(gap); }
  void apply(const Eigen::VectorXd& change, NewtonProgress& at) {
    v += change;
    at.finite = change.allFinite();
    at.take(change.lpNorm<Eigen::Infinity>(), v.lpNorm<Eigen::Infinity>());
  }
};

}  // namespace

std::optional<std::vector<double>> velocity_of(const BatchDensity& density, std::span<const double> q,
                                               std::span<const double> p, double t) {
  const int d = density.components();
  VelocityEquations equations{PointJet(density, q, t), Eigen::Map<const Eigen::VectorXd>(p.data(), d)};
  NewtonProgress at;
  const Stop stop = newton(equations, at, Overflows{}, Converged{}, Rounding{}, OutOfIterations{most_iterations});
  if (!has_root(stop)) return std::nullopt;
  return std::vector<double>(equations.v.begin(), equations.v.end());
}

double energy_of(const BatchDensity& density, std::span<const double> q, std::span<const double> velocity, double t) {
  const int d = density.components();
  PointJet jet(density, q, t);
  const Eigen::Map<const Eigen::VectorXd> v(velocity.data(), d);
  jet.set_velocity(v);
  const Eigen::VectorXd at = jet.momentum_and_density();
  return at.head(d).dot(v) - at[d];
}

double hamiltonian(const BatchDensity& density, std::span<const double> q, std::span<const double> p, double t) {
  const auto velocity = velocity_of(density, q, p, t);
  return velocity ? energy_of(density, q, *velocity, t) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace delf
