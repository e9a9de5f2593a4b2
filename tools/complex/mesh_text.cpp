// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <span>
#include <unordered_map>

#include "lattice/index.hpp"
#include "lattice/space/coincident_points.hpp"
#include "lattice/space/mesh_overlap.hpp"
#include "tools/complex/text_lines.hpp"

namespace delf {
namespace {

constexpr std::string_view point_word = "point", cell_word = "cell", side_word = "side";

void add_side(Mesh& mesh, const std::string& part, std::int32_t a, std::int32_t b, int line = 0) {
  auto found = std::ranges::find(mesh.parts, part, &Mesh::Part::name);
  if (found == mesh.parts.end()) found = mesh.parts.insert(found, {part, {}});
  found->sides.push_back({a, b});
  if (line > 0) found->lines.push_back(line);
}

Mesh plain_mesh(TextLines& lines) {
  Mesh mesh{.points = {}, .vertices = {}};
  struct Listed {
    std::string part;
    std::int32_t a, b;
    int line;
  };
  std::vector<Listed> sides;
  do {
    const std::string_view kind = lines.word();
    if (kind == point_word) {
      Mesh::Point p{};
      for (std::size_t k = 0; k < 3 && (k == 0 || lines.has_words()); ++k) p[k] = lines.read<double>("a coordinate");
      mesh.points.push_back(p);
      mesh.point_lines.push_back(lines.number());
    } else if (kind == cell_word) {
      std::array<std::int32_t, 4> corners{};
      std::size_t count = 0;
      while (count < 4 && lines.has_words()) corners[count++] = lines.read<std::int32_t>("the number of a point");
      if (count < 2) lines.refuse("a cell needs two points at least; add them");
      mesh.add_cell({corners.data(), count});
      mesh.cell_lines.push_back(lines.number());
    } else if (kind == side_word) {
      const std::string part(lines.word());
      if (part.empty()) lines.refuse("a side needs the name of its part and its points, as side left 0 1; add them");
      const auto a = lines.read<std::int32_t>("the number of a point");
      const auto b = lines.has_words() ? lines.read<std::int32_t>("the number of a point") : a;
      sides.push_back({part, a, b, lines.number()});
    } else {
      lines.refuse(fmt::format("\"{}\" is neither point, cell nor side; correct it, or begin the line with #",
                               kind.substr(0, 40)));
    }
    if (lines.has_words()) lines.refuse("a point has three coordinates at most, a cell four points; remove the rest");
  } while (lines.next());
  mesh.dimension = mesh.cells() > 0 && mesh.cell(0).size() == 2 ? 1 : 2;
  for (const auto& [part, a, b, line] : sides) {
    if (std::min(a, b) < 0 || at(std::max(a, b)) >= mesh.points.size())
      throw MeshError(line, "a side has the number of a point that is not there; correct it");
    if ((a == b) != (mesh.dimension == 1))
      throw MeshError(line, mesh.dimension == 1 ? "a side of segments is one point; give its number"
                                                : "a side has two points; give their numbers");
    add_side(mesh, part, a, b, line);
  }
  return mesh;
}

/// Gmsh's types of elements that are cells, or lie at their boundary: how many points, and of which dimension.
struct Element {
  std::size_t points;
  int dimension;
};
const Element* element_of(int type) {
  static const std::unordered_map<int, Element> known{{15, {1, 0}}, {1, {2, 1}}, {2, {3, 2}}, {3, {4, 2}}};
  const auto found = known.find(type);
  return found == known.end() ? nullptr : &found->second;
}

/// Elements that are no cells here, with a remedy.
std::string refusal_of_element(int type) {
  constexpr const char* plane =
      "cells are segments, triangles and quadrilaterals; save the mesh of a curve or a surface";
  constexpr const char* first_order =
      "cells have points at their corners alone; save elements of order 1 "
      "(Mesh.ElementOrder = 1)";
  static const std::unordered_map<int, std::pair<const char*, const char*>> named{
      {4, {"a tetrahedron", plane}},
      {5, {"a hexahedron", plane}},
      {6, {"a prism", plane}},
      {7, {"a pyramid", plane}},
      {8, {"a line of order 2", first_order}},
      {9, {"a triangle of order 2", first_order}},
      {10, {"a quadrilateral of order 2", first_order}},
      {16, {"a quadrilateral of order 2", first_order}},
      {11, {"a tetrahedron of order 2", plane}},
      {12, {"a hexahedron of order 2", plane}},
      {17, {"a hexahedron of order 2", plane}},
      {20, {"a triangle of order 3", first_order}},
      {21, {"a triangle of order 3", first_order}},
      {26, {"a line of order 3", first_order}}};
  const auto found = named.find(type);
  return found == named.end()
             ? fmt::format("an element of type {}; cells are lines, triangles and quadrilaterals of order 1 (1, 2, 3)",
                           type)
             : fmt::format("{} (type {}); {}", found->second.first, type, found->second.second);
}

class Gmsh {
 public:
  explicit Gmsh(TextLines& lines) : lines_(lines) {}

  Mesh read() {
    lines_.need_next("the version");
    const std::string version(lines_.word());
    if (version != "2.2" && version != "4.1")
      lines_.refuse(fmt::format("version {} of MSH; save as 2.2 or 4.1", version.substr(0, 20)));
    if (lines_.word() != "0") lines_.refuse("a binary file; save it as ASCII (Mesh.Binary = 0)");
    bool has_points = false, has_cells = false;
    lines_.need_section("$EndMeshFormat");
    while (lines_.next()) {
      const std::string section(lines_.word());
      if (section == "$PhysicalNames") {
        physical_names();
        lines_.need_section("$EndPhysicalNames");
      } else if (section == "$Entities" && version == "4.1") {
        entities();
        lines_.need_section("$EndEntities");
      } else if (section == "$Nodes") {
        if (has_points) lines_.refuse("$Nodes is there twice; remove one");
        version == "2.2" ? points_2() : points_4();
        lines_.need_section("$EndNodes");
        has_points = true;
      } else if (section == "$Elements") {
        if (!has_points || has_cells) lines_.refuse("$Elements must be there once, behind $Nodes");
        version == "2.2" ? elements_2() : elements_4();
        lines_.need_section("$EndElements");
        has_cells = true;
      } else if (section.starts_with('$') && !section.starts_with("$End")) {
        const std::string end = "$End" + section.substr(1);
        do lines_.need_next(end.c_str());
        while (lines_.word() != end);
      } else {
        lines_.refuse(fmt::format("\"{}\" is no section; correct it", section.substr(0, 40)));
      }
    }
    if (!has_cells) lines_.refuse("$Nodes or $Elements is missing; save the mesh again");
    keep_highest();
    return std::move(mesh_);
  }

 private:
  std::int64_t count(const char* what) {
    const auto n = lines_.read<std::int64_t>(what);
    if (n < 0 || n > 100'000'000) lines_.refuse(fmt::format("{} {} is not a count; correct it", n, what));
    return n;
  }
  void add_point(std::int64_t tag) {
    if (!number_.try_emplace(tag, static_cast<std::int32_t>(mesh_.points.size())).second)
      lines_.refuse(fmt::format("point {} is there twice; remove one", tag));
    Mesh::Point p{};
    for (double& x : p) x = lines_.read<double>("a coordinate");
    mesh_.points.push_back(p);
    mesh_.point_tags.push_back(tag);
    mesh_.point_lines.push_back(lines_.number());
  }
  /// A group's name is in quotes; one without a name has its number.
  void physical_names() {
    lines_.need_next("the number of names");
    for (std::int64_t n = count("names"); n > 0; --n) {
      lines_.need_next("the last name");
      const int dimension = lines_.read<int>("a dimension");
      const auto tag = lines_.read<std::int64_t>("the number of a group");
      std::string name(lines_.word());
      while (lines_.has_words()) name += " " + std::string(lines_.word());
      std::erase(name, '"');
      groups_[{dimension, tag}] = name;
    }
  }
  /// The groups that points and curves of the geometry are in; boxes around them are passed over.
  void entities() {
    lines_.need_next("the numbers of entities");
    std::array<std::int64_t, 4> counts{};
    for (auto& n : counts) n = count("entities");
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::int64_t n = counts[at(dimension)]; n > 0; --n) {
        lines_.need_next("the last entity");
        const auto entity = lines_.read<std::int64_t>("the number of an entity");
        for (int x = dimension == 0 ? 3 : 6; x > 0; --x) lines_.word();
        for (std::int64_t groups = count("groups"); groups > 0; --groups)
          entity_groups_[{dimension, entity}].push_back(std::abs(lines_.read<std::int64_t>("the number of a group")));
      }
  }
  void points_2() {
    lines_.need_next("the number of nodes");
    for (std::int64_t n = count("nodes"); n > 0; --n) {
      lines_.need_next("the last node");
      add_point(lines_.read<std::int64_t>("the number of a node"));
    }
  }
  void points_4() {
    lines_.need_next("the number of nodes");
    for (std::int64_t blocks = count("blocks of nodes"); blocks > 0; --blocks) {
      lines_.need_next("the last block of nodes");
      lines_.word(), lines_.word();
      if (lines_.word() != "0") lines_.refuse("parametric nodes; save without them (Mesh.SaveParametric = 0)");
      std::vector<std::int64_t> tags;
      for (std::int64_t n = count("nodes"); n > 0; --n) {
        lines_.need_next("the last node");
        tags.push_back(lines_.read<std::int64_t>("the number of a node"));
      }
      for (const std::int64_t tag : tags) {
        lines_.need_next("the last node");
        add_point(tag);
      }
    }
  }
  void add_element(std::int64_t tag, int type, std::span<const std::int64_t> groups) {
    const Element* const element = element_of(type);
    if (!element) lines_.refuse(refusal_of_element(type));
    std::array<std::int32_t, 4> corners{};
    for (std::size_t l = 0; l < element->points; ++l) {
      const auto node = lines_.read<std::int64_t>("the number of a node");
      const auto found = number_.find(node);
      if (found == number_.end()) lines_.refuse(fmt::format("there is no node {}; correct it", node));
      corners[l] = found->second;
    }
    mesh_.add_cell({corners.data(), element->points});
    mesh_.cell_tags.push_back(tag);
    mesh_.cell_lines.push_back(lines_.number());
    dimensions_.push_back(element->dimension);
    groups_of_.emplace_back(groups.begin(), groups.end());
  }
  void elements_2() {
    lines_.need_next("the number of elements");
    for (std::int64_t n = count("elements"); n > 0; --n) {
      lines_.need_next("the last element");
      const auto tag = lines_.read<std::int64_t>("the number of an element");
      const int type = lines_.read<int>("the type of an element");
      std::vector<std::int64_t> groups;  // the first tag is the group, 0 for none; the others are of the geometry
      for (std::int64_t tags = count("tags"), n_th = 0; n_th < tags && lines_.has_words(); ++n_th)
        if (const std::string_view word = lines_.word(); n_th == 0 && word != "0")
          groups.push_back(std::abs(lines_.number_of<std::int64_t>(word, "the number of a group")));
      add_element(tag, type, groups);
    }
  }
  void elements_4() {
    lines_.need_next("the number of elements");
    for (std::int64_t blocks = count("blocks of elements"); blocks > 0; --blocks) {
      lines_.need_next("the last block of elements");
      const int dimension = lines_.read<int>("the dimension of an entity");
      const auto entity = lines_.read<std::int64_t>("the number of an entity");
      const int type = lines_.read<int>("the type of an element");
      for (std::int64_t n = count("elements"); n > 0; --n) {
        lines_.need_next("the last element");
        const auto tag = lines_.read<std::int64_t>("the number of an element");
        add_element(tag, type, entity_groups_[{dimension, entity}]);
      }
    }
  }
  /// Elements of the groups at the boundary are its parts; other elements go, and points that no cell has.
  void keep_highest() {
    Mesh kept{.dimension = 0, .points = {}, .vertices = {}};
    for (const int d : dimensions_) kept.dimension = std::max(kept.dimension, d);
    for (int c = 0; c < mesh_.cells(); ++c) {
      const std::size_t i = c;
      if (dimensions_[i] == kept.dimension - 1)
        for (const std::int64_t group : groups_of_[i]) {
          const auto ends = mesh_.cell(c);
          const auto named = groups_.find({dimensions_[i], group});
          add_side(kept, named == groups_.end() ? fmt::format("{}", group) : named->second, ends.front(), ends.back());
        }
      if (dimensions_[i] != kept.dimension || kept.dimension == 0) continue;
      kept.add_cell(mesh_.cell(c));
      kept.cell_lines.push_back(mesh_.cell_lines[i]);
      kept.cell_tags.push_back(mesh_.cell_tags[i]);
    }
    std::vector<std::int32_t> number(mesh_.points.size(), -1);
    for (const auto p : kept.vertices) number[p] = 0;
    for (std::size_t p = 0; p < number.size(); ++p) {
      if (number[p] < 0) continue;
      number[p] = static_cast<std::int32_t>(kept.points.size());
      kept.points.push_back(mesh_.points[p]);
      kept.point_lines.push_back(mesh_.point_lines[p]);
      kept.point_tags.push_back(mesh_.point_tags[p]);
    }
    for (auto& p : kept.vertices) p = number[p];
    for (Mesh::Part& part : kept.parts) {
      std::erase_if(part.sides, [&](const auto& side) { return number[side[0]] < 0 || number[side[1]] < 0; });
      for (auto& side : part.sides)
        for (auto& p : side) p = number[p];
    }
    mesh_ = std::move(kept);
  }

  TextLines& lines_;
  Mesh mesh_{.points = {}, .vertices = {}};
  std::vector<int> dimensions_;
  using Numbered = std::pair<int, std::int64_t>;  ///< a dimension and a number
  std::map<Numbered, std::string> groups_;
  std::map<Numbered, std::vector<std::int64_t>> entity_groups_;
  std::vector<std::vector<std::int64_t>> groups_of_;  ///< of each element
  std::unordered_map<std::int64_t, std::int32_t> number_;
};

}  // namespace

namespace {

/// "point 3 (line 5)"
std::string named(const char* kind, std::int64_t number, const std::vector<int>& lines, std::size_t n) {
  return fmt::format("{} {}{}", kind, number, n < lines.size() ? fmt::format(" (line {})", lines[n]) : "");
}

void refuse_coincident(const Mesh& mesh) {
  const auto found = coincident_points(mesh);
  if (!found) return;
  const auto [p, q] = *found;
  throw MeshError(
      p < mesh.point_lines.size() ? mesh.point_lines[p] : 0,
      fmt::format("point {} lies where {} does, and nothing joins the cells there; give a distance as "
                  "lattice.merge, such as {:.0e}, to make such points one, or 0 where the seam is to be open",
                  mesh.point_number(p), named("point", mesh.point_number(q), mesh.point_lines, q),
                  1e-6 * shortest_edge(mesh)));
}

/// Parts are of the boundary: lines of Gmsh inside are left out, and those of a text refused.
void keep_boundary(Mesh& mesh) {
  if (mesh.parts.empty()) return;
  const auto outer = boundary_sides(mesh);
  const auto is_inside = [&](const std::array<std::int32_t, 2>& side) {
    return !std::ranges::binary_search(outer, std::array{std::min(side[0], side[1]), std::max(side[0], side[1])});
  };
  for (Mesh::Part& part : mesh.parts) {
    for (std::size_t n = 0; n < part.lines.size(); ++n)
      if (is_inside(part.sides[n]))
        throw MeshError(part.lines[n],
                        "no cell, or two of them, have this side: it is none of the boundary; correct it");
    std::erase_if(part.sides, is_inside);
  }
  std::erase_if(mesh.parts, [](const Mesh::Part& part) { return part.sides.empty(); });
}

void refuse_overlaps(const Mesh& mesh) {
  const auto found = overlapping_cells(mesh);
  if (!found) return;
  const std::size_t c = found->first, other = at(found->second);
  throw MeshError(
      c < mesh.cell_lines.size() ? mesh.cell_lines[c] : 0,
      fmt::format("cell {} overlaps {}: a part of space would count twice; move their points, or remove one",
                  mesh.cell_number(c), named("cell", mesh.cell_number(other), mesh.cell_lines, other)));
}

}  // namespace

Mesh parse_mesh(std::string_view text, std::optional<double> merge) {
  TextLines lines(text);
  if (!lines.next()) throw MeshError(1, "the mesh is empty; write lines like point 0 0 and cell 0 1 2");
  Mesh mesh = text.starts_with("$MeshFormat") ? Gmsh(lines).read() : plain_mesh(lines);
  if (merge && *merge > 0) mesh = merged(mesh, *merge);
  if (const auto fault = find_fault(mesh)) throw MeshError(fault->line, fault->what);
  keep_boundary(mesh);
  if (!merge) refuse_coincident(mesh);
  refuse_overlaps(mesh);
  return mesh;
}

}  // namespace delf
