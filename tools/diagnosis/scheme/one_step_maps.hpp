// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"

namespace delf {

/// A state of all sites: φ and φ_t, [i·C + c].
struct PhasePoint {
  std::vector<double> q, v;
};

/// One time step in (φ, φ_t), of a scheme of the engine or of a method that other programs use.
struct OneStepMap {
  std::string name;  ///< "kick-drift-kick Störmer-Verlet"
  std::string keys;  ///< by which a scene has it; empty: none
  bool symplectic = true;
  std::function<bool(PhasePoint&)> step;  ///< false where it finds no solution
  int steps = 1;                          ///< of the scene's time step that it goes on by
};

/// The explicit scheme of order 2 of the same theory, steps and lattice, whose values are rows of fields.
Problem explicit_scheme(const Problem&);

/// Steps by the acceleration that explicit schemes have of this theory: splittings, kicks or drifts first, and Runge–Kutta
/// methods. On a lattice with D² of each order. Empty for theories whose φ_tt is no function of φ.
std::vector<OneStepMap> steps_by_force(const Problem&);
/// Steps of the engine's elements, which start from momenta.
std::vector<OneStepMap> steps_of_elements(const Problem&);
/// The problem's own, if it is one of these; with the momenta M φ_t.
std::optional<OneStepMap> step_of(const Problem&);

/// ∂L/∂φ_t = M φ_t at the sites, [i·C + c]; empty where steps_by_force() is.
std::vector<double> masses_of(const Problem&);

}  // namespace delf
