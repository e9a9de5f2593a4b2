// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

nlohmann::json summary_of(const std::string& arguments, int code = 0) {
  const Folder folder;
  const Ran ran = delf_program(folder, "run " + arguments + " --output.figures=off --out out");
  CAPTURE(arguments, ran.out, ran.err);
  REQUIRE(ran.code == code);
  return nlohmann::json::parse(read(folder / "out/summary.json"));
}

}  // namespace

TEST_CASE("the energy and the sums of row 0 are those of the run, whether or not it is recorded") {
  for (const std::string scene : {"asynchronous --run.steps=40", "turning-soliton --run.steps=10"}) {
    CAPTURE(scene);
    const nlohmann::json all = summary_of(scene), last = summary_of(scene + " --output.every=0");
    CHECK(last["records"] == 1);
    CHECK(last["energy_initial"] == all["energy_initial"]);
    CHECK(last["energy_final"] == all["energy_final"]);
    CHECK(last["energy_error_max"] > 0);
    REQUIRE(last["conserved"].size() == all["conserved"].size());
    for (std::size_t n = 0; n < all["conserved"].size(); ++n)
      CHECK(last["conserved"][n]["initial"] == all["conserved"][n]["initial"]);
  }
}

TEST_CASE("a run on a mesh that ends well and may be wrong says why, by the rules of lattices") {
  const std::string small = "sphere --lattice.mesh=icosahedron:1 ";
  const auto [arguments, words] = GENERATE_COPY(values<std::pair<std::string, std::string>>({
      {"asynchronous --lattice.courant=1.1 --output.every=0", "the energy of the last row is 4.5"},
      {"asynchronous --lattice.courant=1.1 --output.every=0", "is larger than the range of the solution, 6.28"},
      {"asynchronous --lattice.courant=1.1", "the energy leaves its early band"},
      {small + "--lattice.time_step=10 --run.steps=1", "the energy of row 0 is "},
      {small + "--lattice.time_step=10 --run.steps=1", "the field grows to "},
  }));
  CAPTURE(arguments, words);
  const nlohmann::json summary = summary_of(arguments);
  CAPTURE(summary["warnings"].dump(1));
  int found = 0;
  for (const auto& warning : summary["warnings"]) found += contains(warning.get<std::string>(), words);
  CHECK(found == 1);
}

TEST_CASE("shipped scenes on meshes warn of nothing") {
  const std::string scene = GENERATE(as<std::string>(), "sphere", "sphere --output.every=0", "asynchronous",
                                     "asynchronous --lattice.time=rows", "turning-soliton",
                                     "sphere --lattice.time_steps=reversible --lattice.step_control=0.5");
  CAPTURE(scene);
  CHECK(summary_of(scene)["warnings"].empty());
}

TEST_CASE("a step on a mesh that is out of all range breaks, and leaves row 0") {
  const nlohmann::json broken =
      summary_of("sphere --lattice.mesh=icosahedron:1 --run.steps=3 --lattice.time_step=1e200", 3);
  CHECK(broken["records"] == 1);
  CHECK(broken["steps"] == 0);
  CHECK(contains(broken["failure"].get<std::string>(), "the field is not finite; reduce lattice.time_step or lattice.courant"));
}

TEST_CASE("a strength that makes every step on a mesh tiny is refused, of a start at rest too") {
  const Folder folder;
  const std::string run = "run sphere --lattice.mesh=icosahedron:1 --run.until=0.1 --lattice.time_steps=reversible ";
  for (const std::string start : {"", "--initial.phi_t=x "})
    check_refused(delf_program(folder, run + start + "--lattice.step_control=1e5 --out out"),
                  {"--lattice.step_control = 1e5: makes the first step", "use s of 0.1 to 10"});
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
  CHECK(delf_program(folder, run + "--lattice.step_control=10 --output.figures=off --out out").code == 0);
}
