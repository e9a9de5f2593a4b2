// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tools/figures/figure_style.hpp"
#include "tools/files/text_file.hpp"
#include "tools/verify/verdict_figures.hpp"

namespace delf {

namespace {

// Light for what contributes little, dark for what contributes much: on white, unlike the colours of the maps.
constexpr auto palette =
    "set palette defined (0 '#c7e9b4', 1 '#7fcdbb', 2 '#41b6c4', 3 '#1d91c0', 4 '#225ea8', 5 '#253494', 6 "
    "'#081d58')\n";
constexpr auto nothing = "#cfcfcf";  // of a site that contributes nothing

// The plot's extent in parts of the figure, which is 3:2.
constexpr double right = 0.78, bottom = 0.12, top = 0.855;

/// The extent of the sites, with room about them, and how large they can be drawn.
struct Frame {
  double x_least = 1e300, x_most = -1e300, t_least = 1e300, t_most = -1e300;
  int side = 1;                          // nodes side by side in a cell
  double left = 0;                       // beside the numbers of the rows
  double width = 0, height = 0;          // of a mark, in units of x and t
  double dot_width = 0, dot_height = 0;  // of the largest round mark, in the same units
  bool dense = false;  // too small for a ring to be distinguished from a disc: boundary sites are bars

  explicit Frame(const std::vector<DrawnSite>& sites) {
    int nodes = 1;
    for (const DrawnSite& s : sites) nodes = std::max(nodes, s.node + 1);
    while (side * side < nodes) ++side;
    for (const DrawnSite& s : sites) {
      x_least = std::min(x_least, x(s)), x_most = std::max(x_most, x(s));
      t_least = std::min(t_least, t(s)), t_most = std::max(t_most, t(s));
    }
    const double x_room = std::max(0.8, 0.02 * (x_most - x_least)), t_room = std::max(0.8, 0.02 * (t_most - t_least));
    x_least -= x_room, x_most += x_room, t_least -= t_room, t_most += t_room;
    const auto digits = fmt::formatted_size("{:.0f}", std::max(t_most, 1000.0));
    left = 0.057 + 0.012 * static_cast<double>(digits);
    set_marks();
  }
  // Marks are round, but bars on the boundary where the sites are so dense one way that rings would be hard to see.
  void set_marks() {
    constexpr double part = 0.76, widest = 0.028, longest = 10;  // of the distance to the neighbour; of the figure
    const double dx = (right - left) / (x_most - x_least), dt = (top - bottom) / 1.5 / (t_most - t_least);
    const double w = std::min(part * dx / side, widest), h = std::min(part * dt / side, widest);
    const double round = std::min(w, h);
    dense = round < 0.008;
    width = std::min(w, dense ? longest * round : round) / dx;
    height = std::min(h, dense ? longest * round : round) / dt;
    dot_width = round / dx, dot_height = round / dt;
  }
  // Nodes inside a cell are to the right of its vertex and above it, in rows of a square.
  double x(const DrawnSite& s) const { return s.space + static_cast<double>(s.node % side) / side; }
  double t(const DrawnSite& s) const { return s.time + static_cast<double>(s.node / side) / side; }
};

bool contributes(const DrawnSite& s) { return s.weight != 0; }

// The power of ten of a weight that is not 0; one that is not a finite number is beyond the end of every scale.
double power_of(const DrawnSite& s) {
  constexpr double beyond = 1000;
  return std::isfinite(s.weight) ? std::log10(std::abs(s.weight)) : beyond;
}

/// Powers of ten of the weights.
ColourScale scale_of_sites(const std::vector<DrawnSite>& sites) {
  double least = 300, most = -300;
  for (const DrawnSite& s : sites)
    if (contributes(s) && std::isfinite(s.weight))
      least = std::min(least, power_of(s)), most = std::max(most, power_of(s));
  if (least > most) return {-2, 0, false};
  most = std::ceil(most);
  least = std::floor(std::max(least, most - 12));
  return {std::min(least, most - 1), most, false};
}

// Sites that are drawn in one way.
struct Layer {
  const char* file;
  bool (*holds)(const DrawnSite&);
  double size;  // in parts of a mark
  std::string colour;
  bool is_hole = false, on_boundary = false;
};

// Boundary sites are rings or bars, interior ones discs, and what is neither a dot.
std::vector<Layer> layers() {
  const std::string grey = fmt::format("fc rgb '{}'", nothing), by_weight = "fc palette", white = "fc rgb '#ffffff'";
  return {{"idle-rings", [](const DrawnSite& s) { return s.boundary && !contributes(s); }, 1, grey, false, true},
          {"rings", [](const DrawnSite& s) { return s.boundary && contributes(s); }, 1, by_weight, false, true},
          {"holes", [](const DrawnSite& s) { return s.boundary; }, 0.55, white, true, true},
          {"idle-discs", [](const DrawnSite& s) { return s.interior && !contributes(s); }, 0.8, grey},
          {"discs", [](const DrawnSite& s) { return s.interior && contributes(s); }, 0.8, by_weight},
          {"idle-dots", [](const DrawnSite& s) { return !s.interior && !s.boundary && !contributes(s); }, 0.3, grey},
          {"dots", [](const DrawnSite& s) { return !s.interior && !s.boundary && contributes(s); }, 0.3, by_weight}};
}

// Writes the layers that have sites, and plots them one over the other.
std::string plots_of_sites(const std::vector<DrawnSite>& sites, const Frame& frame, const std::filesystem::path& scratch) {
  std::string text;
  for (const Layer& layer : layers()) {
    std::string table;
    for (const DrawnSite& s : sites)
      if (layer.holds(s)) table += fmt::format("{} {} {}\n", frame.x(s), frame.t(s), contributes(s) ? power_of(s) : 0);
    if (table.empty() || (layer.is_hole && frame.dense)) continue;
    write_text_file(scratch / layer.file, table);
    text += text.empty() ? "plot" : ",";
    const char* weight = layer.colour == "fc palette" ? ":3" : "";
    if (frame.dense && layer.on_boundary)
      text += fmt::format(" '{}' using 1:2:({}):({}){} with boxxyerror fs solid noborder {}", layer.file,
                          frame.width / 2, frame.height / 2, weight, layer.colour);
    else
      text += fmt::format(" '{}' using 1:2:({}):({}):(0){} with ellipses units xy fs solid noborder {}", layer.file,
                          layer.size * frame.dot_width, layer.size * frame.dot_height, weight, layer.colour);
  }
  return text + "\n";
}

// The legend above the colours: the meaning of a ring, or of a bar and a disc.
std::string legend(bool dense) {
  const auto circle = [](int number, double y, double radius, const char* colour) {
    return fmt::format("set object {} circle at screen 0.82,{} size screen {} front fs solid noborder fc rgb '{}'\n",
                       number, y, radius, colour);
  };
  const auto words = [](int number, double y, const char* what) {
    return fmt::format("set label {} '{}' at screen 0.84,{} left textcolor rgb '#333333'\n", number, what, y);
  };
  const std::string bar =
      "set object 1 rectangle center screen 0.82,0.835 size screen 0.006,0.036 front fs solid noborder fc rgb "
      "'#225ea8'\n";
  const double disc = dense ? 0.005 : 0.009;
  return (dense ? bar : circle(1, 0.835, 0.011, "#225ea8") + circle(2, 0.835, 0.006, "#ffffff")) +
         words(105, 0.835, "boundary") + circle(3, 0.785, disc, "#225ea8") + words(106, 0.785, "interior") +
         circle(4, 0.735, disc, nothing) + words(107, 0.735, "contributes 0");
}

}  // namespace

std::string worst_region_figure(const VerdictSource& source, const std::filesystem::path& scratch) {
  const WorstRegion& worst = source.verdict.worst;
  if (worst.sites.empty()) return {};
  const Frame frame(worst.sites);
  const ColourScale scale = scale_of_sites(worst.sites);
  const auto tics = [](double range) { return std::max(1.0, nice_step(range, 10)); };
  return palette +
         verdict_title(source.scene + ": where the form formula holds worst",
                       fmt::format("{}: residual {:.2g}", worst.title, worst.value), source.scheme) +
         fmt::format(
             "set lmargin at screen {:.4g}\nset rmargin at screen {}\nset bmargin at screen {}\nset tmargin at screen "
             "{}\n"
             "set grid lc rgb '#ececec' lt 1 lw 0.7\nset xlabel 'space: site i'\n"
             "set label 103 'time: row j' at screen 0.025,0.4875 center rotate textcolor rgb '#333333'\n"
             "set label 104 '|term| / Σ|terms|' at screen 0.875,0.668 center textcolor rgb '#333333' noenhanced\n"
             "set colorbox user origin screen 0.86,0.12 size screen 0.022,0.495 noborder\n"
             "set format x '%.0f'\nset format y '%.0f'\nset format cb '10^{{%h}}'\nset cbtics {} scale 0.3\nset "
             "cbrange [{}:{}]\n"
             "set xtics {}\nset ytics {}\nset xrange [{}:{}]\nset yrange [{}:{}]\n",
             frame.left, right, bottom, top, tics(scale.most - scale.least), scale.least, scale.most,
             tics(frame.x_most - frame.x_least), tics(frame.t_most - frame.t_least), frame.x_least, frame.x_most,
             frame.t_least, frame.t_most) +
         legend(frame.dense) + plots_of_sites(worst.sites, frame, scratch);
}

}  // namespace delf
