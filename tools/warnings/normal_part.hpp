// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "schemes/theories/field_theory.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

/// "initial.p = 1, 0.3, 0: its part (1, 0, 0) is normal to the constraint ...": what a start on a point loses, since
///
///     ∂G/∂q v = 0,    p → p − Σ_m (p, e_m) e_m,    (p, e) = p M⁻¹ e,
///
/// with gradients ∂G_m/∂q made orthonormal in that product. Empty where all of it is along the surface.
std::string normal_part(const Scene&, const InitialRows&, const FieldTheory&);

}  // namespace delf
