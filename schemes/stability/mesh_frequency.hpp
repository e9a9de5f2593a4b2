// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The longest step that a small wave can take on a mesh by the usual method, 2/ω of the fastest mode about φ = 0; none if
/// nothing oscillates. With M and K of the linearised equations M y″ + K y = 0 there, ω² is the largest eigenvalue of
/// M^(−1/2) K M^(−1/2), by Lanczos's method (Spectra).
std::optional<double> longest_step(const LatticeSystem&);

}  // namespace delf
