// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "jets/batch_density.hpp"
#include "jets/tables/mirror_table.hpp"

namespace delf {

/// Whether a density is what mirror images beyond a wall ask for (mirror_table), at random jets and to 1e-6: ℓ(φ, φ_t, −φ_x) = ℓ(φ, φ_t, φ_x),
/// and, where the image is odd about the wall's value, ℓ(2φ_wall − φ, φ_t, φ_x) = ℓ(φ, φ_t, φ_x).
bool has_mirror_images(const BatchDensity&, Mirror, std::span<const double> wall);

}  // namespace delf
