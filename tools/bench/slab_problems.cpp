// SPDX-License-Identifier: MIT
#include "tools/bench/slab_problems.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "schemes/state.hpp"

namespace delf::bench {
namespace {

/// The place at which f changes its sign between `low` and `high`, to the last bit.
template <class F>
double root_of(const F& f, double low, double high) {
  const bool sign = f(low) > 0;
  for (int halves = 0; halves < 60; ++halves) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0) == sign ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// (φ, X, 0) at nodes 0 … n + 1 on the kink at a time, with equal α²Δφ² + ΔX².
std::vector<double> equidistributed(int n, double t) {
  using M = MovingMesh;
  const auto kink = [t](double x) {
    if (x <= 0) return 0.0;
    if (x >= M::length) return 2 * std::numbers::pi;
    const double s = (x - M::length / 2 - M::velocity * t) / std::sqrt(1 - M::velocity * M::velocity);
    return 4 * std::atan(std::exp(s));
  };
  const auto next = [&](double x, double chord) {
    const auto beyond = [&](double z) { return std::hypot(M::alpha * (kink(z) - kink(x)), z - x) - chord; };
    return root_of(beyond, x, x + chord);
  };
  const auto end = [&](double chord) {
    double x = 0;
    for (int i = 0; i <= n; ++i) x = next(x, chord);
    return x - M::length;
  };
  const double chord = root_of(end, 0, 3 * M::length / (n + 1));
  std::vector<double> row;
  double x = 0;
  for (int i = 0; i <= n + 1; ++i) {
    if (i > n) x = M::length;
    for (const double value : {kink(x), x, 0.0}) row.push_back(value);
    if (i < n) x = next(x, chord);
  }
  return row;
}

Problem problem_of(const std::string& theory, const Lattice& lattice, double time_step, double tolerance) {
  Problem problem;
  problem.theory = theory, problem.lattice = lattice, problem.time_step = time_step, problem.tolerance = tolerance;
  return problem;
}

TwoRows rows_of(const StateRequest& request, const Lattice& lattice, double time_step, int components, int in_row) {
  const auto state = make_state(request, lattice);
  TwoRows rows(2);
  for (int r = 0; r < 2; ++r) {
    std::vector<double> fields(lattice.sites() * components);
    state->values(r * time_step, lattice, fields);
    rows[r].assign(lattice.sites() * in_row, 0.0);
    for (int i = 0; i < lattice.sites(); ++i)
      for (int a = 0; a < components; ++a) rows[r][i * in_row + a] = fields[i * components + a];
  }
  return rows;
}

/// The engine's tolerance is relative to the largest |y|, that of a packed slab is not.
double absolute(double tolerance, const TwoRows& rows) { return tolerance * std::ranges::max(rows[1]); }

}  // namespace

Problem MovingMesh::problem() const {
  Problem problem = problem_of("sine-gordon", Lattice::interval(nodes + 2, length), time_step, tolerance);
  problem.method = "r-adaptive";
  problem.parameters["mesh.alpha"] = alpha;
  return problem;
}
TwoRows MovingMesh::rows() const { return {equidistributed(nodes, 0), equidistributed(nodes, time_step)}; }
std::shared_ptr<PackedSlab<PackedMovingMesh>> MovingMesh::by_hand(bool keeps_jacobian) const {
  return std::make_shared<PackedSlab<PackedMovingMesh>>(PackedLine{nodes + 2, false}, absolute(tolerance, rows()),
                                                        keeps_jacobian, PackedMovingMesh::Rectangle{time_step},
                                                        PackedMovingMesh::Arclength{alpha});
}

Lattice WaveMapOnCircle::lattice() const { return Lattice::circle(sites, 2 * std::numbers::pi); }
Problem WaveMapOnCircle::problem() const {
  Problem problem = problem_of("wave-map", lattice(), time_step(), tolerance);
  problem.stencil = "rectangle";
  return problem;
}
TwoRows WaveMapOnCircle::rows() const {
  return rows_of({.name = "great-circle", .theory = "wave-map", .components = 3, .fields = {"u1", "u2", "u3"}},
                 lattice(), time_step(), 3, 4);
}
std::shared_ptr<PackedSlab<PackedWaveMap>> WaveMapOnCircle::by_hand(bool keeps_jacobian) const {
  return std::make_shared<PackedSlab<PackedWaveMap>>(
      PackedLine{sites, true}, absolute(tolerance, rows()), keeps_jacobian,
      PackedWaveMap::Rectangle{time_step(), lattice().space_step()}, PackedWaveMap::Sphere{});
}

Problem SpacetimeBreather::problem() const {
  Problem problem = problem_of("sine-gordon", Lattice::circle(cells, length), time_step, tolerance);
  problem.method = "spacetime";
  problem.parameters["scheme.degree_time"] = problem.parameters["scheme.degree_space"] = 2;
  problem.parameters["scheme.quadrature"] = "gauss";
  return problem;
}
std::vector<double> SpacetimeBreather::phi() const {
  std::vector<double> values;
  for (int i = 0; i < 2 * cells; ++i)
    values.push_back(4 * std::atan(0.8 / 0.6 / std::cosh(0.8 * (0.5 * i * space_step() - length / 2))));
  return values;
}

Problem Mechanics::problem() const {
  Problem problem = problem_of(theory, Lattice::point(), time_step, tolerance);
  if (!stencil.empty()) problem.stencil = stencil;
  return problem;
}
Problem Mechanics::gauss(int points) const {
  Problem problem = Mechanics::problem();
  problem.method = "cgvi";
  problem.parameters["scheme.basis"] = "lagrange-lobatto";
  problem.parameters["scheme.functions"] = points + 1;
  problem.parameters["scheme.quadrature"] = "gauss";
  problem.parameters["scheme.points"] = points;
  problem.parameters["scheme.continuity"] = "shared";
  return problem;
}
TwoRows Mechanics::rows(const std::string& state) const {
  const int d = static_cast<int>(fields.size());
  StateRequest request{.name = state, .theory = theory, .components = d};
  request.fields = fields;
  if (d == 2) request.values["initial.eccentricity"] = 0.6;
  else request.values["initial.amplitude"] = 2.0;
  return rows_of(request, Lattice::point(), time_step, d, d);
}

}  // namespace delf::bench
