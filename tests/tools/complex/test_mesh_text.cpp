// SPDX-License-Identifier: MIT
#include <optional>
#include <string>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/complex/mesh_text.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

std::string fault_of(const std::string& text, std::optional<double> merge = {}) {
  try {
    parse_mesh(text, merge);
  } catch (const MeshError& error) {
    return std::to_string(error.line) + ": " + error.what();
  }
  return "none";
}

std::string changed(std::string text, const std::string& before, const std::string& after) {
  REQUIRE(contains(text, before));
  return text.replace(text.find(before), before.size(), after);
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
  CHECK_THAT(fault_of(changed(msh2, "3 2 2 1 1 1 5 9", "41 2 2 1 1 1 9 5")),
             Catch::StartsWith("19: cell 41 is listed"));
  CHECK_THAT(fault_of(changed(msh4, "3 1 5 9", "41 1 9 5")), Catch::StartsWith("23: cell 41 is listed"));
  const std::string squares = square + "point 2 0\npoint 2 1\ncell 0 1 2 3\ncell 1 4 5 2\n";
  CHECK(fault_of(squares + "cell 2 3 0 1\n") ==
        "9: cell 2 has the same points as cell 0: it is there twice; remove one of them");
  CHECK(fault_of(square + "cell 0 1 2 3\ncell 0 1 2 3\n") ==
        "6: cell 1 has the same points as cell 0: it is there twice; remove one of them");
  CHECK(fault_of("point 0\npoint 1\npoint 2\ncell 0 1\ncell 1 2\ncell 0 1\n") ==
        "6: cell 2 has the same points as cell 0: it is there twice; remove one of them");
}

TEST_CASE("a point of Gmsh's geometry that no cell has is left out, and the numbers of the others stay") {
  const Mesh mesh = parse_mesh(changed(msh2, "4\n1 0 0 0\n", "5\n7 0.5 0.5 0\n1 0 0 0\n"));
  CHECK(mesh.points.size() == 4);
  CHECK(mesh.point_number(0) == 1);
  CHECK(mesh.point_number(3) == 9);
  CHECK(measure(mesh, 0) + measure(mesh, 1) == Approx(1));
}

TEST_CASE("elements that are no cells are named, with a remedy") {
  CHECK_THAT(
      fault_of(changed(msh2, "3 2 2 1 1 1 5 9", "3 4 2 1 1 1 2 5 9")),
      Catch::StartsWith("19: a tetrahedron (type 4); ") && Catch::Contains("save the mesh of a curve or a surface"));
  CHECK_THAT(fault_of(changed(msh2, "3 2 2 1 1 1 5 9", "3 9 2 1 1 1 5 9 1 2 5")),
             Catch::StartsWith("19: a triangle of order 2 (type 9); ") && Catch::Contains("Mesh.ElementOrder = 1"));
  CHECK_THAT(fault_of(changed(msh2, "3 2 2 1 1 1 5 9", "3 77 2 1 1 1 5 9")),
             Catch::StartsWith("19: an element of type 77"));
}

TEST_CASE("groups of Gmsh's two formats and sides of a text are the parts of a boundary, by name or number") {
  const std::string names = "$PhysicalNames\n2\n1 1 \"inflow\"\n2 1 \"all\"\n$EndPhysicalNames\n";
  const std::string of_2 = changed(msh2, "$PhysicalNames\n1\n2 1 \"all\"\n$EndPhysicalNames\n", names);
  const std::string of_4 =
      changed(msh4, "$Nodes", names + "$Entities\n0 1 0 0\n1 0 0 0 1 0 0 1 1 0\n$EndEntities\n$Nodes");
  for (const std::string& text : {of_2, of_4, square + "cell 0 1 2\ncell 0 2 3\nside inflow 1 0\n"}) {
    const Mesh mesh = parse_mesh(text);
    REQUIRE(mesh.parts.size() == 1);
    CHECK(mesh.parts[0].name == "inflow");
    REQUIRE(mesh.parts[0].sides.size() == 1);
    CHECK(held_points(mesh, false, std::vector{PartCondition{"inflow", true}}) == std::vector<char>{1, 1, 0, 0});
  }
  CHECK(parse_mesh(msh2).parts.at(0).name == "1");
  CHECK(fault_of(square + "cell 0 1 2 3\nside left 0 4\n") ==
        "6: a side has the number of a point that is not there; correct it");
  CHECK(fault_of(square + "cell 0 1 2\ncell 0 2 3\nside diagonal 0 2\n") ==
        "7: no cell, or two of them, have this side: it is none of the boundary; correct it");
  CHECK(parse_mesh(changed(of_2, "\"inflow\"", "\"wall one\"")).parts.at(0).name == "wall one");
  CHECK(fault_of(square + "cell 0 1 2 3\nside left 0\n") == "6: a side has two points; give their numbers");
}

TEST_CASE("parts of a mesh's boundary are fixed or natural by name, with the energy kept, and others are refused") {
  const Folder folder;
  folder.write(
      "wave.ini",
      "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = quadrilaterals:2,1,16,8\ncourant = 0.3\n"
      "[boundary]\nmesh = natural\nleft = fixed\n[initial]\nphi = x\nphi_t = 0\n[run]\nuntil = 1\n[output]\nfigures = off\n");
  const Ran plan = delf_program(folder, "plan wave.ini");
  CHECK(contains(plan.out, "48 boundary points, 9 fixed, 39 natural"));
  REQUIRE(delf_program(folder, "run wave.ini --out out").code == 0);
  // φ = x is held at x = 0 and free at x = 2, where a wave of slope −1 begins: at t = 1 it has come to x = 1
  const FieldsReader fields(folder / "out/fields.h5");
  const std::vector<double> last = fields.row(fields.frames() - 1);
  const Mesh mesh = rectangle_mesh(2, 1, 16, 8, true);
  for (std::size_t p = 0; p < last.size(); ++p) {
    const double x = mesh.points[p][0];
    if (x < 0.6) CHECK(last[p] == Approx(x).margin(1e-3));
    if (x == 2) CHECK(last[p] == Approx(1).margin(0.05));
  }
  CHECK(contains(delf_program(folder, "plan wave.ini --boundary.left=natural").out, "48 boundary points, natural"));
  CHECK(contains(delf_program(folder, "plan wave.ini --boundary.left=natural --boundary.top=fixed").out,
                 "17 fixed, 31 natural"));
  const Ran other = delf_program(folder, "run wave.ini --boundary.inflow=fixed --out none");
  CHECK(other.code == 2);
  CHECK(
      contains(other.err,
               "--boundary.inflow = fixed: the mesh has no part of this name; its parts are left, right, bottom, top"));
  CHECK(delf_program(folder, "run wave.ini --boundary.left=held --out none").code == 2);
  CHECK(contains(delf_program(folder, "run sphere --boundary.left=fixed --out none").err,
                 "has no named parts; use boundary.mesh"));
  CHECK(delf_program(folder, "run kink --boundary.inflow=fixed --out none").code == 2);
  // the part stays one where the mesh is refined, and in the scene that is written
  CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(read(folder / "out/series.csv") == read(folder / "again/series.csv"));
}

TEST_CASE("a mesh that cannot be read says on which line") {
  CHECK(fault_of("") == "1: the mesh is empty; write lines like point 0 0 and cell 0 1 2");
  CHECK(fault_of(square + "cell 0 2 1\n") == "5: cell 0 is listed clockwise; list its points the other way");
  CHECK_THAT(fault_of(square + "cell 0 1 x\n"), Catch::StartsWith("5: \"x\" is not the number of a point"));
  CHECK_THAT(fault_of(square + "cells 0 1 2\n"), Catch::StartsWith("5: \"cells\" is neither point, cell nor side"));
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

TEST_CASE("a seam whose points are listed twice is refused, made one, or kept open") {
  const std::string twice = square + "point 1 0\npoint 2 0\npoint 2 1\npoint 1 1\ncell 0 1 2 3\ncell 4 5 6 7\n";
  CHECK_THAT(fault_of(twice), Catch::StartsWith("5: point 4 lies where point 1 (line 2) does") &&
                                  Catch::Contains("lattice.merge, such as 1e-06"));
  CHECK(fault_of(twice, 0.0) == "none");
  CHECK(parse_mesh(twice, 0.0).points.size() == 8);
  const Mesh one = parse_mesh(twice, 1e-6);
  CHECK(one.points.size() == 6);
  CHECK(one.cell(1)[3] == 2);
  CHECK(boundary_points(one).size() == 6);
  // so far that a cell loses a side
  CHECK_THAT(fault_of(twice, 1.0), Catch::StartsWith("9: cell 0 is degenerate"));
}

TEST_CASE("cells of a file that overlap are refused with the lines of both") {
  CHECK(fault_of(square + "point 0.5 0.5\npoint 2 0.5\npoint 2 2.1\ncell 0 1 2 3\ncell 4 5 6\n") ==
        "9: cell 1 overlaps cell 0 (line 8): a part of space would count twice; move their points, or remove one");
}

TEST_CASE("a mesh with a seam runs as one without, and plan and report tell its shape") {
  const Folder folder;
  // 4 × 2 squares; with `twice` the points at x = 2 are there for the left half and for the right one
  const auto mesh = [&](bool twice) {
    std::string text;
    int count = 0;
    std::vector<std::vector<int>> number(5, std::vector<int>(3)), right = number;
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; j <= 2; ++j) {
        text += "point " + std::to_string(i) + " " + std::to_string(j) + "\n";
        number[i][j] = count++;
      }
    right = number;
    for (std::size_t j = 0; twice && j <= 2; ++j) {
      text += "point 2 " + std::to_string(j) + "\n";
      right[2][j] = count++;
    }
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        const auto& low = i < 2 ? number : right;
        text += "cell " + std::to_string(low[i][j]) + " " + std::to_string(low[i + 1][j]) + " " +
                std::to_string(low[i + 1][j + 1]) + " " + std::to_string(low[i][j + 1]) + "\n";
      }
    return text;
  };
  folder.write("one.txt", mesh(false)), folder.write("two.txt", mesh(true));
  folder.write("g.ini",
               "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = two.txt\ncourant = 0.4\n[initial]\n"
               "phi = exp(-(x-1)^2)\n[run]\nuntil = 4\n[boundary]\nmesh = natural\n[output]\nfigures = off\n");
  const Ran refused = delf_program(folder, "run g.ini --out out");
  CHECK(refused.code == 2);
  CHECK(lines(refused.err).size() == 1);
  CHECK(contains(refused.err, "two.txt:16: point 15 lies where point 6 (line 7) does"));
  const auto last = [&](const std::string& keys) {
    const Ran ran = delf_program(folder, "run g.ini --out out " + keys);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    return std::pair(lines(read(folder / "out/series.csv")).back(), ran.out);
  };
  const auto [wanted, whole] = last("--lattice.mesh=one.txt");
  const auto [merged, of_merged] = last("--lattice.merge=1e-9");
  const auto [open, of_open] = last("--lattice.merge=0");
  CHECK(merged == wanted);
  CHECK(open != wanted);
  CHECK(contains(of_merged, "8 quadrilaterals; Euler characteristic 1, 1 boundary curve\n"));
  CHECK(contains(of_open, "Euler characteristic 2, 2 boundary curves, in 2 pieces\n"));
  CHECK(contains(delf_program(folder, "plan g.ini --lattice.merge=0").out,
                 "16 boundary points, natural\n             Euler characteristic 2, 2 boundary curves, in 2 pieces\n"));
  CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(lines(read(folder / "again/series.csv")).back() == open);
  CHECK(contains(delf_program(folder, "run sphere --run.steps=2 --lattice.merge=0 --output.figures=off --out s").err,
                 "lattice.merge"));
}
