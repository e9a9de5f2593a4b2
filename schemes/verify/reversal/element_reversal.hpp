// SPDX-License-Identifier: MIT
#pragma once

namespace delf {

class LatticeSystem;

/// True if a scheme of elements in time is its own inverse: its densities are even in φ_t and φ_tx, and its quadrature
/// points and the nodes that constraints hold are the same seen from the end of the cell. (Polynomials and uniform splines are.)
/// Densities that read t are seen with T − t in its place. False too for families that are neither elements nor
/// constraints.
bool reversible_elements(const LatticeSystem&);

}  // namespace delf
