// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
using delf::FieldsReader;
using delf::Role;

namespace {

const std::string elements = "henon-heiles --output.every=1 --output.figures=off ";

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEST_CASE("the momenta of elements are recorded, and are their multipliers") {
  const Folder folder;
  REQUIRE(delf_program(folder, "run " + elements + "--run.steps=40 --scheme.continuity=multipliers --out out").code ==
          0);
  const FieldsReader rows(folder / "out/fields.h5");
  REQUIRE(rows.frames() == 41);
  for (const int frame : {0, 1, 2, 17, 40}) {
    CAPTURE(frame);
    const auto p = rows.momenta(frame);
    REQUIRE(p);
    REQUIRE(p->size() == 2);
    if (frame == 0) CHECK(distance(*p, {0, 0}) < 1e-15);
    std::vector<double> found = rows.values(Role::multiplier, frame);  // λ, then μ
    found.resize(2);
    if (frame > 0) CHECK(distance(found, *p) < 1e-14);
  }
  // frames differ, so that the wrong one would be seen
  CHECK(distance(*rows.momenta(16), *rows.momenta(17)) > 1e-3);
}

TEST_CASE("a run of elements goes on from the momenta of another, and its scene.ini runs again to the bit") {
  const Folder folder;
  const std::string method = GENERATE(as<std::string>(), "", "--scheme.basis=lagrange-gauss --scheme.points=3 ");
  REQUIRE(delf_program(folder, "run " + elements + method + "--run.steps=40 --out whole").code == 0);
  const Ran part = delf_program(folder, "run " + elements + method +
                                            "--run.steps=25 --initial.state=file --initial.file=whole/fields.h5 "
                                            "--initial.frame=15 --out part");
  INFO(part.err);
  REQUIRE(part.code == 0);
  const FieldsReader whole(folder / "whole/fields.h5"), rest(folder / "part/fields.h5");
  for (const int frame : {0, 1, 25}) {
    CAPTURE(frame);
    CHECK(distance(whole.row(15 + frame), rest.row(frame)) < 1e-13);
    CHECK(distance(*whole.momenta(15 + frame), *rest.momenta(frame)) < 1e-13);
  }
  CHECK(distance(whole.row(14), rest.row(0)) > 1e-3);
  REQUIRE(delf_program(folder, "run part/scene.ini --out again").code == 0);
  CHECK(read(folder / "part/series.csv") == read(folder / "again/series.csv"));
  CHECK(read(folder / "part/fields.h5") == read(folder / "again/fields.h5"));
}

TEST_CASE("methods that declare no dataset have none, and elements do not start from such a file") {
  const Folder folder;
  REQUIRE(
      delf_program(folder, "run " + elements +
                               "--run.steps=5 --scheme.method=multisymplectic --lattice.stencil=midpoint --out plain")
          .code == 0);
  CHECK_FALSE(FieldsReader(folder / "plain/fields.h5").momenta(0));
  const Ran ran =
      delf_program(folder, "run " + elements + "--run.steps=5 --initial.state=file --initial.file=plain/fields.h5");
  INFO(ran.err);
  CHECK(ran.code == 2);
  CHECK(contains(lines(ran.err).back(), "initial.state"));
  CHECK(contains(lines(ran.err).back(), "/momentum"));
}
