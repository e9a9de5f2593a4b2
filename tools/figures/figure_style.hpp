// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <string>

namespace delf {

/// Colours from `least` to `most`: a perceptually even map from dark to light, or from blue through white to red for
/// values of both signs. Both are readable by the colour-blind.
struct ColourScale {
  double least, most;
  bool swings;  ///< about zero
};
/// The scale of some values; the most extreme half per cent are ignored if they would hide the rest.
ColourScale colour_scale(std::span<const double> values);
/// As gnuplot commands.
std::string gnuplot_colours(const ColourScale&);

/// A figure as gnuplot commands: `body` drawn as NAME.png and as NAME.svg, both in one style.
std::string figure_script(const std::string& name, const std::string& body);

/// A title at the top left, and a quieter line below it.
std::string figure_title(const std::string& title, const std::string& subtitle);

/// A round distance between at most `most` tics on a range: 1, 2 or 5 times a power of ten.
double nice_step(double range, int most);

/// The dark colour of single lines.
inline constexpr auto line_colour = "#31688e";
/// The colour of a component's line, distinguishable by the colour-blind; the first is that of single lines.
std::string component_colour(std::size_t component);

}  // namespace delf
