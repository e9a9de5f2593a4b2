// SPDX-License-Identifier: MIT
#pragma once
#include <random>
#include <span>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// The form that steps of different lengths keep. Rows at times t_0 < … < t_n have the discrete Lagrangians L_k of the step
/// from row k − 1 to row k, and with θ⁺_k = ∂L_k/∂y^k δy^k and F_k, which maps rows (0, 1) to rows (k − 1, k),
///
///     F_k* dθ⁺_1 = dθ⁺_k,    and F_k* dθ⁺_1 = dθ⁺_1 where L_k = L_1,         Marsden–Patrick–Shkoller (6.6)
///
/// that is, one 2-form is kept if the last step is as long as the first. Here V and W solve the equations of rows 1 to n − 1
/// linearised at the rows y, from random values in rows 0 and 1, whatever y is, and the sum is
///
///     dθ⁺_1(V, W) of the first step's Lagrangian at rows (n − 1, n), less the same at rows (0, 1).
///
/// The system is one whose equations join consecutive rows, with the families and the components of the given one. The lengths
/// are data: where the field chooses them they are not varied. `fault`: V is broken in its last row.
Balance form_of_first_step(const LatticeSystem&, std::span<const double> times, std::vector<std::vector<double>> y,
                           std::mt19937_64&, bool fault = false);

}  // namespace delf
