// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>

#include "lattice/space/mesh.hpp"
#include "schemes/complex/stencil_list.hpp"

namespace delf {

/// What is wrong with the text of a mesh, and on which line.
struct MeshError : std::runtime_error {
  MeshError(int line_, const std::string& what) : std::runtime_error(what), line(line_) {}
  int line;
};

/// A mesh from text: Gmsh's MSH 2.2 or 4.1 (ASCII) if the first line is $MeshFormat, else lines
///
///     point X [Y [Z]]
///     cell I J [K [L]]        points by number from 0; # begins a comment
///
/// Of Gmsh's elements those of the highest dimension are the cells; points, lines and the like around them are boundaries,
/// and passed over. Points no further apart than `merge` are made one; without it points at one place are a fault, and with
/// 0 they are those of a seam that is open. Throws MeshError for what cannot be read, for every fault of find_fault(), and
/// for cells that overlap.
Mesh parse_mesh(std::string_view text, std::optional<double> merge = {});

/// What lattice.mesh names: a generator icosahedron:LEVEL, graded:LENGTH,POINTS,RATIO, rectangle:WIDTH,HEIGHT,NX,NY,
/// quadrilaterals:WIDTH,HEIGHT,NX,NY or refined:LENGTH,DURATION,NX,NT, else a file, beside `folder` or here: a mesh, or a
/// finite complex if it begins with the line `complex` (see parse_stencils()). `file` receives its path, empty for a
/// generator. A generated complex is made with its cells and steps halved so often; for meshes see finer_mesh(). `merge`: see
/// parse_mesh(). Throws BadInput "lattice.mesh".
std::variant<Mesh, StencilList> named_mesh(const std::string& name, const std::filesystem::path& folder,
                                           std::filesystem::path& file, int halvings = 0,
                                           std::optional<double> merge = {});
/// The mesh of that name with its sides halved so often: icosahedra of the next levels, and others cut (see refined()).
Mesh finer_mesh(const std::string& name, Mesh, int halvings);

}  // namespace delf
