// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ranges>

#include "lattice/index.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/files/frames_file.hpp"
#include "tools/files/text_file.hpp"

namespace delf {
namespace {

RowNames names_of(const ComplexScene& scene) {
  RowNames names;
  names.of[Role::field].clear();
  for (const auto& field : scene.fields) names.of[Role::field].push_back(field.name);
  if (scene.theory->constraint()) names.of[Role::multiplier] = {"lambda"};
  return names;
}

}  // namespace

bool has_xdmf(const ComplexScene& scene) { return scene.coordinates() == 2 || scene.coordinates() == 3; }

MeshFiles::MeshFiles(const ComplexScene& scene, const std::filesystem::path& folder, std::int64_t frames,
                     bool node_times, const WrittenPart& kept)
    : scene_(scene), folder_(folder), corners_(0) {
  const auto corners_of = [&](int c) -> std::span<const std::int32_t> {
    return scene.stencils ? std::span<const std::int32_t>(scene.stencils->stencils[c].sites)
                          : scene.space->mesh.cell(c);
  };
  for (int c = 0; c < scene.cells(); ++c) corners_ = std::max(corners_, static_cast<int>(corners_of(c).size()));
  std::vector<std::int32_t> cells;
  for (int c = 0; c < scene.cells(); ++c) {
    const auto corners = corners_of(c);
    cells.insert(cells.end(), corners.begin(), corners.end());
    cells.resize(at(c + 1) * at(corners_), -1);
  }
  file_ =
      std::make_unique<FieldsFile>(folder / "fields.h5", scene.places(), frames, resolved_text(scene), 0,
                                   names_of(scene), MeshOfFile{scene.coordinates(), cells, corners_, node_times}, kept);
}

void MeshFiles::append(double time, std::span<const double> values, std::span<const double> multipliers,
                       std::span<const double> node_times) {
  RecordedRow row;
  row[Role::field].assign(values.begin(), values.end());
  row[Role::multiplier].assign(multipliers.begin(), multipliers.end());
  if (scene_.theory->constraint()) row[Role::multiplier].resize(scene_.sites(), 0.0);
  file_->append(time, row, {}, node_times);
  times_.push_back(time);
}

void MeshFiles::visit(SavedState& state) { state("times of frames", times_); }

void MeshFiles::close() {
  file_->close();
  if (!has_xdmf(scene_)) return;
  write_frames_file(folder_, names_of(scene_).of[Role::field], times_.size(), at(scene_.sites()));
  write_text_file(folder_ / "fields.xdmf", xdmf());
}

std::string MeshFiles::xdmf() const {
  const int n = scene_.sites(), cells = scene_.cells(), d = static_cast<int>(scene_.fields.size());
  // Cells of one kind are read from the file; others are listed here, each behind XDMF's number of its kind: those of two
  // kinds, and stencils, of which a cell is the outline.
  const bool uniform = scene_.space && std::ranges::all_of(std::views::iota(0, cells), [&](int c) {
                         return static_cast<int>(scene_.space->mesh.cell(c).size()) == corners_;
                       });
  std::string topology;
  if (uniform) {
    topology = fmt::format(
        "<Topology TopologyType=\"{}\" NumberOfElements=\"{}\"{}><DataItem Dimensions=\"{} {}\" NumberType=\"Int\" "
        "Format=\"HDF\">fields.h5:/cells</DataItem></Topology>",
        corners_ == 2   ? "Polyline"
        : corners_ == 3 ? "Triangle"
                        : "Quadrilateral",
        cells, corners_ == 2 ? " NodesPerElement=\"2\"" : "", cells, corners_);
  } else {
    std::string list;
    int listed = 0;
    std::size_t numbers = 0;
    const auto add = [&](std::span<const std::int32_t> corners) {
      if (corners.empty()) return;  // across the seam of a circle
      const std::string kind = corners.size() == 3 ? "4"
                               : corners.size() == 4
                                   ? "5"
                                   : fmt::format("{} {}", std::min<std::size_t>(corners.size(), 3), corners.size());
      list += fmt::format("{} {}\n", kind, fmt::join(corners, " "));
      ++listed, numbers += corners.size() + (kind.size() > 1 ? 2 : 1);
    };
    for (int c = 0; c < cells; ++c)
      if (scene_.space) add(scene_.space->mesh.cell(c));
      else add(scene_.stencils->outline(scene_.stencils->stencils[c]));
    topology = fmt::format(
        "<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\"><DataItem Dimensions=\"{}\" NumberType=\"Int\" "
        "Format=\"XML\">\n{}</DataItem></Topology>",
        listed, numbers, list);
  }
  const int coordinates = scene_.coordinates();
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain><Grid Name=\"rows\" GridType=\"Collection\" "
      "CollectionType=\"Temporal\">\n";
  for (std::size_t f = 0; f < times_.size(); ++f) {
    text += fmt::format(
        "<Grid Name=\"row\"><Time Value=\"{}\"/>\n{}\n<Geometry GeometryType=\"{}\"><DataItem Dimensions=\"{} {}\" "
        "Precision=\"8\" Format=\"HDF\">fields.h5:/space</DataItem></Geometry>\n",
        times_[f], topology, coordinates == 2 ? "XY" : "XYZ", n, coordinates);
    for (int a = 0; a < d; ++a)
      text += fmt::format(
          "<Attribute Name=\"{0}\" Center=\"Node\"><DataItem Dimensions=\"{1}\" NumberType=\"Float\" "
          "Precision=\"8\" Format=\"HDF\">{2}:/{0}/{3}</DataItem></Attribute>\n",
          scene_.fields[a].name, n, frames_file_name, f);
    text += "</Grid>\n";
  }
  return text + "</Grid></Domain></Xdmf>\n";
}

}  // namespace delf
