// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "jets/batch_density.hpp"
#include "schemes/complex/stencil_list.hpp"

namespace delf {

/// The energy between two rows, at the time of the later one.
struct SlabEnergy {
  double time = 0, energy = 0;
};

/// Of a finite complex in t and x whose sites lie in rows, as many in each: between rows at t and t + h, as on a lattice,
///
///     E = Σ_cells |D| (φ_t ∂ℓ/∂φ_t − ℓ)/h
///
/// on the symmetric rectangle's jets of the cells that the rows span, whatever the stencils are. Of any other complex there is no
/// slab to sum over, and nothing is returned.
std::vector<SlabEnergy> slab_energies(const StencilList&, const std::shared_ptr<const BatchDensity>&,
                                      std::span<const double> y);

}  // namespace delf
