// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The number of times that source terms, the nonlinear part of ∂ℓ/∂φ, are evaluated at each site for a row: in an
/// explicit step, or in one iteration of an implicit one. Terms that are the same but for a shift along the lattice are
/// evaluated once, and a brick wall has half as many stencils as sites. Not a number for equations without source terms
/// of that form: linear ones, and those that are nonlinear in derivatives.
double forces_in_a_pass(const LatticeSystem&);

}  // namespace delf
