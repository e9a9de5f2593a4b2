// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Of a fields.h5, in place.
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
  CHECK(contains(delf_program(folder, "plan wave.ini").out, "388 unknowns a slab, 97 blocks"));
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
