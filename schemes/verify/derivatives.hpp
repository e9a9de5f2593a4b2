// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// Differences of eighth order, 10 to 50 seeds at each of k = 1, 0.157 and 0.001, left 8e-14 for most theories on every
/// stencil, 3e-12 where a potential oscillates fast (double sine-Gordon), 8e-12 near the singularity of Kepler's and
/// 2e-11 on a moving mesh, whose Lagrangian has poles: fifty times that.
inline constexpr double derivative_tolerance = 1e-9;

/// Checks that the families generate derivatives: at random jets, somewhere on the lattice, each residual against
/// finite differences of its Lagrangian (where there is one), and each Jacobian against those of its residual. Two
/// checks a family, or one; their values are the largest difference of an entry, relative to the largest |entry| of the
/// gradient, or of the Jacobian, at that jet.
std::vector<Check> check_derivatives(const LatticeSystem&, std::uint64_t seed, double tolerance = derivative_tolerance);

}  // namespace delf
