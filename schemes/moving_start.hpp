// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <span>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"

namespace delf {

/// The field and its first derivatives at any point of row 0.
using StartField = std::function<void(double x, std::span<FieldPoint>)>;

/// True if the sites of a simulation move, and its method knows where they start.
bool starts_by_sites(const Simulation&, const Problem&);
/// Starts it from a field: sites and their rates where the method puts them, φ_t + φ_x X_t as rates of the field there, and
/// row 1 by the discrete Legendre transform. Throws NoConvergence where there is no such mesh.
void start_by_sites(Simulation&, const Problem&, const StartField&);

}  // namespace delf
