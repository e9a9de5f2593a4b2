// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/figures/figures.hpp"

namespace delf {

/// |φ_k| over the wave number k, of the first and of the last row of a circle, and below it the frequencies of the waves that
/// the lattice has. Returns gnuplot commands; their data is written to `scratch`. Empty where no spectrum is asked for.
std::string spectrum_figure(const FigureSource&, const std::filesystem::path& scratch);

/// |φ_n| of φ_i = Σ_n φ_n e^{2πi n i/N}, n = 0 … N/2; nothing where N has a prime factor too large for it.
std::vector<double> mode_sizes(const std::vector<double>& row);

}  // namespace delf
