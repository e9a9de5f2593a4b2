// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Throws BadInput, "theory.name", if the densities of a system give a field no kinetic term: a field, coupled to
/// others or not, none of which enters the field equations by a derivative in time. On a stencil its next row would still
/// occur, by averages of rows, and steps would amplify whatever they start from.
void require_time_derivative(const LatticeSystem&);

}  // namespace delf
