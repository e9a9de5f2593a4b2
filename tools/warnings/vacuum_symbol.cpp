// SPDX-License-Identifier: MIT
#include "tools/warnings/vacuum_symbol.hpp"

#include <algorithm>
#include <cmath>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {
namespace {

constexpr int most_components = 12;

// −∂²ℓ/∂φᵃ∂φᵇ is positive by the sums of its rows.
bool is_stable(const BatchDensity& density, double vacuum) {
  const int d = density.components();
  const ScratchRows phi(d, lanes), curvature(d * d, lanes);
  for (int a = 0; a < d; ++a) std::fill_n(phi[a], lanes, vacuum);
  density.curvature({lanes, phi.data()}, curvature.data());
  for (int a = 0; a < d; ++a) {
    double least = -curvature[a * d + a][0];
    for (int b = 0; b < d; ++b)
      if (b != a) least -= std::abs(curvature[a * d + b][0]);
    if (!(least >= 0)) return false;
  }
  return true;
}

}  // namespace

bool zero_is_a_solution(const BatchDensity& density) {
  const int d = density.components();
  const ScratchRows phi(d, lanes), slope(d, lanes);
  for (int a = 0; a < d; ++a) std::fill_n(phi[a], lanes, 0.0);
  density.slope({lanes, phi.data()}, slope.data());
  for (int a = 0; a < d; ++a)
    if (slope[a][0] != 0) return false;
  return true;
}

std::optional<double> stable_vacuum(const Scene& scene, const Simulation& simulation) {
  const BatchDensity& density = simulation.theory().density();
  const TheoryEntry& entry = find_theory(scene.problem.theory);
  if (density.is_placed()) return std::nullopt;
  std::optional<double> vacuum = entry.vacuum;
  if (!vacuum && scene.problem.parameters.has("theory.density") && zero_is_a_solution(density)) vacuum = 0;
  return vacuum && is_stable(density, *vacuum) ? vacuum : std::nullopt;
}

std::optional<Symbol> symbol_of(const Scene& scene, const Simulation& simulation) {
  const auto vacuum = stable_vacuum(scene, simulation);
  const LatticeSystem& system = simulation.evolution().system();
  if (!vacuum || system.moves() || system.components() > most_components) return std::nullopt;
  try {
    return Symbol(system, *vacuum);
  } catch (const BadInput&) {  // a scheme that has no symbol
    return std::nullopt;
  }
}

}  // namespace delf
