// SPDX-License-Identifier: MIT
#include <string>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/complex/mesh_text.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

std::string fault_of(const std::string& text) {
  try {
    parse_mesh(text);
  } catch (const MeshError& error) {
    return std::to_string(error.line) + ": " + error.what();
  }
  return "none";
}

const std::string square = "point 0 0\npoint 1 0\npoint 1 1\npoint 0 1\n";
const std::string msh2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"all\"\n$EndPhysicalNames\n"
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n5 1 1 0\n9 0 1 0\n$EndNodes\n"
    "$Elements\n3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 5\n3 2 2 1 1 1 5 9\n$EndElements\n";
const std::string msh4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 4 1 9\n1 1 0 2\n1\n2\n0 0 0\n1 0 0\n2 1 0 2\n5\n9\n1 1 0\n0 1 "
    "0\n$EndNodes\n"
    "$Elements\n2 3 1 3\n1 1 1 1\n1 1 2\n2 1 2 2\n2 1 2 5\n3 1 5 9\n$EndElements\n";

}  // namespace

TEST_CASE("meshes are read from text and from Gmsh's two formats") {
  for (const std::string& text : {square + "cell 0 1 2 # half\n\ncell 0 2 3\n", msh2, msh4}) {
    const Mesh mesh = parse_mesh(text);
    CHECK(mesh.points.size() == 4);
    REQUIRE(mesh.cells() == 2);
    CHECK(mesh.dimension == 2);
    CHECK(mesh.cell(1)[2] == 3);
    CHECK(measure(mesh, 0) + measure(mesh, 1) == Approx(1));
  }
}

TEST_CASE("a fault of a mesh of Gmsh is named by the numbers of the file, and a cell that is there twice as such") {
  const auto changed = [](std::string text, const std::string& before, const std::string& after) {
    REQUIRE(contains(text, before));
    return text.replace(text.find(before), before.size(), after);
  };
  CHECK_THAT(fault_of(changed(msh2, "3 2 2 1 1 1 5 9", "41 2 2 1 1 1 9 5")),
             Catch::StartsWith("19: cell 41 is listed"));
  CHECK_THAT(fault_of(changed(msh4, "3 1 5 9", "41 1 9 5")), Catch::StartsWith("23: cell 41 is listed"));
  CHECK_THAT(fault_of(changed(msh2, "1 5 9", "1 2 5")), Catch::StartsWith("13: point 9 is in no cell"));
  const std::string squares = square + "point 2 0\npoint 2 1\ncell 0 1 2 3\ncell 1 4 5 2\n";
  CHECK(fault_of(squares + "cell 2 3 0 1\n") ==
        "9: cell 2 has the same points as cell 0: it is there twice; remove one of them");
  CHECK(fault_of(square + "cell 0 1 2 3\ncell 0 1 2 3\n") ==
        "6: cell 1 has the same points as cell 0: it is there twice; remove one of them");
  CHECK(fault_of("point 0\npoint 1\npoint 2\ncell 0 1\ncell 1 2\ncell 0 1\n") ==
        "6: cell 2 has the same points as cell 0: it is there twice; remove one of them");
}

TEST_CASE("a mesh that cannot be read says on which line") {
  CHECK(fault_of("") == "1: the mesh is empty; write lines like point 0 0 and cell 0 1 2");
  CHECK(fault_of(square + "cell 0 2 1\n") == "5: cell 0 is listed clockwise; list its points the other way");
  CHECK_THAT(fault_of(square + "cell 0 1 x\n"), Catch::StartsWith("5: \"x\" is not the number of a point"));
  CHECK_THAT(fault_of(square + "cells 0 1 2\n"), Catch::StartsWith("5: \"cells\" is neither point nor cell"));
  CHECK_THAT(fault_of("point 0 1e999\n"), Catch::StartsWith("1: "));
  CHECK_THAT(fault_of(square + "cell 0 1 2\n"), Catch::StartsWith("4: point 3 is in no cell"));
  // every line of a file of Gmsh, cut off behind it, and with a word that is none
  for (const std::string& text : {msh2, msh4})
    for (std::size_t end = text.find('\n'); end + 1 < text.size(); end = text.find('\n', end + 1)) {
      CHECK(fault_of(text.substr(0, end)) != "none");
      CHECK_NOTHROW(fault_of(text.substr(0, end + 1) + "? " + text.substr(end + 1)));
    }
  std::string binary = msh2;
  binary.replace(binary.find("2.2 0"), 5, "2.2 1");
  CHECK(fault_of(binary) == "2: a binary file; save it as ASCII (Mesh.Binary = 0)");
}
