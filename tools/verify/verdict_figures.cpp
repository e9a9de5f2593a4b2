// SPDX-License-Identifier: MIT
#include "tools/verify/verdict_figures.hpp"

#include <algorithm>

#include "tools/figures/drawing.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/report/text_columns.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

struct Figure {
  const char* name;
  std::string (*body)(const VerdictSource&, const fs::path& scratch);
};
constexpr Figure all[] = {{"residual-map", residual_map_figure}, {"severity-map", severity_map_figure},
                          {"energy-own", own_energy_figure},     {"residual-region", residual_region_figure},
                          {"worst-region", worst_region_figure}, {"time-reversal", time_reversal_figure}};

}  // namespace

double drawn_logarithmic(double value) { return std::clamp(value, drawn_zero, 1e300); }

std::string verdict_title(const std::string& title, const std::string& subtitle, const std::string& more) {
  return figure_title(title, subtitle + (more.empty() ? "" : "; ") + more);
}

std::vector<std::string> verdict_figure_names() {
  std::vector<std::string> names;
  for (const Figure& figure : all) names.emplace_back(figure.name);
  return names;
}

std::string draw_verdict(const Verdict& verdict, const std::string& scene, const std::string& scheme,
                         const FigureForm& form, const fs::path& folder) {
  const VerdictSource source{verdict, scene, scheme};
  std::vector<Drawing> drawings;
  for (const Figure& figure : all)
    drawings.push_back({figure.name, [&](const fs::path& scratch) { return figure.body(source, scratch); }});
  return draw(drawings, form, folder);
}

}  // namespace delf
