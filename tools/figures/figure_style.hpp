// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/figures/figure_form.hpp"

namespace delf {

/// Colours from `least` to `most`: a perceptually even map from dark to light, or from blue through white to red for
/// values of both signs. Both are readable by the colour-blind.
struct ColourScale {
  double least, most;
  bool swings;  ///< about zero
};
/// The scale of some values; the most extreme half per cent are ignored if they would hide the rest.
ColourScale colour_scale(std::span<const double> values);
/// The scale as gnuplot commands.
std::string gnuplot_colours(const ColourScale&);

/// The style of all figures, as gnuplot commands.
std::string gnuplot_style();

/// A figure as gnuplot commands: `body` drawn in each format, all in one style. It may use the variables `titles`, 0 or 1,
/// and `top`, where plots end on the screen.
std::string figure_script(const std::string& name, const std::string& body, const FigureForm& form = {});

/// A title at the top left, and a quieter line below it: long ones are smaller, or broken. They are labels 91 to 99.
std::string figure_title(const std::string& title, const std::string& subtitle);

/// A round distance between at most `most` tics on a range: 1, 2 or 5 times a power of ten.
double nice_step(double range, int most);

/// Tics of the x-axis of a panel, as a gnuplot command: so few that numbers do not touch. `width` and `gap` are those of the
/// panel and of the room beside it, as parts of the figure; a number at the end that would touch the first one of the panel
/// beside it is left out. No gap: there is no other panel.
std::string panel_tics(double from, double to, double width, std::optional<double> gap = {});

/// The dark colour of single lines.
inline constexpr auto line_colour = "#31688e";
/// Finds for each curve the first of the curves before it that it cannot be distinguished from: nowhere farther than a
/// line's width on an axis of that range; or itself.
std::vector<std::size_t> coinciding(const std::vector<std::vector<double>>& curves, double range);

/// The names of curves in their colours, at the upper right, above the plots; of one that lies on another, which.
std::string key_of_curves(std::size_t count, const std::function<std::string(std::size_t)>& name,
                          const std::vector<std::vector<double>>& curves);

/// The range of an axis, as gnuplot commands, where a few extreme values (half a per cent) would flatten all others; else
/// nothing, and gnuplot chooses.
std::string robust_range(const char* axis, const std::vector<std::vector<double>>& curves);

/// The number of different colours of lines.
inline constexpr std::size_t line_colours = 6;
/// The colour of a component's line; the first is that of single lines. Any two differ by 24 (CIE 1976) at least for normal
/// sight and without red, green or blue cones, and each has a contrast of 3 to white.
std::string component_colour(std::size_t component);

}  // namespace delf
