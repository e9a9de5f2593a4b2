// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
using delf::FieldsReader;

namespace {

nlohmann::json summary(const Folder& folder, const std::string& results) {
  return nlohmann::json::parse(read(folder / (results + "/summary.json")));
}

std::vector<std::vector<double>> rows(const std::filesystem::path& file) {
  const FieldsReader reader(file);
  std::vector<std::vector<double>> all;
  for (int f = 0; f < reader.frames(); ++f) all.push_back(reader.row(f));
  return all;
}

}  // namespace

TEST_CASE("a run leaves its scene, series, summary and fields, and a report on stdout") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 30\n"));
  const Ran ran = delf_program(folder, "run small.ini");
  CHECK(ran.code == 0);
  CHECK(complaints(ran) == "");
  CHECK(contains(ran.out, "ns per site and step"));
  CHECK(contains(ran.out, "results/small: summary.json series.csv scene.ini fields.h5\n"));

  const auto series = lines(read(folder / "results/small/series.csv"));
  REQUIRE(series.size() == 6);
  CHECK(series[0] == "step,time,energy,energy_error,momentum,charge,iterations,residual");
  for (int i = 0; i < 5; ++i) CHECK(series[delf::at(i) + 1].starts_with(std::to_string(i < 4 ? 30 * i : 100) + ","));

  const FieldsReader fields(folder / "results/small/fields.h5");
  CHECK(fields.frames() == 5);
  CHECK(fields.sites() == 64);
  CHECK(*fields.time(0) == 0);
  CHECK(*fields.time(4) == 100 * 0.5 * 20 / 64);
  CHECK(*fields.winding() == 0);

  const auto json = summary(folder, "results/small");
  for (const char* key : {"version",      "scene",          "theory",          "stencil",
                          "method",       "sites",          "space_step",      "time_step",
                          "steps",        "time",           "seconds",         "ns_per_site_step",
                          "solve",        "solve_kind",     "iterations_mean", "iterations_max",
                          "residual_max", "energy_initial", "energy_final",    "energy_error_max",
                          "error_linf",   "error_l2",       "status"}) {
    INFO(key);
    REQUIRE(json.contains(key));
    CHECK_FALSE(json[key].is_null());
  }
  CHECK(json["status"] == "done");
  CHECK(json["scene"] == "small");
  CHECK(json["steps"] == 100);
  CHECK(json["sites"] == 64);
  CHECK(json["time_step"] == 0.5 * 20 / 64);
  CHECK(json["error_linf"] < 1);
  CHECK(json["iterations_max"] > 0);
}

TEST_CASE("the resolved scene runs again to the same bits") {
  const auto scene =
      GENERATE(as<std::string>(), "small.ini", "small.ini --initial.start=centred", "kink-train",
               "collision --lattice.stencil=hexagon --lattice.sites=254", "interval --run.until=3",
               "phi4-kink --lattice.stencil=triangle-vertex", "small.ini --initial.state=noise --run.seed=7");
  const Folder folder;
  folder.write("small.ini", small_scene());
  const std::string steps = contains(scene, "until") ? "" : " --run.steps=60";
  INFO(scene);
  REQUIRE(delf_program(folder, "run " + scene + steps + " --output.figures=off --out first").code == 0);
  const Ran again = delf_program(folder, "run first/scene.ini --out second");
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK(complaints(again) == "");
  CHECK(read(folder / "first/scene.ini") == read(folder / "second/scene.ini"));
  CHECK(read(folder / "first/series.csv") == read(folder / "second/series.csv"));
  CHECK(rows(folder / "first/fields.h5") == rows(folder / "second/fields.h5"));
  CHECK(read(folder / "first/fields.h5") == read(folder / "second/fields.h5"));
}

TEST_CASE("only the last row is recorded if every is 0, and no fields are written if they are off") {
  const Folder folder;
  folder.write("small.ini", small_scene());
  REQUIRE(delf_program(folder, "run small.ini --output.every=0 --out last").code == 0);
  CHECK(lines(read(folder / "last/series.csv")).size() == 2);
  CHECK(FieldsReader(folder / "last/fields.h5").frames() == 1);
  REQUIRE(delf_program(folder, "run small.ini --output.fields=off --out bare").code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "bare/fields.h5"));
  CHECK_FALSE(std::filesystem::exists(folder / "bare/figures"));

  REQUIRE(delf_program(folder, "run small.ini --output.every=1 --out all").code == 0);
  CHECK(rows(folder / "all/fields.h5").size() == 101);
  CHECK(rows(folder / "all/fields.h5").back() == rows(folder / "last/fields.h5").back());
}

TEST_CASE("runs of no step and of one step end where they say") {
  const Folder folder;
  folder.write("small.ini", small_scene());
  for (const int steps : {0, 1, 2}) {
    const std::string out = "after-" + std::to_string(steps);
    INFO(out);
    REQUIRE(delf_program(folder, "run small.ini --run.steps=" + std::to_string(steps) + " --out " + out).code == 0);
    CHECK(summary(folder, out)["steps"] == steps);
    CHECK(FieldsReader(folder / (out + "/fields.h5")).frames() == steps + 1);
    CHECK(lines(read(folder / (out + "/series.csv"))).size() == delf::at(steps) + 2);
  }
  CHECK(summary(folder, "after-0")["ns_per_site_step"].is_null());
  CHECK(summary(folder, "after-0")["error_linf"] == 0.0);
}

TEST_CASE("a state without an exact solution has no error, which is null") {
  const Folder folder;
  folder.write("small.ini", small_scene());
  REQUIRE(delf_program(folder, "run small.ini --initial.state=noise --out noise").code == 0);
  CHECK(summary(folder, "noise")["error_linf"].is_null());
  CHECK(summary(folder, "noise")["start"] == "centred");
  const Ran refused = delf_program(folder, "run small.ini --initial.state=noise --initial.start=exact");
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "--initial.start = exact"));
}

TEST_CASE("results of an earlier run do not stay among those of a later one") {
  const Folder folder;
  folder.write("small.ini", small_scene());
  REQUIRE(delf_program(folder, "run small.ini --out here").code == 0);
  folder.write("here/notes.txt", "mine");
  REQUIRE(delf_program(folder, "run small.ini --out here --output.fields=off").code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "here/fields.h5"));
  CHECK(read(folder / "here/notes.txt") == "mine");
}
