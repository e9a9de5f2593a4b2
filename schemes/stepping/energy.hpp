// SPDX-License-Identifier: MIT
#pragma once
#include "jets/batch_density.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "schemes/system/cell_jet.hpp"
#include "schemes/system/energy_momentum.hpp"

namespace delf {

/// Two rows j and j + 1 of a section in the lanes' layout, with the pack after the end.
struct RowPair {
  const RowLayout* layout;
  const double* const* rows;  ///< the d rows y_j, the d rows y_{j+1}, and d rows of v = y_{j+1} − y_j without rounding
  const double* positions;    ///< x of each slot's site; null unless the density is placed
  double t;                   ///< of row j
  double time_step, space_step;
};

/// The definition of a run's energy, in one line, for whoever reads a number or a figure.
inline constexpr const char* energy_formula =
    "k Σ (φ_t ∂ℓ/∂φ_t − ℓ), jets of the symmetric rectangle on the last two rows, whatever the scheme; order 2 in h "
    "and k";

/// Energy and momentum between two rows, over the symmetric rectangle's jets whatever the scheme,
///
///   H = k Σ (φ_t ∂ℓ/∂φ_t − ℓ)                 P = −k Σ φ_x ∂ℓ/∂φ_t
///
/// For sine-Gordon H is k times the sum of Marsden–Patrick–Shkoller's footnote 4. The lattice breaks the symmetries
/// behind both: they are measured, not conserved. cells[slot]: 1 for each slot that is the left end of a cell, else 0.
EnergyMomentum energy_momentum(const BatchDensity&, const RowPair&, const double* cells);

/// Energy and momentum site by site, for densities of second order too (StressEnergy defines it). `jets` are of this
/// lattice; rows [i·d + a]; t: between them.
EnergyMomentum energy_momentum(const BatchDensity&, const Lattice&, CellJets& jets, std::span<const double> below,
                               std::span<const double> above, double t);

}  // namespace delf
