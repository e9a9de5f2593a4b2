// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace delf {

/// A figure to be drawn.
struct Drawing {
  std::string name;  ///< of its files, without ending
  /// Writes its data into the folder `scratch`, and gives the gnuplot commands, or nothing if there is nothing to show.
  std::function<std::string(const std::filesystem::path& scratch)> body;
};

/// Draws them into `folder`/figures, each as PNG and as SVG. Returns what is missing, in one line, or an empty string.
std::string draw(const std::vector<Drawing>&, const std::filesystem::path& folder);

}  // namespace delf
