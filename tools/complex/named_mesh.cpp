// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include "jets/expressions/expression.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/space/mesh_refinement.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/complex/refined_piece.hpp"
#include "tools/complex/mesh_text.hpp"
#include "tools/complex/stencil_text.hpp"

namespace delf {
namespace {

namespace fs = std::filesystem;
constexpr auto key = "lattice.mesh";

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw BadInput(key, fmt::format("{} = {}: {}", key, name, why));
}

/// The numbers behind NAME:, as many as there must be.
std::vector<double> numbers(const std::string& name, const std::string& form) {
  const std::vector<std::string> parts = parts_of(std::string_view(name).substr(name.find(':') + 1));
  if (parts.size() != parts_of(form).size()) refuse(name, "write it as " + form);
  std::vector<double> values;
  for (const std::string& part : parts) values.push_back(number_of(part, key));
  return values;
}

int whole(const std::string& name, double value, int least, int most) {
  if (value != std::round(value) || value < least || value > most)
    refuse(name, fmt::format("{:g} must be a whole number from {} to {}", value, least, most));
  return static_cast<int>(value);
}
double positive(const std::string& name, double value) {
  if (!(value > 0) || !std::isfinite(value)) refuse(name, fmt::format("{:g} must be above 0", value));
  return value;
}

std::variant<Mesh, StencilList> read_file(const std::string& name, const fs::path& folder, fs::path& file,
                                          std::optional<double> merge) {
  std::error_code none;
  for (const fs::path& path : {folder / name, fs::path(name)})
    if (file.empty() && fs::is_regular_file(path, none)) file = fs::absolute(path).lexically_normal();
  if (file.empty())
    refuse(name,
           "is neither a file, beside the scene or here, nor icosahedron:, graded:, rectangle:, "
           "quadrilaterals: or refined:; check the path");
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  try {
    if (is_stencil_text(text)) return parse_stencils(text);
    return parse_mesh(text, merge);
  } catch (const MeshError& error) {
    throw BadInput(key, fmt::format("{} = {}: {}{}: {}", key, name, file.filename().string(),
                                    error.line > 0 ? fmt::format(":{}", error.line) : "", error.what()));
  }
}

}  // namespace

std::variant<Mesh, StencilList> named_mesh(const std::string& name, const fs::path& folder, fs::path& file,
                                           int halvings, std::optional<double> merge) {
  constexpr int most = 3000;
  file.clear();
  Mesh mesh;
  if (name.starts_with("icosahedron:"))
    return icosahedral_sphere(whole(name, numbers(name, "icosahedron:LEVEL")[0], 0, 9));
  if (name.starts_with("refined:")) {
    const auto n = numbers(name, "refined:LENGTH,DURATION,NX,NT");
    const double scale = std::ldexp(1.0, halvings);
    const int cells = whole(name, scale * n[2], 9, most), steps = whole(name, scale * n[3], 2, most);
    if (cells % 3 != 0) refuse(name, fmt::format("{} cells have no middle third; use a multiple of 3", cells));
    return refined_piece(positive(name, n[0]), positive(name, n[1]), cells, steps);
  }
  if (name.starts_with("graded:")) {
    const auto n = numbers(name, "graded:LENGTH,POINTS,RATIO");
    mesh = graded_interval(positive(name, n[0]), whole(name, n[1], 3, 10'000'000), positive(name, n[2]));
  } else if (name.starts_with("rectangle:") || name.starts_with("quadrilaterals:")) {
    const bool quadrilaterals = name.starts_with("q");
    const auto n = numbers(name, fmt::format("{}:WIDTH,HEIGHT,NX,NY", quadrilaterals ? "quadrilaterals" : "rectangle"));
    mesh = rectangle_mesh(positive(name, n[0]), positive(name, n[1]), whole(name, n[2], 1, most),
                          whole(name, n[3], 1, most), quadrilaterals);
  } else {
    return read_file(name, folder, file, merge);
  }
  if (const auto fault = find_fault(mesh)) refuse(name, fault->what);
  return mesh;
}

namespace {

/// The points of a coarser mesh come first, in their order, as refined() has them.
Mesh in_order_of(const Mesh& coarse, Mesh fine) {
  std::map<Mesh::Point, std::int32_t> number;
  for (const Mesh* mesh : {&coarse, static_cast<const Mesh*>(&fine)})
    for (const Mesh::Point& p : mesh->points) number.emplace(p, static_cast<std::int32_t>(number.size()));
  for (std::int32_t& vertex : fine.vertices) vertex = number[fine.points[at(vertex)]];
  for (const auto& [point, n] : number) fine.points[at(n)] = point;
  return fine;
}

}  // namespace

Mesh finer_mesh(const std::string& name, Mesh mesh, int halvings) {
  constexpr std::string_view sphere = "icosahedron:";
  fs::path none;
  if (name.starts_with(sphere)) {
    for (int finer = 1; finer <= halvings; ++finer)
      mesh = in_order_of(
          mesh, std::get<Mesh>(named_mesh(
                    fmt::format("{}{}", sphere, number_of(name.substr(sphere.size()), key) + finer), {}, none)));
    return mesh;
  }
  constexpr int most = 10'000'000;
  for (; halvings > 0; --halvings) {
    if (mesh.cells() > most / 4)
      refuse(name, fmt::format("has more than {} cells when it is cut; use fewer levels", most));
    mesh = refined(mesh);
  }
  return mesh;
}

}  // namespace delf
