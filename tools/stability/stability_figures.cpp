// SPDX-License-Identifier: MIT
#include "tools/stability/stability_figures.hpp"

#include <fmt/format.h>

#include "tools/figures/drawing.hpp"

namespace delf {

namespace {
std::string map_name(std::size_t part) {
  return part == 0 ? "stability-map" : fmt::format("stability-map-{}", part + 1);
}
}  // namespace

std::vector<std::string> stability_figure_names(std::size_t schemes) {
  std::vector<std::string> names{"dispersion", map_name(0)};
  for (std::size_t part = 1; part * maps_in_a_figure < schemes; ++part) names.push_back(map_name(part));
  return names;
}

std::string draw_stability(const StabilityFindings& f, const std::string& scene, const FigureForm& form,
                           const std::filesystem::path& folder) {
  std::vector<Drawing> drawings{
      {"dispersion", [&](const std::filesystem::path& scratch) { return dispersion_figure(f, scene, scratch); }}};
  for (std::size_t part = 0; part * maps_in_a_figure < f.maps.size(); ++part)
    drawings.push_back({map_name(part), [&f, &scene, part](const std::filesystem::path& scratch) {
                          return stability_map_figure(f, scene, part, scratch);
                        }});
  return draw(drawings, form, folder);
}

}  // namespace delf
