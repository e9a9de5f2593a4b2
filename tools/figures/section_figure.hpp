// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

#include "tools/figures/figures.hpp"

namespace delf {

/// The points of a Poincaré section, a momentum over its coordinate. Empty where there are none.
std::string section_figure(const FigureSource&, const std::filesystem::path& scratch);

}  // namespace delf
