// SPDX-License-Identifier: MIT
#pragma once
#include <memory>

#include "schemes/complex/complex_system.hpp"
#include "schemes/complex/stencil_list.hpp"

namespace delf {

/// The equations of a density on a list of stencils without faults. Stencils of a shape whose weights vanish at the same
/// places are a family: a lattice's stencils one alone.
///
/// Throws BadInput: "theory.name" for a density that the parts of T + V are not for, and "lattice.mesh" for a stencil without a
/// second derivative that the density reads.
ComplexSystem spacetime_complex(const StencilList&, const std::shared_ptr<const BatchDensity>&);

}  // namespace delf
