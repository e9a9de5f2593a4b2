// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "jets/batch_density.hpp"

namespace delf {

/// ∂ℓ/∂(variable) at one jet, whose variables are in the order of a JetBatch.
std::vector<double> gradient_at(const BatchDensity&, std::span<const double> jet, double t, double x);
/// ∂²ℓ/∂a∂b at one jet, [a·variables + b].
std::vector<double> hessian_at(const BatchDensity&, std::span<const double> jet, double t, double x);

}  // namespace delf
