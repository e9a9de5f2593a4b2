// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/stepping/evolution.hpp"

namespace delf {

/// Structural rank is not numerical rank: each equation of a slab may have an unknown of its own, and the Jacobian be
/// singular at every state, as that of y_i + y_{i+1} = r_i on a circle of an even number of sites. Throws BadInput that
/// names values which no equation determines, if rows have no constant part to iterate with and the Jacobian is singular at
/// random states. Checks that take no step do not ask.
void require_determined(const Evolution&);

}  // namespace delf
