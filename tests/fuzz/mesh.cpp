// SPDX-License-Identifier: MIT
#include "lattice/error.hpp"
#include "tests/fuzz/target.hpp"
#include "tools/complex/mesh_text.hpp"

// A mesh: points and cells line by line, or what Gmsh writes.
void delf::fuzz::read_bytes(std::string_view bytes) {
  try {
    parse_mesh(bytes);
  } catch (const MeshError& error) {
    throw BadInput("lattice.mesh", error.what());
  }
}
