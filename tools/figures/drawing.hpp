// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/figures/figure_form.hpp"

namespace delf {

/// A figure to be drawn.
struct Drawing {
  std::string name;  ///< of its files, without ending
  /// Writes its data into the folder `scratch`, and gives the gnuplot commands, or nothing if there is nothing to show.
  std::function<std::string(const std::filesystem::path& scratch)> body;
};

/// Draws them into `folder`/figures, in all formats of the form. Returns what is missing, in one line, or an empty string: a figure
/// that fails does not fail its command.
std::string draw(const std::vector<Drawing>&, const FigureForm&, const std::filesystem::path& folder);

/// Removes these figures of an earlier run, in any format.
void remove_figures(const std::vector<std::string>& names, const std::filesystem::path& folder);

}  // namespace delf
