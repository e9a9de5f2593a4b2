// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/stability/symbol.hpp"

namespace delf {

/// A wave e^{i(κx + ωt)} on the lattice and in the continuum, ω > 0.
struct DispersionPoint {
  double wave_number;    ///< κk
  double exact;          ///< ωh = h √(m² + κ²)
  double numerical;      ///< ωh = arg z, followed from κ = 0 on, so that it may pass π
  double amplification;  ///< |z|
};

/// The dispersion relation of a scheme of one field, ℓ = ½φ_t² − ½φ_x² − ½m²φ² about the state of the symbol, at
/// `count` wave numbers between 0 and the largest that the nodes resolve, both included: κk = π, or pπ with p nodes
/// in a cell. Of all roots the one is followed whose mode is nearest to a plane wave over the nodes; with p = 4 and
/// more that may be the mirror image of the band below, for the shortest waves (κk > (p − 1)π). Throws BadInput:
/// several fields, mechanics (theory.name).
std::vector<DispersionPoint> dispersion(const Symbol&, double mass, int count = 201);

}  // namespace delf
