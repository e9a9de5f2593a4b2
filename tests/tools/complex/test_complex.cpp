// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/stencil_lists.hpp"
#include "tests/tools/program.hpp"
#include "tools/complex/mesh_text.hpp"
#include "tools/complex/stencil_text.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

void scale_multipliers(const std::filesystem::path& path, double factor) {
  std::vector<double> values;
  {
    const FieldsReader file(path);
    for (int frame = 0; frame < file.frames(); ++frame)
      for (const double value : file.values(Role::multiplier, frame)) values.push_back(factor * value);
  }
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle dataset(H5Dopen2(file, "multiplier", H5P_DEFAULT), H5Dclose);
  REQUIRE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
}

nlohmann::json summary(const Folder& folder) { return nlohmann::json::parse(read(folder / "out/summary.json")); }

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

TEST_CASE("a wave on a mesh runs, is planned and verified through the program") {
  const Folder folder;
  const std::string scene = "sphere --lattice.mesh=icosahedron:2 --run.steps=40 --initial.phi=z";
  const Ran ran = delf_program(folder, "run " + scene + " --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const auto json = summary(folder);
  CHECK(json["status"] == "done");
  CHECK(json["sites"] == 162);
  CHECK(json["solve_kind"] == "explicit");
  CHECK(json["energy_error_max"] < 0.05);
  CHECK(json["residual_max"] < 1e-13);
  // figures of triangles in space, where there is gnuplot
  CHECK((contains(ran.err, "no figures") || std::filesystem::exists(folder / "out/figures/field.svg")));
  CHECK(contains(read(folder / "out/fields.xdmf"), "TopologyType=\"Triangle\" NumberOfElements=\"320\""));
  // again to the same bits, from the scene that is left
  CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
  CHECK(contains(delf_program(folder, "plan " + scene).out, "explicit, one sparse product a row"));
  CHECK(delf_program(folder, "verify " + scene + " --out v").code == 0);
  for (const char* fault : {"field", "variation", "sign"})
    CHECK(delf_program(folder, "verify " + scene + " --out v --verify.fault=" + fault).code == 1);
}

TEST_CASE("steps that the field chooses run, end by time, and run again and back to the same") {
  const Folder folder;
  const std::string scene = "sphere --lattice.mesh=icosahedron:1 --lattice.time_steps=reversible ";
  REQUIRE(delf_program(folder, "run " + scene + "--run.until=4 --output.figures=off --out out").code == 0);
  const auto json = summary(folder);
  CHECK(json["time"].get<double>() >= 4);
  CHECK(json["time"].get<double>() < 4 + json["time_step_max"].get<double>());
  CHECK(json["time_step_max"] > 1.3 * json["time_step_min"].get<double>());
  REQUIRE(delf_program(folder, "run out/scene.ini --output.figures=off --out again").code == 0);
  CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
  REQUIRE(delf_program(folder, "run " + scene + "--run.until=2 --output.figures=off --out short").code == 0);
  REQUIRE(delf_program(folder, "resume short --run.until=2.2").code == 0);  // fewer steps than a guess says are there
  REQUIRE(delf_program(folder, "resume short --run.until=4").code == 0);
  CHECK(nlohmann::json::parse(read(folder / "short/summary.json"))["time"] == json["time"]);
  const Ran verified = delf_program(folder, "verify " + scene + "--run.until=4 --out v");
  CAPTURE(verified.out, verified.err);
  CHECK(verified.code == 0);
  for (const char* part : {"time reversal", "form of the first step", "change of the energy", "not symplectic"})
    CHECK(contains(verified.out, part));
}

TEST_CASE("angles on a mesh: the same rows from any representatives, and what winds or jumps is refused") {
  const Folder folder;
  const std::string scene =
      "run sphere --lattice.mesh=icosahedron:2 --theory.fibre=S1 --run.steps=30 --output.figures=off --out ";
  // tan has the period of 4z/2 modulo pi: the same angles, between -pi and pi
  REQUIRE(delf_program(folder, scene + "one --initial.phi='4*z'").code == 0);
  const Ran other = delf_program(folder, scene + "two --initial.phi='2*atan(tan(2*z))'");
  CAPTURE(other.err);
  REQUIRE(other.code == 0);
  const auto energy = [&](const char* file) { return nlohmann::json::parse(read(folder / file))["energy_final"]; };
  CHECK(energy("two/summary.json").get<double>() == Approx(energy("one/summary.json").get<double>()).epsilon(1e-12));
  CHECK(delf_program(folder, scene + "three --initial.phi='40*z'").code == 3);                   // jumps at once
  CHECK(delf_program(folder, scene + "four --initial.phi=z --initial.phi_t='90*x'").code == 3);  // in a step
  CHECK(delf_program(folder, scene + "five --initial.phi=z --lattice.time=cells").code == 2);
  folder.write("ring.mesh",
               "point 1 1\npoint -1 1\npoint -1 -1\npoint 1 -1\npoint 2 2\npoint -2 2\npoint -2 -2\npoint 2 -2\n"
               "cell 0 4 5 1\ncell 1 5 6 2\ncell 2 6 7 3\ncell 3 7 4 0\n");
  CHECK(contains(delf_program(folder,
                              "run sphere --lattice.mesh=ring.mesh --boundary.mesh=natural --theory.fibre=S1 "
                              "--initial.phi='2*atan(y/(x + sqrt(x^2 + y^2)))' --out six")
                     .err,
                 "winds around a hole of the mesh"));
}

TEST_CASE("a run on a mesh that ends at half of its steps and goes on is the whole run, to the bit") {
  const Folder folder;
  const auto scene =
      GENERATE(as<std::string>(), "sphere --lattice.mesh=icosahedron:1",
               "sphere --lattice.mesh=icosahedron:1 --lattice.time_steps=0.02,0.05,0.03", "asynchronous");
  const std::string keys = " --output.every=3 --output.figures=off --run.steps=";
  REQUIRE(delf_program(folder, "run " + scene + keys + "41 --out whole").code == 0);
  REQUIRE(delf_program(folder, "run " + scene + keys + "20 --out out").code == 0);
  const Ran finished = delf_program(folder, "resume out");
  CHECK(finished.code == 2);
  CHECK(contains(finished.err, "the run is finished, at row 20"));
  CHECK(read(folder / "out/series.csv") != read(folder / "whole/series.csv"));
  const Ran resumed = delf_program(folder, "resume out --run.steps=41");
  CAPTURE(resumed.err);
  REQUIRE(resumed.code == 0);
  CHECK(read(folder / "out/series.csv") == read(folder / "whole/series.csv"));
  CHECK(read(folder / "out/fields.h5") == read(folder / "whole/fields.h5"));
}

TEST_CASE("a mesh that has changed is not gone on with, and what is solved at once has no checkpoint") {
  const Folder folder;
  folder.write("square.txt", square + "cell 0 1 2\ncell 0 2 3\n");
  REQUIRE(
      delf_program(folder, "run sphere --lattice.mesh=square.txt --run.steps=4 --output.figures=off --out out").code ==
      0);
  folder.write("square.txt", "point 0 0\npoint 1 0\npoint 1 1.1\npoint 0 1\ncell 0 1 2\ncell 0 2 3\n");
  const Ran moved = delf_program(folder, "resume out --run.steps=9");
  CHECK(moved.code == 2);
  CHECK(contains(moved.err, "is another mesh than the run began with"));
  REQUIRE(delf_program(folder, "run static-kink --output.figures=off --out still").code == 0);
  const Ran still = delf_program(folder, "resume still");
  CHECK(still.code == 2);
  CHECK(contains(still.err, "there is no checkpoint to resume from"));
}

TEST_CASE("a sweep of scenes on a mesh is tabulated, and bad values are refused before it begins") {
  const Folder folder;
  const std::string scene =
      "sphere --lattice.mesh=icosahedron:1 --run.until=2 --sweep.number=energy_error_max --out out";
  const Ran ran = delf_program(folder, "sweep " + scene + " --lattice.courant=0.1,0.2");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const auto json = nlohmann::json::parse(read(folder / "out/sweep.json"));
  CHECK(json["number"] == "energy_error_max");
  std::vector<double> errors;
  for (const char* courant : {"0.1", "0.2"})
    errors.push_back(nlohmann::json::parse(
        read(folder / ("out/runs/lattice.courant=" + std::string(courant)) / "summary.json"))["energy_error_max"]);
  CHECK(errors[0] < errors[1]);
  CHECK(lines(read(folder / "out/sweep.csv")).size() == 3);
  CHECK(delf_program(folder, "sweep " + scene + " --lattice.courant=0.1,-1").code == 2);
}

TEST_CASE("a static kink has the energies of Peierls and Nabarro, between sites and on one") {
  const Folder folder;
  REQUIRE(delf_program(folder, "run static-kink --output.figures=off --out out").code == 0);
  CHECK(summary(folder)["energy_final"].get<double>() == Approx(7.866565).margin(1e-6));
  REQUIRE(
      delf_program(folder, "run static-kink --initial.phi='4*atan(exp(x-20))' --lattice.mesh=graded:40,41,1 --out out")
          .code == 0);
  CHECK(summary(folder)["energy_final"].get<double>() == Approx(7.891929).margin(1e-6));
  CHECK(summary(folder)["warnings"].empty());
}

TEST_CASE("Newton's method says where a kink on a fine lattice may stand anywhere, and fails without a solution") {
  const Folder folder;
  const Ran fine =
      delf_program(folder, "run static-kink --lattice.mesh=graded:39,155,1 --output.figures=off --out out");
  CAPTURE(fine.err);
  REQUIRE(fine.code == 0);
  CHECK(summary(folder)["residual_max"].get<double>() < 1e-12);
  CHECK(summary(folder)["iterations_max"].get<int>() < 40);
  CHECK(summary(folder)["energy_final"].get<double>() == Approx(7.992844).margin(1e-6));
  CHECK(contains(summary(folder)["warnings"].dump(), "hardly change in one direction"));
  // Bratu's phi_xx = -exp(phi), 0 at both ends, has solutions up to a length of sqrt(3.5138) = 1.8745
  folder.write("bratu.ini",
               "[theory]\nname = text\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 + exp(phi)\n[lattice]\nspace = complex\n"
               "mesh = graded:1,41,1\ntime = none\n[boundary]\nmesh = fixed\n[initial]\nphi = 0\n"
               "[output]\nfigures = off\n");
  REQUIRE(delf_program(folder, "run bratu.ini --lattice.mesh=graded:1.8,41,1 --out out").code == 0);
  CHECK(summary(folder)["warnings"].empty());
  const Ran none = delf_program(folder, "run bratu.ini --lattice.mesh=graded:2,41,1 --out out");
  CHECK(none.code == 3);
  CHECK_FALSE(contains(none.err, "0.000000"));
}

TEST_CASE("elliptic problems on a mesh converge with order 2, sine-Gordon and harmonic maps to the sphere") {
  const Folder folder;
  const std::string head = "[lattice]\nspace = complex\ntime = none\nmesh = rectangle:2,1,16,8\n";
  // φ = 4 atan(exp((3x + 4y)/5 − 1)) solves Laplace φ = sin φ; it is data on the boundary, and Newton's method begins at 0.
  // z ↦ z² is conformal, so a harmonic map into the sphere in stereographic coordinates
  const std::string kink = folder.write(
      "kink.ini", "[theory]\nname = sine-gordon\n" + head + "[exact]\nphi = 4*atan(exp(0.6*x + 0.8*y - 1))\n");
  const std::string map = folder.write(
      "map.ini", "[theory]\nfields = u, v\ndensity = 0.5*u_t^2 + 0.5*v_t^2 - 2*(u_x^2 + v_x^2)/(1 + u^2 + v^2)^2\n" +
                     head + "[exact]\nu = x^2 - y^2\nv = 2*x*y\n");
  // the image of the small rectangle lies within a hemisphere, where such maps are unique
  for (const auto& [scene, coarse, fine] : {std::tuple(kink, "rectangle:2,1,16,8", "rectangle:2,1,32,16"),
                                            std::tuple(map, "rectangle:0.8,0.4,16,8", "rectangle:0.8,0.4,32,16")}) {
    const auto error = [&, file = scene](const char* mesh) {
      const Ran ran = delf_program(folder, "run " + file + " --output.figures=off --out out --lattice.mesh=" + mesh);
      CAPTURE(file, ran.err);
      REQUIRE(ran.code == 0);
      CHECK(summary(folder)["iterations_max"] < 12);
      return summary(folder)["error_l2"].get<double>();
    };
    CHECK(std::log2(error(coarse) / error(fine)) == Approx(2).margin(0.2));
    CHECK(delf_program(folder, "verify " + scene + " --out v --lattice.mesh=" + coarse).code == 0);
  }
}

TEST_CASE("rows of a mesh are verified from a file, and a moved point or an edited value is named") {
  const Folder folder;
  const std::string bare = "--lattice.courant=0.5 --run.steps=12 --output.every=1 --lattice.time=rows";
  REQUIRE(delf_program(folder,
                       "run asynchronous --output.figures=off " + bare + " --lattice.mesh=graded:24,41,1.05 --out out")
              .code == 0);
  const auto verify = [&](const std::string& arguments) {
    return delf_program(folder, "verify asynchronous " + bare + " --fields out/fields.h5 --out v " + arguments);
  };
  const Ran right = verify("--lattice.mesh=graded:24,41,1.05");
  CAPTURE(right.out, right.err);
  CHECK(right.code == 0);
  CHECK(contains(right.out, "rows of out/fields.h5"));
  const Ran edited = verify("--lattice.mesh=graded:24,41,1.05 --verify.fault=field");
  CHECK(edited.code == 1);
  CHECK(contains(edited.out, "the values around site"));
  const Ran moved = verify("--lattice.mesh=graded:24,41,1.06"), other = verify("--lattice.mesh=graded:24,31,1.05");
  CHECK(moved.code == 2);
  CHECK(contains(moved.err, "point 1 lies at x = "));
  CHECK(other.code == 2);
  CHECK(contains(other.err, "has 41 sites"));
  CHECK(delf_program(folder, "verify asynchronous --fields v/verify.json").code == 2);
}

namespace {

/// As a file has them.
std::string bent_cells(int sites, int rows, const std::string& fault = "") {
  StencilList list = bent_rows(sites, rows);
  const auto middle = static_cast<std::size_t>(2 * sites + 3);
  if (fault == "flipped") std::swap(list.stencils[3].sites[1], list.stencils[3].sites[3]);
  if (fault == "doubled") list.stencils.push_back(list.stencils[4]);
  if (fault == "moved") list.sites[middle].position[1] += 0.01;
  if (fault == "too much") list.sites[middle].role = SiteRole::initial;
  if (fault == "too little") list.sites[middle].role = SiteRole::final;
  return stencil_text(list);
}

}  // namespace

TEST_CASE("a finite complex of mixed shapes runs, is planned and verified, and its faults are named") {
  const Folder folder;
  folder.write("coarse.mesh", bent_cells(17, 11)), folder.write("fine.mesh", bent_cells(33, 21));
  folder.write("kink.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nspace = complex\nmesh = coarse.mesh\n"
               "[exact]\nphi = 4*atan(exp((x - 1.5 - 0.3*t)/sqrt(0.91)))\n[output]\nfigures = off\n");
  const auto error = [&](const std::string& mesh) {
    const Ran ran = delf_program(folder, "run kink.ini --out out --lattice.mesh=" + mesh);
    CAPTURE(ran.out, ran.err);
    REQUIRE(ran.code == 0);
    CHECK(summary(folder)["residual_max"] < 1e-13);
    CHECK(summary(folder)["energy_final"].is_null());
    return summary(folder)["error_l2"].get<double>();
  };
  const double fine = error("fine.mesh"), coarse = error("coarse.mesh");
  CHECK(std::log2(coarse / fine) == Approx(2).margin(0.2));
  CHECK(contains(delf_program(folder, "plan kink.ini").out, "39 levels, 135 unknowns in 65 blocks, the largest of 15"));
  CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
  CHECK(delf_program(folder, "verify kink.ini --out v").code == 0);
  CHECK(delf_program(folder, "verify kink.ini --fields out/fields.h5 --out v").code == 0);
  // Noether's theorem for turns of two fields, and for what is no turn
  folder.write("two.ini",
               "[theory]\nfields = u, v\ndensity = 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2) - 0.25*(u^2 + v^2 - 1)^2\n"
               "[lattice]\nspace = complex\nmesh = coarse.mesh\n[initial]\nu = 1 + 0.1*x + 0.2*t\nv = 0.3*x - t\n");
  const Ran turned = delf_program(folder, "verify two.ini --verify.generator=-v,u --out v");
  CAPTURE(turned.out, turned.err);
  CHECK(turned.code == 0);
  CHECK(contains(turned.out, "Noether, generator"));
  CHECK(delf_program(folder, "verify two.ini --verify.generator=-v,2*u --out v").code == 1);
  for (const char* fault : {"field", "variation", "sign"})
    CHECK(delf_program(folder, std::string("verify kink.ini --out v --verify.fault=") + fault).code == 1);

  for (const auto& [fault, command, part] :
       {std::tuple("flipped", "run", "bad.mesh:192: stencil 3 (rectangle) is listed the wrong way round"),
        std::tuple("doubled", "run", "is stencil 4 again (line 193)"),
        std::tuple("moved", "verify --fields out/fields.h5", "site 37 lies at x = "),
        std::tuple("too much", "plan", "more equations than unknowns at site"),
        std::tuple("too little", "plan", "no equation is left for the values of site")}) {
    folder.write("bad.mesh", bent_cells(17, 11, fault));
    const Ran ran = delf_program(folder, std::string(command) + " kink.ini --lattice.mesh=bad.mesh");
    CAPTURE(fault, ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, part));
  }
  folder.write("bad.mesh", "complex\nsite 0 0\nsite 1 2 begin\n");
  CHECK(contains(delf_program(folder, "run kink.ini --lattice.mesh=bad.mesh").err, "bad.mesh:3: \"begin\" is neither"));
  folder.write("bad.mesh", "complex\nstencil triangel 0 1 2\n");
  CHECK(contains(delf_program(folder, "run kink.ini --lattice.mesh=bad.mesh").err, "bad.mesh:2: \"triangel\" is no"));
  CHECK(contains(delf_program(folder, "run kink.ini --run.until=3").err, "where sites have times of their own"));
}

TEST_CASE(
    "a kink in a locally refined piece of spacetime converges with order 2, and has figures and cells for ParaView") {
  const Folder folder;
  const Ran run = delf_program(folder, "run refined-kink --output.format=svg --out out");
  CAPTURE(run.out, run.err);
  REQUIRE(run.code == 0);
  CHECK(summary(folder)["warnings"].empty());
  CHECK(summary(folder)["residual_max"] < 1e-13);
  CHECK(summary(folder)["energy_final"].is_null());  // columns of sites have steps of their own
  CHECK(std::filesystem::exists(folder / "out/figures/field.svg") ==
        std::filesystem::exists(folder / "out/figures/levels.svg"));
  CHECK(delf_program(folder, "verify refined-kink --out v").code == 0);

  // rectangles, and three triangles beside each at the edges of the middle third
  const std::string xdmf = read(folder / "out/fields.xdmf");
  CHECK(contains(xdmf, "TopologyType=\"Mixed\" NumberOfElements=\"3040\"><DataItem Dimensions=\"14960\""));
  CHECK(contains(xdmf, "GeometryType=\"XY\"><DataItem Dimensions=\"3009 2\""));
  int triangles = 0, rectangles = 0;
  for (const std::string& line : lines(xdmf)) triangles += line.starts_with("4 "), rectangles += line.starts_with("5 ");
  CHECK(triangles == 240);
  CHECK(rectangles == 2800);
  CHECK(4 * triangles + 5 * rectangles == 14960);

  const std::string levels =
      "convergence refined-kink --lattice.mesh=refined:18,5,36,20 --out c --convergence.levels=3 ";
  const Ran right = delf_program(folder, levels + "--convergence.order=2");
  CAPTURE(right.out);
  CHECK(right.code == 0);
  CHECK(contains(right.out, "those of all sites"));
  CHECK(delf_program(folder, levels + "--convergence.order=1.5").code == 1);
  CHECK(delf_program(folder, levels + "--convergence.order=2.5").code == 1);
}

TEST_CASE(
    "a beam on a complex of unequal six-tuples runs and is verified, faults are found, and other shapes refused") {
  const Folder folder;
  const double turn = 2 * std::acos(-1.0);
  StencilList list = beam_rows(16, 5, turn, 0.05, [&](int i) { return turn * i / 16 + 0.2 * std::sin(turn * i / 16); });
  folder.write("beam.mesh", stencil_text(list));
  list.stencils[3] = {"triangle", {2, 18, 3}};
  folder.write("other.mesh", stencil_text(list));
  folder.write("beam.ini",
               "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_xx^2 + 0.1*cos(phi)\n[lattice]\nspace = complex\n"
               "mesh = beam.mesh\n[initial]\nphi = cos(x - t)\n[output]\nfigures = off\n");
  const Ran ran = delf_program(folder, "run beam.ini --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  CHECK(summary(folder)["residual_max"].get<double>() < 1e-12);
  const Ran right = delf_program(folder, "verify beam.ini --out v");
  CAPTURE(right.out);
  CHECK(right.code == 0);
  for (const char* fault : {"field", "variation", "sign"})
    CHECK(delf_program(folder, std::string("verify beam.ini --out v --verify.fault=") + fault).code == 1);
  for (const char* command : {"run --out no", "plan", "verify --out no"}) {
    const Ran refused = delf_program(folder, std::string(command) + " beam.ini --lattice.mesh=other.mesh");
    CAPTURE(command, refused.err);
    CHECK(refused.code == 2);
    CHECK(lines(refused.err).size() == 1);
    CHECK(
        contains(refused.err, "line 86: stencil 3 (triangle) has no phi_xx, which the density reads; use a six-tuple"));
  }
}

TEST_CASE("threads share wide levels of a finite complex, and the plan says which") {
  const Folder folder;
  // rows of leapfrog on a circle, and of (5.10), where a row is one block
  const auto rows = [](const std::string& shape) {
    constexpr int sites = 2100, count = 4;
    StencilList list;
    list.circumference = 210;
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < sites; ++i)
        list.sites.push_back({{0.04 * j, 0.1 * i, 0, 0},
                              j == 0           ? SiteRole::given
                              : j == 1         ? SiteRole::initial
                              : j == count - 1 ? SiteRole::final
                                               : SiteRole::free});
    for (int s = 0; s < sites * (count - 1); ++s) {
      const int next = s % sites == sites - 1 ? s + 1 - sites : s + 1;
      if (shape == "rectangle") list.stencils.push_back({shape, {s, s + sites, next + sites, next}});
      else list.stencils.push_back({shape, {s, s + sites, next + sites}});
    }
    return stencil_text(list);
  };
  folder.write("explicit.mesh", rows("triangle-vertex")), folder.write("implicit.mesh", rows("rectangle"));
  folder.write("pulse.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nspace = complex\nmesh = explicit.mesh\n"
               "[initial]\nphi = 3*exp(-(x - 30)^2)\n[output]\nfigures = off\nfields = off\n");
  const Ran plan = delf_program(folder, "plan pulse.ini --run.threads=2");
  CHECK(contains(plan.out, "2 levels, 4200 unknowns, each in a block of its own"));
  CHECK(contains(plan.out, "levels     2100 blocks a level, 2100 in the widest"));
  CHECK(contains(plan.out, "threads    2\n"));
  CHECK_FALSE(contains(delf_program(folder, "plan pulse.ini").out, "threads"));
  CHECK(contains(delf_program(folder, "plan pulse.ini --lattice.mesh=implicit.mesh --run.threads=2").out,
                 "threads    1 of 2: a level is shared by parts of 1024 unknowns or more"));
  const auto series = [&](const std::string& more) {
    REQUIRE(delf_program(folder, "run pulse.ini --out out " + more).code == 0);
    return read(folder / "out/series.csv");
  };
  const std::string one = series("--run.threads=1");
  CHECK(series("--run.threads=3") == one);
  CHECK(series("--initial.phi='3*exp(-(x - 30.01)^2)'") != one);
  CHECK(delf_program(folder, "run sphere --run.threads=2").code == 2);
  // the pulse moves apart: one slab of energy after each row but the first
  CHECK(lines(one).size() == 4);
  CHECK(summary(folder)["energy_error_max"].get<double>() < 1e-3);
  CHECK(contains(delf_program(folder, "convergence pulse.ini --out c").err, "is a finite complex of a file"));
  CHECK(contains(delf_program(folder, "convergence pulse.ini --lattice.mesh=refined:60,1,36,20 --out c").err,
                 "compared with a solution alone"));
  CHECK(contains(delf_program(folder, "plan pulse.ini --lattice.mesh=refined:60,1,35,20").err, "multiple of 3"));
}

TEST_CASE("waves on spheres and graded intervals converge with order 2, and a missed order fails") {
  const Folder folder;
  // z = cos θ is the first harmonic: z cos(√2 t) solves the wave equation on the sphere
  const std::string sphere =
      "sphere --theory.name=wave --lattice.mesh=icosahedron:2 --exact.phi='z*cos(sqrt(2)*t)' "
      "--run.until=1 --convergence.levels=3 --out out ";
  const Ran right = delf_program(folder, "convergence " + sphere + "--convergence.order=2");
  CAPTURE(right.out, right.err);
  CHECK(right.code == 0);
  const auto json = nlohmann::json::parse(read(folder / "out/convergence.json"));
  CHECK(json["levels"].size() == 3);
  CHECK(json["levels"][2]["sites"] == 2562);
  CHECK(delf_program(folder, "convergence " + sphere + "--convergence.order=3").code == 1);
  // a graded mesh, and a sphere without a solution: differences at the points of the coarser mesh
  for (const char* scene : {"asynchronous --lattice.time=rows --lattice.mesh=graded:24,41,1.02 --run.until=2",
                            "sphere --lattice.mesh=icosahedron:2 --initial.phi=z --run.until=1"}) {
    const Ran ran = delf_program(
        folder, std::string("convergence ") + scene + " --convergence.levels=3 --convergence.order=2 --out out");
    CAPTURE(ran.out, ran.err);
    CHECK(ran.code == 0);
  }
}

TEST_CASE("nonsense on a mesh is no success") {
  const Folder folder;
  const Ran huge = delf_program(folder, "run sphere --initial.phi='1e308*x' --lattice.mesh=icosahedron:1 --out out");
  CHECK(huge.code == 3);
  CHECK(summary(folder)["status"] == "not-finite");
  REQUIRE(
      delf_program(folder, "run asynchronous --output.figures=off --lattice.courant=2 --run.until=3 --out out").code ==
      0);
  CHECK(contains(summary(folder)["warnings"].dump(), "the energy of the last row is"));
  CHECK(summary(folder)["residual_max"].is_null());
  REQUIRE(delf_program(folder, "run asynchronous --run.until=3 --output.format=svg --out out").code == 0);
  CHECK(summary(folder)["warnings"].empty());
  const bool drawn = std::filesystem::exists(folder / "out/figures/field.svg");
  CHECK(std::filesystem::exists(folder / "out/figures/updates.svg") == drawn);
  CHECK_FALSE(std::filesystem::exists(folder / "out/figures/field.png"));
}

TEST_CASE("a scene on a mesh with an error is refused in one line") {
  const Folder folder;
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    const Ran ran = delf_program(folder, arguments);
    CAPTURE(arguments, ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, part));
  };
  folder.write("bad.mesh", square + "cell 0 1 2\ncell 0 3 2\n");
  refused("run sphere --lattice.mesh=bad.mesh", "bad.mesh:6: cell 1 is listed clockwise");
  refused("run sphere --lattice.mesh=icosahedron:99", "99 must be a whole number from 0 to 9");
  refused("run sphere --lattice.sites=10", "not applicable to lattice.space = complex");
  refused("run sphere '--theory.density=0.5*phi_t^2 - phi_x^4'", "is not quadratic in phi_x");
  refused("stability sphere", "works with run, resume, plan, verify, sweep and convergence");
  refused("convergence sphere --lattice.time_steps=0.1,0.2", "are not refined");
  refused("run sphere --lattice.time_steps=0.1,-1", "steps must be above 0");
  refused("run sphere --lattice.step_control=2", "has no effect without lattice.time_steps = reversible");
  refused("convergence sphere --lattice.time_steps=reversible", "reversible steps end at times of their own");
  refused("run sphere --lattice.time_steps=reversible '--theory.density=0.5*phi_t^2 + phi_t^4 - phi_x^2'",
          "need a density quadratic in phi_t");
  refused("run sphere --initial.speed=0.3", "has no effect on a mesh");
  refused("run sphere --exact.u=x", "--exact.u: unknown key; the fields of the theory have exact.phi");
  const std::string rest = "phi3 = 0\nphi1 = 1\n[run]\nsteps = 2\n";
  folder.write("map.ini",
               "[theory]\nname = wave-map\n[lattice]\nspace = complex\nmesh = icosahedron:1\ncourant = 0.3\n"
               "[initial]\nphi2 = 0\n" +
                   rest);
  folder.write("short.ini",
               "[theory]\nname = wave-map\n[lattice]\nspace = complex\nmesh = icosahedron:1\n"
               "courant = 0.3\n[initial]\n" +
                   rest);
  refused("run map.ini --exact.u=1", "unknown key; the fields of the theory have exact.phi1, exact.phi2, exact.phi3");
  refused("run map.ini --exact.phi1=1", "must be given for all of the fields phi1, phi2, phi3 or for none of them");
  refused("run short.ini",
          "initial.phi2: must be given on a mesh, as a formula of x, y and z; or exact.phi2 as one of t too (the "
          "fields are "
          "phi1, phi2, phi3)");
  refused("run sphere --initial.phi=x*t", "reads t");
  refused("run static-kink --run.until=3", "has no effect with lattice.time = none");
  refused("plan sphere --latex", "is for lattices");
}

TEST_CASE("a bisection on a mesh finds the step at which the energy is off by so much") {
  const Folder folder;
  const Ran ran =
      delf_program(folder,
                   "sweep sphere --lattice.mesh=icosahedron:1 --run.until=3 --output.figures=off "
                   "--output.fields=off --sweep.keep=table --sweep.number=energy_error_max "
                   "--sweep.level=0.05 --sweep.bisect=lattice.courant=0.1:0.5 --sweep.accuracy=0.02 --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const auto found = nlohmann::json::parse(read(folder / "out/sweep.json"))["threshold"];
  CHECK(found["key"] == "lattice.courant");
  CHECK(found["high"].get<double>() - found["low"].get<double>() <= 0.02);
  CHECK(found["at_low"].get<double>() <= 0.05);
  CHECK(found["at_high"].get<double>() > 0.05);
  CHECK(delf_program(folder,
                     "sweep sphere --lattice.mesh=icosahedron:1 --run.until=3 --sweep.number=energy_error_max "
                     "--sweep.level=9 --sweep.bisect=lattice.courant=0.1:0.5 --out other")
            .code == 2);
}

namespace {

// Two fields in a well that is round, or not.
std::string two_fields(const std::string& well) {
  return "[theory]\nfields = u, v\ndensity = 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2) - 0.25*(" + well +
         " - 1)^2\n[lattice]\nspace = complex\nmesh = rectangle:2,1,8,4\ncourant = 0.3\n[boundary]\nmesh = natural\n"
         "[initial]\nu = 1 + 0.2*x\nu_t = 0.3*y\nv = 0.1*y\nv_t = 0.5\n[run]\nsteps = 20\n[output]\nfigures = off\n";
}

}  // namespace

TEST_CASE("Noether's theorem is verified on meshes, and the momenta of symmetries are in series and summary") {
  const Folder folder;
  folder.write("round.ini", two_fields("u^2 + v^2") + "[verify]\ngenerator = -v, u\n");
  folder.write("flat.ini", two_fields("u^2 + 2*v^2") + "[verify]\ngenerator = -v, u\n");
  for (const char* more : {"", " --lattice.time=cells", " --boundary.mesh=fixed"}) {
    const Ran right = delf_program(folder, std::string("verify round.ini --out v") + more);
    CAPTURE(more, right.out, right.err);
    CHECK(right.code == 0);
    CHECK(contains(right.out, "Noether, generator (-v, u)"));
    const Ran wrong = delf_program(folder, std::string("verify flat.ini --out v") + more);
    CHECK(wrong.code == 1);
    CHECK(contains(wrong.out, "is not a symmetry"));
    CHECK_FALSE(contains(wrong.out, "What flows into"));
    CHECK(contains(delf_program(folder, std::string("verify flat.ini --verify.force=on --out v") + more).out,
                   "What flows into"));
  }
  // rows that solve nothing at one site
  CHECK(delf_program(folder, "run round.ini --output.every=1 --out out").code == 0);
  CHECK(delf_program(folder, "verify round.ini --fields out/fields.h5 --out v").code == 0);
  CHECK(delf_program(folder, "verify round.ini --fields out/fields.h5 --verify.fault=field --out v").code == 1);

  const std::string rotation = " --theory.symmetry='-v, u'";
  for (const char* more : {"", " --lattice.time=cells", " --lattice.time_steps=0.02,0.03"}) {
    const Ran ran = delf_program(folder, "run round.ini --out out" + rotation + more);
    CAPTURE(more, ran.err);
    REQUIRE(ran.code == 0);
    CHECK(contains(lines(read(folder / "out/series.csv")).front(), ",residual,symmetry"));
    const auto json = summary(folder)["conserved"];
    REQUIRE(json.size() == 1);
    CHECK(json[0]["name"] == "symmetry");
    CHECK(std::abs(json[0]["initial"].get<double>()) > 0.1);
    CHECK(json[0]["error_max"].get<double>() < 1e-13);
  }
  CHECK(delf_program(folder, "run round.ini --out out --boundary.mesh=fixed" + rotation).code == 0);
  CHECK(summary(folder)["conserved"][0]["error_max"].get<double>() > 1e-4);
}

TEST_CASE("wave maps and harmonic maps keep their constraint on meshes through the program") {
  const Folder folder;
  const std::string head = "[theory]\nname = wave-map\n[lattice]\nspace = complex\n";
  const std::string wave =
      "[boundary]\nmesh = natural\n[exact]\nphi1 = tanh(x - 12)*cos(t)\nphi2 = tanh(x - 12)*sin(t)\n"
      "phi3 = sqrt(1 - tanh(x - 12)^2)\n[run]\nuntil = 1\n[output]\nfigures = off\n";
  folder.write("wave.ini", head + "mesh = graded:24,97,1\ncourant = 0.3\n" + wave);
  folder.write("still.ini", head +
                                "mesh = rectangle:0.8,0.8,8,8\ntime = none\n[exact]\nphi1 = 2*x/(1 + x^2 + y^2)\n"
                                "phi2 = 2*y/(1 + x^2 + y^2)\nphi3 = (1 - x^2 - y^2)/(1 + x^2 + y^2)\n"
                                "[initial]\nphi1 = 0\nphi2 = 0\nphi3 = 1\n[output]\nfigures = off\n");
  for (const std::string scene : {"wave.ini", "still.ini"}) {
    const Ran ran = delf_program(folder, "run " + scene + " --out out");
    CAPTURE(scene, ran.out, ran.err);
    REQUIRE(ran.code == 0);
    CHECK(summary(folder)["constraint_max"].get<double>() < 1e-13);
    CHECK(delf_program(folder, "verify " + scene + " --out v").code == 0);
    CHECK(delf_program(folder, "verify " + scene + " --fields out/fields.h5 --out v").code == 0);
    for (const char* fault : {"field", "variation", "sign"})
      CHECK(delf_program(folder, "verify " + scene + " --out v --verify.fault=" + fault).code == 1);
    CHECK(delf_program(folder, "convergence " + scene + " --convergence.levels=2 --out c").code == 0);
  }
  // a map that is constant, all of whose terms are rounding
  const std::string constant = "still.ini --exact.phi1=0.36 --exact.phi2=0.48 --exact.phi3=0.8 --out out";
  REQUIRE(delf_program(folder, "run " + constant).code == 0);
  CHECK(summary(folder)["residual_max"].get<double>() < 1e-14);
  REQUIRE(delf_program(folder, "run wave.ini --out out").code == 0);
  CHECK(contains(lines(read(folder / "out/series.csv")).front(), ",residual,constraint,rotation_x,"));
  const auto wave_map = summary(folder);  // kept: a loop over a member of a temporary reads it after its end
  for (const auto& sum : wave_map["conserved"]) CHECK(sum["error_max"].get<double>() < 1e-13);
  CHECK(contains(delf_program(folder, "plan wave.ini").out, "388 unknowns in 97 blocks, the largest of 4"));
  // to the bit, in two parts
  REQUIRE(delf_program(folder, "run wave.ini --out half --run.until=0.5").code == 0);
  REQUIRE(delf_program(folder, "resume half --run.until=1").code == 0);
  CHECK(lines(read(folder / "half/series.csv")).back() == lines(read(folder / "out/series.csv")).back());

  // Multipliers are recorded with the row that they were found with, and a verification reads them.
  for (const std::string scene : {"wave.ini", "still.ini"}) {
    CAPTURE(scene);
    REQUIRE(
        delf_program(folder, "run " + scene + (scene == "wave.ini" ? " --output.every=1" : "") + " --out out").code ==
        0);
    if (scene == "wave.ini") {
      const FieldsReader file(folder / "out/fields.h5");
      CHECK(file.shape(Role::multiplier).components == 1);
      CHECK(std::ranges::all_of(file.values(Role::multiplier, 0), [](double value) { return value == 0; }));
      CHECK(std::ranges::none_of(file.values(Role::multiplier, 2), [](double value) { return value == 0; }));
    }
    const std::string verify = "verify " + scene + " --fields out/fields.h5 --out v";
    CHECK(delf_program(folder, verify).code == 0);
    scale_multipliers(folder / "out/fields.h5", 1.001);
    const Ran edited = delf_program(folder, verify);
    CAPTURE(edited.out, edited.err);
    CHECK(edited.code == 1);
    CHECK(contains(edited.out, "FAILED: field equations"));
  }

  const auto refused = [&](const std::string& arguments, const char* why) {
    const Ran ran = delf_program(folder, "run " + arguments + " --out no");
    CAPTURE(arguments, ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, why));
  };
  refused("wave.ini --lattice.time=cells", "a constraint on a mesh is for lattice.time = rows or none");
  refused("wave.ini --lattice.time_steps=reversible", "reversible steps are for theories without a constraint");
  refused("wave.ini --exact.phi1=1", "exact.phi1 = 1: breaks the constraint at point 0 of the mesh");
  CHECK(delf_program(folder, "run still.ini --initial.phi3=0 --out no").code == 3);
}

TEST_CASE("what leaves values of a mesh or a complex free, or makes them grow, is no silent result") {
  const Folder folder;
  // a natural boundary leaves a constant
  const Ran singular = delf_program(
      folder,
      "run static-kink --theory.name=wave --boundary.mesh=natural --initial.phi=x --out out --output.figures=off");
  CHECK(singular.code == 3);
  CHECK(contains(singular.err, "leave some of its values free"));
  const Ran grown =
      delf_program(folder, "run refined-kink --lattice.mesh=refined:18,4,300,9 --out out --output.figures=off");
  CHECK(grown.code == 0);
  CHECK(contains(grown.out, "the field grows to"));
  CHECK_FALSE(contains(delf_program(folder, "run refined-kink --out out --output.figures=off").out, "grows to"));
  // a start that nothing reads
  CHECK(contains(delf_program(folder, "run asynchronous --initial.phi=0 --run.steps=1 --out out").err,
                 "no effect, as exact.phi gives the start too"));
  const Ran missing = delf_program(folder, "verify sphere --fields nowhere.h5");
  CHECK(missing.code == 2);
  CHECK(contains(missing.err, "--fields nowhere.h5: no such file"));
  folder.write("text.h5", "no rows");
  const Ran text = delf_program(folder, "verify sphere --fields text.h5");
  CHECK(text.code == 2);
  CHECK(contains(text.err, "--fields: text.h5: is not an HDF5 file"));
}
