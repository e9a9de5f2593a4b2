// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

const std::string sphere = "sphere --lattice.mesh=icosahedron:1 --run.steps=12 --output.figures=off --output.every=4";

nlohmann::json summary(const Folder& folder) { return nlohmann::json::parse(read(folder / "out/summary.json")); }

}  // namespace

TEST_CASE("methods of lattices run, resume and are planned on a mesh through the program") {
  for (const std::string method : {"composition", "cgvi --scheme.tableau=gauss2", "radau-iia --scheme.stages=2"}) {
    CAPTURE(method);
    const Folder folder;
    const std::string scene = sphere + " --scheme.method=" + method;
    const Ran ran = delf_program(folder, "run " + scene + " --out out");
    CAPTURE(ran.out, ran.err);
    REQUIRE(ran.code == 0);
    const auto json = summary(folder);
    CHECK(json["method"] == method.substr(0, method.find(' ')));
    CHECK(json["residual_max"] < 1e-13);
    if (method.find("radau") == std::string::npos) CHECK(json["energy_error_max"] < 1e-3);
    CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
    CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
    CHECK(contains(delf_program(folder, "plan " + scene).out, "42 sites on a mesh"));
  }
}

TEST_CASE("a constraint is kept by elements on a mesh") {
  const Folder folder;
  const Ran ran = delf_program(folder,
                               "run turning-soliton --scheme.method=cgvi --scheme.tableau=lobatto3 --run.steps=20 "
                               "--run.until= --output.figures=off --out out");
  CHECK(ran.code == 2);  // an empty value is none
  const Ran given = delf_program(folder,
                                 "run turning-soliton --scheme.method=cgvi --scheme.tableau=lobatto3 --run.until=0.5 "
                                 "--output.figures=off --out out");
  CAPTURE(given.out, given.err);
  REQUIRE(given.code == 0);
  CHECK(summary(folder)["constraint_max"] < 1e-12);
}

TEST_CASE("what a method on a mesh does not have is refused with a remedy") {
  const Folder folder;
  for (const auto& [keys, words] :
       {std::pair<std::string, std::string>{"--scheme.method=spacetime", "use composition or cgvi or radau-iia"},
        {"--scheme.tableau=gauss2", "remove it"},
        {"--scheme.method=cgvi --lattice.space_order=4", "leave it out"},
        {"--scheme.method=cgvi --lattice.time_steps=0.1,0.2 --lattice.courant=", "write --KEY=VALUE"},
        {"--scheme.method=cgvi --lattice.time=cells", "is for lattice.time = rows"},
        {"--scheme.method=cgvi --theory.fibre=S1", "leave scheme.method out"}}) {
    const Ran ran = delf_program(folder, "run " + sphere + " " + keys + " --out out");
    CAPTURE(keys, ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, words));
  }
  const Ran verify = delf_program(folder, "verify " + sphere + " --scheme.method=radau-iia");
  CHECK(verify.code == 2);
  CHECK(contains(verify.err, "use one of these"));
}

TEST_CASE("limits of methods on a mesh are those of its highest oscillator, and runs agree") {
  const Folder folder;
  const Ran ran = delf_program(folder, "stability sphere --lattice.mesh=icosahedron:1 --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const auto json = nlohmann::json::parse(read(folder / "out/stability.json"));
  const double omega = json["largest_frequency"];
  bool verlet = false, gauss = false, composition = false;
  for (const auto& limit : json["limits"]) {
    CHECK(limit["agrees"] == true);
    if (limit["scheme"] == "cgvi stormer-verlet") {
      verlet = true;
      CHECK(limit["time_step"] == Approx(2 / omega).epsilon(1e-3));
    }
    if (limit["scheme"] == "cgvi gauss2") {
      gauss = true;
      CHECK(limit["unlimited"] == true);
    }
    if (limit["scheme"] == "composition 4") {
      composition = true;
      CHECK(limit["time_step"] > 2 / omega);
    }
  }
  CHECK((verlet && gauss && composition));
  // a planted error of theory is found by the runs
  CHECK(delf_program(folder, "stability sphere --lattice.mesh=icosahedron:1 --stability.fault=limit --out out").code ==
        1);
}

TEST_CASE("methods on a mesh keep the form, and planted faults are found") {
  const Folder folder;
  for (const std::string run :
       {sphere + " --scheme.method=composition", sphere + " --scheme.method=cgvi --scheme.tableau=gauss2",
        sphere + " --scheme.method=cgvi --scheme.tableau=lobatto3",
        std::string("turning-soliton --scheme.method=cgvi --scheme.tableau=lobatto3 --run.steps=12")}) {
    CAPTURE(run);
    const std::string scene = "verify " + run + " --verify.moments=2 --out out";
    const Ran ran = delf_program(folder, scene);
    CAPTURE(ran.out, ran.err);
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "constraint") == run.starts_with("turning"));
    CHECK(contains(ran.out, "time reversal, distance"));
    for (const std::string fault : {"sign", "field", "variation"})
      CHECK(delf_program(folder, scene + " --verify.fault=" + fault).code == 1);
  }
}

TEST_CASE(
    "rows are verified against the stencils that made them: a gradient term that reads x does so at Gauss's points") {
  const Folder folder;
  folder.write("placed.ini",
               "[theory]\ndensity = 0.5*phi_t^2 - 0.5*(1 + 0.2*x^2)*phi_x^2 - phi^4\n[lattice]\nspace = complex\n"
               "mesh = quadrilaterals:2,1,8,4\ncourant = 0.3\n[boundary]\nmesh = natural\n[initial]\nphi = cos(x)\n"
               "[run]\nsteps = 12\n[output]\nfigures = off\nevery = 1\n");
  CHECK(delf_program(folder, "verify placed.ini --out v").code == 0);
  REQUIRE(delf_program(folder, "run placed.ini --out out").code == 0);
  CHECK(delf_program(folder, "verify placed.ini --fields out/fields.h5 --out v").code == 0);
  CHECK(delf_program(folder,
                     "verify placed.ini --theory.density='0.5*phi_t^2 - 0.5*(1 + 0.201*x^2)*phi_x^2 - phi^4' "
                     "--fields out/fields.h5 --out v")
            .code == 1);
}

TEST_CASE("every method on a mesh takes steps in turn, and ends at their time") {
  const Folder folder;
  const auto last = [&](const std::string& method, const std::string& steps) {
    const Ran ran = delf_program(
        folder,
        "run sphere --lattice.mesh=icosahedron:1 --output.every=0 --output.figures=off --out out " + method + steps);
    CAPTURE(ran.out, ran.err);
    REQUIRE(ran.code == 0);
    return nlohmann::json::parse(read(folder / "out/summary.json"));
  };
  for (const std::string method : {"", "--scheme.method=composition ", "--scheme.method=cgvi "}) {
    CAPTURE(method);
    const auto turns = last(method, "--run.until=1.2 --lattice.time_steps=0.05,0.03");
    CHECK(turns["time"].get<double>() == Approx(1.2));
    CHECK(turns["steps"] == 30);
    CHECK(turns["residual_max"].get<double>() < 1e-13);
  }
}
