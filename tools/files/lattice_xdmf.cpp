// SPDX-License-Identifier: MIT
#include "tools/files/lattice_xdmf.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/frames_file.hpp"
#include "tools/files/text_file.hpp"

namespace delf {
namespace {

/// What follows of a data set of doubles, of a file and of these dimensions.
std::string data(const std::string& dimensions, const std::string& where) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">{}</DataItem>",
                     dimensions, where);
}

std::string document(const std::string& grids) {
  return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n" + grids + "</Domain></Xdmf>\n";
}

/// The components that are shown: their names, and those of their groups in frames.h5.
using Shown = std::vector<std::pair<std::string, std::string>>;

std::string attributes(const Shown& shown, const std::string& dimensions, const std::string& which) {
  std::string text;
  for (const auto& [name, group] : shown)
    text += fmt::format("<Attribute Name=\"{}\" Center=\"Node\">{}</Attribute>\n", name,
                        data(dimensions, fmt::format("{}:/{}/{}", frames_file_name, group, which)));
  return text;
}

}  // namespace

void write_lattice_xdmf(const std::filesystem::path& folder, const RowNames& names) {
  const FieldsReader reader(folder / "fields.h5");
  const auto frames = at(reader.frames()), sites = at(reader.sites());
  std::vector<SharedRows> shared;
  Shown shown;
  for (const auto& [role, data_set] : {std::pair(Role::field, "field"), std::pair(Role::inner, "inner"),
                                       std::pair(Role::multiplier, "multiplier"), std::pair(Role::trace, "trace")}) {
    if (names.of[role].empty()) continue;
    shared.push_back({fmt::format("/{}", data_set), {}});
    for (const std::string& name :
         names.of[role]) {  // inner nodes have names that are none of a group: phi at (0, 0.5)
      const std::string group =
          role == Role::field ? name : fmt::format("{}{}", data_set, shared.back().components.size());
      shared.back().components.push_back(group);
      shown.emplace_back(name, group);
    }
  }
  if (names.mesh) shared.push_back({"/mesh", {"places_of_sites"}, false});
  write_frames_file(folder, shared, frames, sites,
                    {.together = true, .moving = names.mesh ? "/mesh" : "", .copies = {}});

  const std::string both = fmt::format("{} {}", frames, sites);
  std::string surface = "<Grid Name=\"over x and t\">\n";
  if (names.mesh)
    surface += fmt::format(
        "<Topology TopologyType=\"2DSMesh\" Dimensions=\"{}\"/><Geometry GeometryType=\"XY\">{}</Geometry>\n", both,
        data(fmt::format("{} 2", frames * sites), fmt::format("{}:/places", frames_file_name)));
  else
    surface += fmt::format(
        "<Topology TopologyType=\"2DRectMesh\" Dimensions=\"{}\"/><Geometry GeometryType=\"VXVY\">{}{}</Geometry>\n",
        both, data(fmt::to_string(sites), "fields.h5:/space"), data(fmt::to_string(frames), "fields.h5:/time"));
  write_text_file(folder / "surface.xdmf", document(surface + attributes(shown, both, "all") + "</Grid>\n"));

  std::string rows = "<Grid Name=\"rows\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t n = 0; n < frames; ++n) {
    const std::string places =
        names.mesh ? fmt::format("{}:/places_of_sites/{}", frames_file_name, n) : "fields.h5:/space";
    rows += fmt::format(
                "<Grid Name=\"row\"><Time Value=\"{}\"/>\n<Topology TopologyType=\"2DRectMesh\" Dimensions=\"1 {}\"/>"
                "<Geometry GeometryType=\"VXVY\">{}<DataItem Dimensions=\"1\" NumberType=\"Float\" Format=\"XML\">0"
                "</DataItem></Geometry>\n",
                reader.time(static_cast<int>(n)).value_or(static_cast<double>(n)), sites,
                data(fmt::to_string(sites), places)) +
            attributes(shown, fmt::format("1 {}", sites), fmt::to_string(n)) + "</Grid>\n";
  }
  write_text_file(folder / "fields.xdmf", document(rows + "</Grid>\n"));
}

}  // namespace delf
