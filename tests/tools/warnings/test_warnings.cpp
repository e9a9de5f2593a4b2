// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/python.hpp"

using namespace delf::testing;

namespace {

/// A run that ends with exit code 0, without figures: its summary, report, stderr and scene.ini.
struct Done {
  nlohmann::json summary;
  std::string report, err, scene;

  explicit Done(const std::string& arguments) {
    const Folder folder;
    folder.write("small.ini", small_scene());
    folder.write("lossy.ini",
                 "[theory]\nname = sine-gordon\nmass = 2\n[lattice]\nspace = interval\nlength = 60\nsites = 17\n"
                 "courant = 0.5\n[scheme]\nmethod = radau-iia\nstages = 3\nspace = spectral\n[initial]\n"
                 "state = noise\nwavenumber = 1\n[run]\nsteps = 7\n");
    const Ran ran = delf_program(folder, "run " + arguments + " --output.figures=off --out out");
    INFO(arguments << "\n" << ran.err);
    REQUIRE(ran.code == 0);
    summary = nlohmann::json::parse(read(folder / "out/summary.json"));
    report = ran.out, err = ran.err, scene = read(folder / "out/scene.ini");
  }
  /// How many warnings have these words.
  int warnings(const std::string& words) const {
    int count = 0;
    for (const auto& warning : summary["warnings"]) count += contains(warning.get<std::string>(), words) ? 1 : 0;
    return count;
  }
};

}  // namespace

TEST_CASE("a run that ends well and may be wrong says why, in the report and in the summary") {
  const std::string lobatto = "spacetime-element --scheme.degree_space=3 --scheme.quadrature=lobatto --run.until=10";
  const std::string drifting =  // 5 %, from the beginning
      "soliton-bounce --mesh.alpha=5 --lattice.sites=24 --run.until=15 --scheme.strategy=control --scheme.time=";
  const auto [arguments, words] = GENERATE_COPY(values<std::pair<std::string, std::string>>({
      {"kepler --initial.eccentricity=0.999 --run.until=30", "the energy of row 0 is 1.9"},
      {"kepler --initial.eccentricity=0.999 --run.until=30", "larger than the range of the solution, 2"},
      {"kepler --initial.eccentricity=0.95 --run.until=30", "the energy of row 0 is -2.67"},
      {"fast-kink --lattice.sites=60", "a pulse of the initial state is 0.141 wide, less than two cells"},
      {"collision --lattice.sites=32", "theta = pi (even N only)"},
      {lobatto, "beyond the linear limit of the scheme"},
      {lobatto, "the energy leaves its early band"},
      {drifting + "gauss2", "the energy leaves its early band"},
      {drifting + "lobatto2", "the energy leaves its early band"},
      {"kink --initial.speed=0.1 --lattice.sites=21 --run.until=160 --lattice.stencil=triangle-vertex",
       "pinned by the lattice"},
      {"guiding-centre --initial.q=2.5,0,0,0.19 --lattice.time_step=2 --run.until=1500", "jump grows from"},
      {"small.ini --scheme.max_iterations=2 --run.steps=3", "raise scheme.max_iterations, which is 2"},
  }));
  INFO(arguments);
  const Done done(arguments);
  INFO(done.summary["warnings"].dump(1));
  CHECK(done.warnings(words) == 1);
  for (const auto& warning : done.summary["warnings"])
    CHECK(contains(done.report, "  warning    " + warning.get<std::string>() + "\n"));
}

TEST_CASE("what no record shows is warned of: without records, in a few steps, of a phase") {
  const std::string drifting =
      "soliton-bounce --mesh.alpha=5 --lattice.sites=24 --run.until=15 --scheme.strategy=control --scheme.time=gauss2";
  const std::string swinging = "pendulum --initial.amplitude=3 --lattice.stencil=midpoint --run.until=60 --lattice.time_step=";
  const auto [arguments, words, count] = GENERATE_COPY(table<std::string, std::string, int>({
      {drifting + " --output.every=0", "the energy leaves its early band", 1},
      // radau-iia on waves that it damps: 82 % of the energy in seven steps
      {"lossy.ini", "the energy loses 0.", 1},
      {"lossy.ini --output.every=0", "the energy loses 0.", 1},
      {swinging + "0.8", "half the step moves the field by", 1},
      {swinging + "0.02", "half the step", 0},
  }));
  INFO(arguments);
  const Done done(arguments);
  INFO(done.summary["warnings"].dump(1));
  CHECK(done.warnings(words) == count);
}

TEST_CASE("shipped scenes as they are, and near misses, warn of nothing") {
  const std::string arguments =
      GENERATE(as<std::string>(), "kepler", "pendulum", "fast-kink", "kink", "kink-train", "collision --run.until=20",
               "collision --lattice.sites=256 --run.until=20", "phi4-kink", "spacetime-element --scheme.degree_space=3",
               "wave-packet", "wave-map", "henon-heiles", "lotka-volterra", "guiding-centre", "phi6-kink",
               "sinh-gordon", "sine-gordon-text", "r-adaptive --run.steps=50", "small.ini",
               "soliton-bounce --scheme.strategy=control --scheme.time=gauss2");
  const Done done(arguments);
  INFO(arguments << "\n" << done.summary["warnings"].dump(1));
  CHECK(done.summary["warnings"].empty());
  CHECK(done.summary["continued"].empty());
  CHECK_FALSE(contains(done.report, "warning"));
}

TEST_CASE("steps followed by continuation are counted, with the reason") {
  const Done done("small.ini --scheme.max_iterations=2 --run.steps=3");
  REQUIRE(done.summary["continued"].size() == 1);
  CHECK(done.summary["continued"][0]["steps"] == 2);
  CHECK(done.summary["continued"][0]["reason"] == "scheme.max_iterations was reached");
  CHECK(contains(done.report, "  continued  2 of 2 steps"));
}

TEST_CASE("a tolerance below what rounding allows is reported, and scene.ini has the one in force") {
  const Done done("small.ini --scheme.tolerance=1e-20 --run.steps=10");
  CHECK(contains(done.err, "--scheme.tolerance = 1e-20: warning: rounding allows no less than 8.9e-16"));
  CHECK(done.warnings("scheme.tolerance = 1e-20") == 1);
  CHECK(contains(done.scene, "tolerance = 8.881784197001252e-16\n"));
  CHECK(contains(Done("small.ini --run.steps=10").scene, "tolerance = 1e-14\n"));
}

TEST_CASE("the report says what residual and tolerance are of") {
  CHECK(
      contains(Done("small.ini --run.steps=10").report, "scheme.tolerance = 1e-14 is of the last change of the field"));
  CHECK_FALSE(contains(Done("wave-packet --run.steps=10").report, "scheme.tolerance"));
}

TEST_CASE("no error of random scenes is silent, and the count can fail", "[slow]") {
  const Folder folder;
  const auto count = [&](const std::string& options) {
    return shell(folder, python(folder) + " -B '" + scenes_folder() + "/../../tests/tools/run/random_scenes.py' '" +
                             program_path() + "' " + options);
  };
  const Ran ran = count("--count 40");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 0);
  const Ran strict = count("--count 6 --limit 1e-9");
  INFO(strict.out << strict.err);
  CHECK(strict.code == 1);
  CHECK(contains(strict.out, "wrong, silent"));
}
