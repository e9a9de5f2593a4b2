// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/batch_density.hpp"

namespace delf {

/// The direction in which ∂²ℓ/∂φ_t∂φ_t is singular at the first site of a row at rest, in words: "the density has no
/// inertia along (e0, e1) = (1, 0)". Empty if there is none, and for one field, as of KdV.
std::string without_inertia(const BatchDensity&, const std::vector<std::string>& fields,
                            const std::vector<double>& row);

}  // namespace delf
