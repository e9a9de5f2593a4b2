// SPDX-License-Identifier: MIT
#include <cmath>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
using delf::FieldsReader;

TEST_CASE("a run goes on from the rows of another") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  const auto scene = GENERATE(as<std::string>(), "small.ini --lattice.stencil=triangle-vertex", "small.ini",
                              "kink-train --output.every=1 --output.figures=off");
  REQUIRE(delf_program(folder, "run " + scene + " --run.steps=60 --out whole").code == 0);
  const Ran part = delf_program(folder, "run " + scene +
                                            " --run.steps=35 --initial.state=file "
                                            "--initial.file=whole/fields.h5 --initial.frame=25 --out part");
  INFO(part.err);
  REQUIRE(part.code == 0);
  const FieldsReader whole(folder / "whole/fields.h5"), rest(folder / "part/fields.h5");
  CHECK(rest.winding() == whole.winding());
  for (const int frame : {0, 1, 2, 35}) {
    const auto a = whole.row(25 + frame), b = rest.row(frame);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    CHECK(largest < 1e-11);
  }
  // and its scene.ini finds the file from anywhere
  REQUIRE(delf_program(folder, "run part/scene.ini --out elsewhere/again").code == 0);
  CHECK(read(folder / "part/series.csv") == read(folder / "elsewhere/again/series.csv"));
}

TEST_CASE("a brick wall goes on from an odd frame, and rows that begin there are verified") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  const std::string hexagon = "small.ini --lattice.stencil=hexagon ";
  REQUIRE(delf_program(folder, "run " + hexagon + "--run.steps=60 --out whole").code == 0);
  const FieldsReader whole(folder / "whole/fields.h5");
  const auto distance = [&](const std::string& out, int first) {
    const FieldsReader rest(folder / out / "fields.h5");
    const auto a = whole.row(first + 20), b = rest.row(20);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
  };
  const auto goes_on = [&](const std::string& from, int frame, const std::string& more) {
    const Ran ran =
        delf_program(folder, "run " + hexagon + "--run.steps=30 --initial.state=file --initial.file=" + from +
                                 "/fields.h5 --initial.frame=" + std::to_string(frame) + " " + more);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
  };
  const auto verified = [&](const std::string& arguments) {
    return delf_program(folder, "verify " + hexagon + "--verify.checks=equations --out verified " + arguments).code;
  };
  goes_on("whole", 13, "--out odd");
  CHECK(distance("odd", 13) < 1e-11);
  CHECK(contains(read(folder / "odd/scene.ini"), "first_row = 1"));
  CHECK(verified("--fields odd/fields.h5") == 0);
  goes_on("odd", 3, "--out even");  // row 16 of the first run
  CHECK(distance("even", 16) < 1e-11);
  CHECK_FALSE(contains(read(folder / "even/scene.ini"), "first_row = 1"));
  CHECK(verified("--fields even/fields.h5") == 0);
  // bricks laid the other way are another scheme
  goes_on("whole", 13, "--lattice.first_row=0 --out wrong");
  CHECK(distance("wrong", 13) > 1e-9);
  CHECK(verified("--fields odd/fields.h5 --lattice.first_row=0") == 1);
}

TEST_CASE("a file of rows is first looked up beside the scene") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  REQUIRE(delf_program(folder, "run small.ini --run.steps=5 --out inner").code == 0);
  std::filesystem::create_directory(folder / "away");
  folder.write("inner/next.ini", small_scene("[initial]\n"));
  const Ran ran = delf_program(folder, "run ../inner/next.ini --initial.state=file --initial.file=fields.h5 --out out",
                               "cd away &&");
  INFO(ran.err);
  CHECK(ran.code == 0);
}

TEST_CASE("a file that cannot give the rows is refused, and says why") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  REQUIRE(delf_program(folder, "run small.ini --run.steps=5 --out rows").code == 0);
  REQUIRE(delf_program(folder, "run small.ini --run.steps=5 --output.every=5 --out sparse").code == 0);
  folder.write("text.h5", "this is no HDF5\n");
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    const Ran ran = delf_program(folder, "run small.ini --initial.state=file " + arguments);
    check_refused(ran, {reason});
    CHECK_FALSE(std::filesystem::exists(folder / "results"));
  };
  refused("", "needs initial.file");
  refused("--initial.file=nowhere.h5", "no such file");
  refused("--initial.file=text.h5", "is not an HDF5 file");
  refused("--initial.file=rows", "is a directory; name the file in it");
  refused("--initial.file=rows/fields.h5 --initial.frame=5", "frame 6 is needed, and the file has 6");
  refused("--initial.file=rows/fields.h5 --lattice.sites=65", "has 64 sites");
  refused("--initial.file=rows/fields.h5 --lattice.courant=0.25", "apart");
  refused("--initial.file=sparse/fields.h5", "apart");
  refused("--initial.file=rows/fields.h5 --initial.start=centred", "no velocities");
  refused("--initial.file=rows/fields.h5 --out rows", "choose another --out");
}
