// SPDX-License-Identifier: MIT
#pragma once
#include <span>

#include "jets/batch_density.hpp"
#include "jets/tables/mirror_table.hpp"

namespace delf {

/// True if a density allows mirror images beyond a wall (mirror_table), at random jets and to 1e-6:
/// ℓ(φ, φ_t, −φ_x) = ℓ(φ, φ_t, φ_x), and ℓ(2φ_wall − φ, φ_t, φ_x) = ℓ(φ, φ_t, φ_x) if the image is odd about φ_wall.
bool has_mirror_images(const BatchDensity&, Mirror, std::span<const double> wall);

}  // namespace delf
