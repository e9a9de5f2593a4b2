// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/python.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
namespace fs = std::filesystem;

namespace {

const std::string script = scenes_folder() + "/../../tests/tools/run/kill_and_resume.py";

Ran resume(const Folder& folder, const std::string& keys = "") { return delf_program(folder, "resume out " + keys); }

// A run of 20 steps in `out`, and what it recorded.
std::string run_small(const Folder& folder, const std::string& keys = "") {
  const Ran ran =
      delf_program(folder, "run kink --run.steps=20 --output.every=3 --output.figures=off --out out " + keys);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  return read(folder / "out/series.csv");
}

}  // namespace

TEST_CASE("a run that ends at half of its steps and goes on is the whole run, to the bit") {
  const Folder folder;
  // by rows, by sub-steps with a processor, slab by slab with kept matrices, with a mesh that moves
  const auto scene = GENERATE(as<std::string>(), "collision --arguments=--run.steps=41",
                              "breather --arguments=--scheme.method=processed --arguments=--run.steps=41",
                              "r-adaptive --arguments=--run.steps=13");
  const Ran ran = shell(folder, python(folder) + " " + script + " '" + program_path() + "' --half --scenes " + scene +
                                    " --arguments=--output.figures=off --arguments=--output.every=3");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 0);
}

TEST_CASE("a run that is killed at random instants and resumed is the whole run, to the bit") {
  const Folder folder;
  const Ran ran = shell(folder, python(folder) + " " + script + " '" + program_path() +
                                    "' --kills 2 --scenes kink --arguments=--output.figures=off");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 0);
}

TEST_CASE("what cannot be resumed is refused in one line that says why") {
  const Folder folder;
  run_small(folder);
  const auto refused = [&](const std::string& keys, const std::string& why) {
    const Ran ran = resume(folder, keys);
    INFO(ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, why));
  };
  refused("", "the run is finished, at row 20; to go on, raise run.until or run.steps");
  refused("--run.steps=7", "the run is finished");
  refused("--lattice.sites=9", "--lattice.sites = 9: a run is resumed with the keys that it began with");
  const std::string scene = read(folder / "out/scene.ini");
  std::string other = scene;
  other.replace(other.find("state = kink"), 12, "state = antikink");
  folder.write("out/scene.ini", other);
  refused("--run.steps=30", "initial.state: the run began with kink");
  folder.write("out/scene.ini", scene);
  CHECK(delf_program(folder, "resume .").code == 2);
  CHECK(delf_program(folder, "resume out --out elsewhere").code == 2);

  std::string damaged = read(folder / "out/checkpoint");
  damaged[damaged.size() / 2] ^= 1;
  folder.write("out/checkpoint", damaged);
  refused("--run.steps=30", "out/checkpoint: is damaged");
  fs::remove(folder / "out/checkpoint");
  refused("--run.steps=30", "there is no checkpoint to resume from");
}

TEST_CASE("files that lack what the checkpoint counts on are refused, and nothing is lost") {
  const Folder folder;
  run_small(folder);
  const fs::path out = folder / "out";
  const auto refused = [&](const std::string& file, const std::string& text, const std::string& why) {
    const std::string whole = read(out / file), summary = read(out / "summary.json");
    const std::string other = file == "series.csv" ? "fields.h5" : "series.csv", of_other = read(out / other);
    folder.write("out/" + file, text);
    if (text.empty()) fs::remove(out / file);
    const Ran ran = resume(folder, "--run.steps=30");
    INFO(ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, "out/" + file + ": " + why));
    CHECK(contains(ran.err, "begin the run anew"));
    CHECK(fs::exists(out / file) == !text.empty());
    if (!text.empty()) CHECK(read(out / file) == text);
    CHECK(read(out / other) == of_other);
    CHECK(read(out / "summary.json") == summary);
    for (const auto& entry : fs::directory_iterator(out)) CHECK(entry.path().extension() != ".part");
    folder.write("out/" + file, whole);
  };
  const std::string series = read(out / "series.csv"), fields = read(out / "fields.h5");
  refused("series.csv", series.substr(0, 200), "has 200 bytes, and the checkpoint counts on");
  refused("series.csv", "", "No such file");
  refused("fields.h5", fields.substr(0, fields.size() / 2), "the 7 rows that the checkpoint counts on are gone");
  refused("fields.h5", "", "the 7 rows that the checkpoint counts on are gone");
  // a bit of what is there, in the last block too: a kill in the midst of it leaves no right checksum of HDF5's own
  std::string digit = series, bit = fields;
  digit[digit.find("\n3,") + 1] = '4';
  const double value = delf::FieldsReader(out / "fields.h5").row(5)[40];
  const std::size_t at = bit.find(std::string(reinterpret_cast<const char*>(&value), sizeof value));
  REQUIRE(at != std::string::npos);
  bit[at] ^= 1;
  refused("series.csv", digit, "is damaged: its lines are not those that the checkpoint counts on");
  refused("fields.h5", bit, "is damaged: its rows are not those that the checkpoint counts on");
  CHECK(resume(folder, "--run.steps=30").code == 0);
}

TEST_CASE("a damaged checkpoint is replaced by the one before it, and says so") {
  const Folder folder;
  run_small(folder, "--output.checkpoint=1e-9");
  REQUIRE(fs::exists(folder / "out/checkpoint.previous"));
  folder.write("out/checkpoint", read(folder / "out/checkpoint").substr(0, 3000));
  fs::remove(folder / "out/summary.json");
  const std::string series = read(folder / "out/series.csv");
  const Ran ran = resume(folder);
  INFO(ran.err);
  CHECK(ran.code == 0);
  CHECK(contains(ran.err, "is damaged"));
  CHECK(contains(ran.err, "the one before it, of row"));
  CHECK(read(folder / "out/series.csv") == series);
}

TEST_CASE("a folder that another run holds, and a scene that delf did not write, are left alone") {
  const Folder folder;
  const std::string line = "'" + program_path() + "' run kink --run.until=1e6 --output.figures=off --out out";
  const Ran held = shell(folder, line + " & p=$!; while [ ! -s out/fields.h5 ]; do sleep 0.02; done; " + line +
                                     "; code=$?; kill -HUP $p; wait $p; echo $?; exit $code");
  INFO(held.err);
  CHECK(held.code == 4);
  CHECK(contains(held.out, "130"));
  CHECK(contains(held.err, "another command writes to this folder"));

  const std::string mine = folder.write("scene.ini", small_scene());
  const Ran over = delf_program(folder, "run scene.ini --out .");
  INFO(over.err);
  CHECK(over.code == 2);
  CHECK(contains(over.err, "a scene that delf did not write"));
  CHECK(delf_program(folder, "run static-kink --out .").code == 2);  // on a mesh too
  CHECK(read(mine) == small_scene());
}

TEST_CASE("a run that goes further warns as one without a break") {
  const Folder folder;
  const auto warnings = [&](const std::string& scene, int first, int steps) {
    const std::string run = "run " + scene + " --output.every=1 --output.figures=off --out ";
    REQUIRE(delf_program(folder, run + "whole --run.steps=" + std::to_string(steps)).code == 0);
    REQUIRE(delf_program(folder, run + "out --run.steps=" + std::to_string(first)).code == 0);
    REQUIRE(resume(folder, "--run.steps=" + std::to_string(steps)).code == 0);
    const auto of = [&](const char* results) {
      return nlohmann::json::parse(read(folder / (std::string(results) + "/summary.json")))["warnings"];
    };
    CHECK(of("out") == of("whole"));
    return of("whole").dump();
  };
  folder.write("jump.ini",
               "[theory]\nname = guiding-centre\n[lattice]\nspace = point\ntime_step = 0.01\n[scheme]\nmethod = dgvi\n"
               "functions = 5\nquadrature = gauss\npoints = 6\nflux = midpoint\n[initial]\nstate = "
               "point\nq = 0.3, 2, 0.1, 2\n");
  CHECK(contains(warnings("jump.ini", 23, 60), "jump grows from"));
  CHECK(contains(warnings("kink --initial.speed=0.1 --lattice.sites=21 --lattice.stencil=triangle-vertex", 140, 168),
                 "pinned by the lattice"));
}

TEST_CASE("a run that goes further has the sums of one without a break, and says which of them the walls take") {
  const Folder folder;
  folder.write("wave.ini",
               "[theory]\nname = wave\n[lattice]\nspace = interval\nlength = 1\nsites = 17\ncourant = 0.5\n"
               "[initial]\nphi = 0\nphi_t = sin(pi*x)\n");
  folder.write("mesh.ini",
               "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = rectangle:2,1,8,4\ncourant = 0.3\n"
               "[initial]\nphi = sin(pi*x/4)*sin(pi*y/2)\nphi_t = 0\n");
  for (const std::string scene : {"wave.ini", "mesh.ini"}) {
    const std::string run = "run " + scene + " --output.every=1 --output.figures=off --out ";
    REQUIRE(delf_program(folder, run + "whole --run.steps=20").code == 0);
    REQUIRE(delf_program(folder, run + "out --run.steps=10").code == 0);
    REQUIRE(resume(folder, "--run.steps=20").code == 0);
    const auto sums = [&](const char* results) {
      return nlohmann::json::parse(read(folder / (std::string(results) + "/summary.json")))["conserved"];
    };
    CHECK(sums("whole")[0]["at_walls"] == true);
    CHECK(sums("out") == sums("whole"));
  }
}
