// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include "lattice/index.hpp"
#include "tools/complex/drawn_mesh.hpp"
#include "tools/files/frames_file.hpp"

namespace delf {
namespace {

std::span<const std::int32_t> points_of(const ComplexScene& scene, int cell) {
  if (scene.space) return scene.space->mesh.cell(cell);
  return scene.stencils->stencils[cell].sites;
}

}  // namespace

ListedCells::ListedCells(const ComplexScene& scene) {
  for (int c = 0; c < scene.cells(); ++c) corners = std::max(corners, static_cast<int>(points_of(scene, c).size()));
  for (int c = 0; c < scene.cells(); ++c) {
    std::ranges::copy(points_of(scene, c), std::back_inserter(points));
    points.resize(at(c + 1) * at(corners), -1);
  }
}

bool has_xdmf(const ComplexScene& scene) { return scene.coordinates() == 2 || scene.coordinates() == 3; }

namespace {

/// fields.xdmf
std::string xdmf(const ComplexScene& scene, std::span<const double> times) {
  const std::optional<DrawnMesh> drawn = scene.space ? std::optional<DrawnMesh>(scene.space->mesh) : std::nullopt;
  const bool is_joined = drawn && drawn->points.size() > scene.space->mesh.points.size();
  const int n = drawn ? static_cast<int>(drawn->points.size()) : scene.sites(), cells = scene.cells(),
            d = static_cast<int>(scene.fields.size());
  const ListedCells listed_cells(scene);
  const int corners = listed_cells.corners;
  // Cells of one kind are read from the file; others are listed here, each behind XDMF's number of its kind: those of two
  // kinds, those of a mesh with a seam, which have copies of its points, and stencils, of which a cell is the outline.
  const bool uniform = scene.space && !is_joined && std::ranges::count(listed_cells.points, -1) == 0;
  std::string topology;
  if (uniform) {
    topology = fmt::format(
        "<Topology TopologyType=\"{}\" NumberOfElements=\"{}\"{}><DataItem Dimensions=\"{} {}\" NumberType=\"Int\" "
        "Format=\"HDF\">fields.h5:/cells</DataItem></Topology>",
        corners == 2   ? "Polyline"
        : corners == 3 ? "Triangle"
                       : "Quadrilateral",
        cells, corners == 2 ? " NodesPerElement=\"2\"" : "", cells, corners);
  } else {
    std::string list;
    int listed = 0;
    std::size_t numbers = 0;
    const auto add = [&](std::span<const std::int32_t> points) {
      if (points.empty()) return;  // across the seam of a circle
      const std::string kind = points.size() == 3 ? "4"
                               : points.size() == 4
                                   ? "5"
                                   : fmt::format("{} {}", std::min<std::size_t>(points.size(), 3), points.size());
      list += fmt::format("{} {}\n", kind, fmt::join(points, " "));
      ++listed, numbers += points.size() + (kind.size() > 1 ? 2 : 1);
    };
    for (int c = 0; c < cells; ++c)
      if (drawn) add(drawn->cell(scene.space->mesh, c));
      else add(scene.stencils->outline(scene.stencils->stencils[c]));
    topology = fmt::format(
        "<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\"><DataItem Dimensions=\"{}\" NumberType=\"Int\" "
        "Format=\"XML\">\n{}</DataItem></Topology>",
        listed, numbers, list);
  }
  const int coordinates = scene.coordinates();
  std::string geometry = "Format=\"HDF\">fields.h5:/space";
  if (is_joined) {
    geometry = "Format=\"XML\">\n";
    for (const Mesh::Point& p : drawn->points)
      geometry += fmt::format("{}\n", fmt::join(std::span(p).first(at(coordinates)), " "));
  }
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain><Grid Name=\"rows\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n";
  for (std::size_t f = 0; f < times.size(); ++f) {
    text += fmt::format(
        "<Grid Name=\"row\"><Time Value=\"{}\"/>\n{}\n<Geometry GeometryType=\"{}\"><DataItem Dimensions=\"{} {}\" "
        "Precision=\"8\" {}</DataItem></Geometry>\n",
        times[f], topology, coordinates == 2 ? "XY" : "XYZ", n, coordinates, geometry);
    for (int a = 0; a < d; ++a)
      text += fmt::format(
          "<Attribute Name=\"{0}\" Center=\"Node\"><DataItem Dimensions=\"{1}\" NumberType=\"Float\" "
          "Precision=\"8\" Format=\"HDF\">{2}:/{0}/{3}</DataItem></Attribute>\n",
          scene.fields[a].name, n, frames_file_name, f);
    text += "</Grid>\n";
  }
  return text + "</Grid></Domain></Xdmf>\n";
}

}  // namespace

void write_mesh_xdmf(const ComplexScene& scene, const std::filesystem::path& folder, std::span<const double> times) {
  std::vector<std::int32_t> copies;
  if (scene.space) {
    const DrawnMesh drawn(scene.space->mesh);
    copies.assign(drawn.copied(scene.space->mesh).begin(), drawn.copied(scene.space->mesh).end());
  }
  std::vector<std::string> names;
  for (const auto& field : scene.fields) names.push_back(field.name);
  write_frames_file(folder, {{"/field", names}}, times.size(), at(scene.sites()),
                    {.together = false, .moving = {}, .copies = copies});
  write_text_file(folder / "fields.xdmf", xdmf(scene, times));
}

}  // namespace delf
