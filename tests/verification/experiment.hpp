// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tests/row_distance.hpp"

namespace delf::testing {

/// A stencil or, where the method is a comparator, the scheme that has no Lagrangian.
struct SchemeName {
  std::string stencil, method = "multisymplectic";

  std::string text() const { return method == "multisymplectic" ? stencil : method; }
};

/// (5.8), (5.10), (5.12), (5.14), (5.15): the order in which the reference values list them.
inline const std::vector<SchemeName> paper_schemes{
    {"triangle"}, {"rectangle"}, {"rectangle-symmetric"}, {"", "vu-quoc-li"}, {"", "guo"}};
inline const std::vector<SchemeName> variational_schemes{
    {"triangle"}, {"triangle-vertex"}, {"rectangle"}, {"rectangle-symmetric"},
    {"hexagon"},  {"six-tuple"},       {"nine-tuple"}};
inline const std::vector<SchemeName> comparators{{"", "vu-quoc-li"}, {"", "guo"}};
inline const std::vector<SchemeName> all_schemes = [] {
  std::vector<SchemeName> all = variational_schemes;
  all.insert(all.end(), comparators.begin(), comparators.end());
  return all;
}();

inline Problem problem_for(const SchemeName& scheme, const std::string& theory, const Lattice& lattice,
                           double courant) {
  Problem p;
  p.theory = theory, p.stencil = scheme.stencil, p.method = scheme.method;
  p.lattice = lattice, p.time_step = courant * lattice.space_step();
  return p;
}

inline Row values(const State& state, double t, const Lattice& lattice) {
  Row row(at(lattice.sites()));
  state.values(t, lattice, row);
  return row;
}
inline Row velocities(const State& state, double t, const Lattice& lattice) {
  Row row(at(lattice.sites()));
  state.velocities(t, lattice, row);
  return row;
}
inline Row newest(const Simulation& simulation, const Lattice& lattice, int back = 0) {
  Row row(at(lattice.sites()));
  simulation.copy_row(back, row);
  return row;
}

/// How row 1 comes from row 0: φ(h); the field equation at row 0 with y₋₁ = y₁ − 2hφ_t; or y₁ = y₀ + hφ_t, Euler's,
/// which is wrong by ½h²φ_tt and so of first order at the end.
enum class Start { exact, centred, euler };

inline void start(Simulation& simulation, const Problem& p, const State& state, Start how) {
  const Row y0 = values(state, 0, p.lattice), rate = velocities(state, 0, p.lattice);
  if (how == Start::centred) return simulation.start_centred(y0, rate);
  Row y1 = values(state, p.time_step, p.lattice);
  if (how == Start::euler)
    for (std::size_t i = 0; i < y1.size(); ++i) y1[i] = y0[i] + p.time_step * rate[i];
  simulation.start({y0, y1});
}

/// Runs to row `steps`.
inline Simulation run(const Problem& p, const State& state, int steps, Start how = Start::exact) {
  Simulation simulation(p);
  start(simulation, p, state, how);
  while (simulation.newest() < steps) simulation.step();
  return simulation;
}

/// max_i |y_i − φ(T, x_i)| at T = steps · h.
inline double final_error(const Problem& p, const State& state, int steps, Start how = Start::exact) {
  const Simulation simulation = run(p, state, steps, how);
  return distance(newest(simulation, p.lattice), values(state, steps * p.time_step, p.lattice));
}

/// The slope of log error against log k through two resolutions.
inline double order(double coarse_error, double fine_error, double ratio) {
  return std::log(coarse_error / fine_error) / std::log(ratio);
}

}  // namespace delf::testing
