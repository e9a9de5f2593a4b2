// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/run/watched_rows.hpp"

using namespace delf::testing;
using delf::WatchedRows;
using Json = nlohmann::json;

namespace {

const std::vector<std::string> maxima{"energy_error_max", "residual_max", "maxima_over", "conserved", "mesh_min_spacing"};

Json summary(const Folder& folder, const std::string& arguments) {
  const Ran ran = delf_program(folder, arguments + (arguments.starts_with("run") ? " --output.figures=off --out out" : ""));
  INFO(arguments << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return Json::parse(read(folder / "out/summary.json"));
}

}  // namespace

TEST_CASE("of every block of rows one is watched, at no fixed distance, and the same ones always") {
  const WatchedRows rows(100, 16, 7), same(100, 16, 7), other(100, 16, 8);
  std::set<std::int64_t> places;
  bool differs = false;
  for (std::int64_t block = 7; block < 1000; ++block) {
    int watched = 0;
    for (std::int64_t row = 16 * block; row < 16 * (block + 1); ++row) {
      if (rows.contains(row)) ++watched, places.insert(row % 16);
      CHECK(rows.contains(row) == same.contains(row));
      differs = differs || rows.contains(row) != other.contains(row);
    }
    CHECK(watched == 1);
  }
  CHECK(places.size() == 16);
  CHECK(differs);
  for (std::int64_t row = 1; row <= 100; ++row) CHECK(rows.contains(row));
  CHECK(rows.in_words(100, 0) == "all steps");
  CHECK(rows.in_words(1000, 1) == "all steps");
  CHECK(contains(rows.in_words(1000, 10), "one row of every 16"));
}

TEST_CASE("the largest error of the energy is not that of the records: a collision is seen between them") {
  const Folder folder;
  const auto largest = [&](const std::string& keys) {
    return summary(folder, "run collision --output.fields=off " + keys)["energy_error_max"].get<double>();
  };
  const double true_one = largest("--run.until=26 --output.every=1");
  // the records miss all collisions, or there are none
  CHECK(largest("--run.until=400 --output.every=1290") > 0.85 * true_one);
  CHECK(largest("--run.until=400 --output.every=0") > 0.85 * true_one);
  // a run that contains another has no smaller maximum
  CHECK(largest("--run.until=52 --output.every=1000") >= largest("--run.until=26 --output.every=1000"));
}

TEST_CASE("a short run is measured at all steps, whatever is recorded") {
  const Folder folder;
  folder.write("small.ini", small_scene());
  const std::string scene = GENERATE(as<std::string>(), "small.ini --run.steps=60", "pendulum --run.steps=50 --lattice.stencil=midpoint",
                                     "r-adaptive --run.steps=2", "kepler --run.steps=20");
  const Json all = summary(folder, "run " + scene + " --output.every=1"),
             few = summary(folder, "run " + scene + " --output.every=0");
  CHECK(all["maxima_over"] == "all steps");
  CHECK(all["energy_error_max"] > 0);
  for (const std::string& name : maxima) {
    INFO(scene << " " << name);
    CHECK(all.contains(name) == few.contains(name));
    if (all.contains(name) && name != "conserved") CHECK(all[name] == few[name]);
  }
  for (std::size_t j = 0; j < all["conserved"].size(); ++j)
    CHECK(all["conserved"][j]["error_max"] == few["conserved"][j]["error_max"]);
}

TEST_CASE("a run that goes further has the maxima and warnings of the whole, to the bit, whichever rows are recorded") {
  const Folder folder;
  const std::string scene = GENERATE(as<std::string>(), "collision", "sphere --lattice.mesh=icosahedron:1",
                                     "kepler --lattice.stencil=midpoint", "r-adaptive --lattice.time_step=0.005");
  const std::string every = GENERATE(as<std::string>(), "0", "37");
  const std::string keys = "run " + scene + " --output.fields=off --output.every=" + every;
  const Json whole = summary(folder, keys + " --run.steps=701");
  summary(folder, keys + " --run.steps=333");
  const Json parts = summary(folder, "resume out --run.steps=701");
  for (const std::string& name : maxima)
    if (whole.contains(name)) {
      INFO(scene << " " << name);
      CHECK(whole[name] == parts[name]);
    }
  CHECK(whole["warnings"] == parts["warnings"]);
}

TEST_CASE("the report and the summary say which rows maxima are over") {
  const Folder folder;
  const Ran ran = delf_program(folder, "run collision --run.until=20 --output.figures=off --out out");
  REQUIRE(ran.code == 0);
  const std::string over = Json::parse(read(folder / "out/summary.json"))["maxima_over"];
  CHECK(contains(over, "one row of every 64, drawn by run.seed"));
  CHECK(contains(ran.out, "  maxima     of " + over));
}
