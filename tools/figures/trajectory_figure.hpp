// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>

#include "tools/figures/figures.hpp"

namespace delf {

/// The name of a coordinate, q, or q1, q2, … of several, unless the theory has one of its own.
std::string coordinate_name(const FigureSource&, std::size_t component);

/// Mechanics on a point: the coordinates over time. Returns gnuplot commands; their data is written to `scratch`. Empty
/// for a field in space.
std::string trajectory_figure(const FigureSource&, const std::filesystem::path& scratch);
/// The orbit of two coordinates, the second over the first.
std::string orbit_figure(const FigureSource&, const std::filesystem::path& scratch);

}  // namespace delf
