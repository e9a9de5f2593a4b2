// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

namespace delf {

// Values modulo 2π, each taken within π of the one before it.

/// Unwraps in time, after the row before.
void unwrap_after(const std::vector<double>& before, std::vector<double>& row);
/// Unwraps in space, each of the components after the site before.
void unwrap_along(std::vector<double>& row, int components);
/// Moves a row, all sites alike, by the multiple of 2π that brings each component at the first site next to `first`.
void unwrap_to(std::span<const double> first, std::vector<double>& row);
/// The gain of an unwrapped row around the circle: a multiple of 2π.
double monodromy_of_row(const std::vector<double>& row, int components);

}  // namespace delf
