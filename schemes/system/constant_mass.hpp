// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <optional>

#include "jets/batch_density.hpp"

namespace delf {

/// The mass ∂²ℓ/∂φ_t∂φ_t, d × d, of a density that is proved quadratic in φ_t with constant coefficients; nothing for others.
std::optional<Eigen::MatrixXd> constant_mass(const BatchDensity&);

}  // namespace delf
