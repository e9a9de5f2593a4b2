// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/moving_start.hpp"

/// Runs of sine-Gordon on meshes that move, between walls.
namespace r_adaptive_run {

using namespace delf;
using Row = std::vector<double>;

/// A kink of a velocity in percent in the middle of 0 ≤ x ≤ 25, with the values of the walls there.
template <int percent>
void kink_of(double x, std::span<FieldPoint> out) {
  static const auto state = [] {
    StateRequest request{.name = "kink", .theory = "sine-gordon"};
    request.values["initial.speed"] = percent / 100.0;
    return make_state(request, Lattice::interval(17, 25));
  }();
  state->at(0, x, out);
  if (x == 0) out[0].phi = 0;
  if (x == 25) out[0].phi = 2 * std::numbers::pi;
}
inline constexpr auto kink = kink_of<90>;

inline Problem problem(const std::string& strategy, const std::string& time, int nodes, double alpha = 2.5) {
  Problem p;
  p.method = "r-adaptive", p.lattice = Lattice::interval(nodes + 2, 25), p.time_step = 0.01;
  p.parameters["scheme.strategy"] = strategy, p.parameters["scheme.time"] = time, p.parameters["mesh.alpha"] = alpha;
  return p;
}

inline Simulation started(const Problem& p, const StartField& field) {
  Simulation simulation(p);
  if (starts_by_sites(simulation, p)) {
    start_by_sites(simulation, p, field);
    return simulation;
  }
  std::vector<double> row, rates;  // every node of a cell starts at its vertex
  FieldPoint f;
  for (int i = 0; i < p.lattice.sites(); ++i) {
    field(p.lattice.position(i), {&f, 1});
    row.resize(row.size() + simulation.components().size(), f.phi);
    rates.resize(row.size(), f.phi_t);
  }
  simulation.start_legendre(row, rates);
  return simulation;
}

/// The positions of the sites, or φ, of the newest row.
inline Row values(const Simulation& simulation, int sites, bool positions) {
  const bool slaved = simulation.count(Role::slaved) > 0;
  const Role role = positions && slaved ? Role::slaved : Role::field;
  const std::size_t count = simulation.count(role);
  Row all(delf::at(sites) * count), out;
  simulation.copy_row(0, all, role);
  for (std::size_t at = positions && !slaved ? 1 : 0; at < all.size(); at += count) out.push_back(all[at]);
  return out;
}

inline double distance(const Row& a, const Row& b) {
  double worst = 0;
  for (std::size_t i = 0; i < b.size(); ++i) worst = std::max(worst, std::abs(a.at(i) - b[i]));
  return worst;
}

}  // namespace r_adaptive_run
