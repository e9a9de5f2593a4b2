// SPDX-License-Identifier: MIT
#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tools/sweep/sweep_request.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

std::string scene_with_kink() {
  return "[theory]\nname = sine-gordon\n[lattice]\nspace = interval\nlength = 40\nsites = 101\ncourant = 0.5\n"
         "[initial]\nstate = kink\nposition = 15\n[run]\nuntil = 5\n[measure]\nplace = position(1)\n";
}

Json sweep_of(const Folder& folder) { return Json::parse(read(folder / "out/sweep.json")); }

std::vector<std::string> values(const std::string& key, const std::string& text) {
  return delf::swept_values({key, text, 0});
}

}  // namespace

TEST_CASE("values of a sweep are a list, or a range with both its ends") {
  using Texts = std::vector<std::string>;
  CHECK(values("initial.speed", "0.1,0.2, 0.5") == Texts{"0.1", "0.2", "0.5"});
  CHECK(values("initial.speed", "0.1:0.4:0.1") == Texts{"0.1", "0.2", "0.3", "0.4"});
  CHECK(values("initial.speed", "1:0:-0.5") == Texts{"1", "0.5", "0"});
  CHECK(values("initial.speed", "0.1:0.5:0.15") == Texts{"0.1", "0.25", "0.4"});  // the last that the steps reach
  CHECK(values("lattice.stencil", "triangle,hexagon") == Texts{"triangle", "hexagon"});
  CHECK(values("initial.speed", "0.3") == Texts{"0.3"});
  // text and times have commas and colons of their own
  CHECK(values("output.times", "0,10") == Texts{"0,10"});
  CHECK(values("verify.regions", "0:8x10:30,1:2x3:4") == Texts{"0:8x10:30,1:2x3:4"});
  CHECK(values("theory.v", "0.1,0.2").size() == 2);
  CHECK(values("exact.phi", "pow(x, 2), 1").size() == 1);
}

TEST_CASE("a sweep gives a row and a folder for each run, with its numbers") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  const Ran ran = delf_program(
      folder, "sweep '" + scene + "' --initial.speed=0:0.4:0.2 --lattice.stencil=triangle-vertex,rectangle --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const Json sweep = sweep_of(folder);
  CHECK(sweep["keys"] == Json{"initial.speed", "lattice.stencil"});
  CHECK(sweep["number"] == "place");
  REQUIRE(sweep["runs"].size() == 6);
  for (const Json& run : sweep["runs"]) {
    const double v = std::stod(run["settings"]["initial.speed"].get<std::string>());
    CHECK(run["status"] == "done");
    CHECK(run["summary"]["measures"]["place"].get<double>() == Approx(15 + 5 * v).margin(0.02));
    const auto there = folder / ("out/" + run["folder"].get<std::string>());
    CHECK(std::filesystem::exists(there / "fields.h5"));
    CHECK_FALSE(std::filesystem::exists(there / "figures"));
    // the run itself: the same rows as those of `delf run`
    CHECK(Json::parse(read(there / "summary.json"))["energy_final"] == run["summary"]["energy_final"]);
  }
  const auto table = lines(read(folder / "out/sweep.csv"));
  REQUIRE(table.size() == 7);
  CHECK(table[0].starts_with("initial.speed,lattice.stencil,status,place,"));
  CHECK(table[1].starts_with("0,triangle-vertex,done,15"));
  if (has_gnuplot()) CHECK(std::filesystem::exists(folder / "out/figures/sweep.svg"));
}

TEST_CASE("with sweep.keep = table only rows are kept, and sweep.zip takes keys together") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  const Ran ran = delf_program(folder, "sweep '" + scene +
                                           "' --initial.speed=0.1,0.2 --initial.position=14,16 --sweep.zip=on "
                                           "--sweep.keep=table --sweep.number=energy_final --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "out/runs"));
  const Json sweep = sweep_of(folder);
  REQUIRE(sweep["runs"].size() == 2);
  CHECK(sweep["runs"][1]["summary"]["measures"]["place"].get<double>() == Approx(17).margin(0.02));
  CHECK(sweep["runs"][1]["folder"].is_null());
  CHECK(sweep["number"] == "energy_final");
}

TEST_CASE("a table of settings gives the runs") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  folder.write("runs.csv", "# three\ninitial.speed, lattice.sites\n0.1, 81\n0.2, 101\n\n0.3, 121\n");
  REQUIRE(delf_program(folder, "sweep '" + scene + "' --sweep.settings=runs.csv --sweep.keep=table --out out").code ==
          0);
  const Json sweep = sweep_of(folder);
  REQUIRE(sweep["runs"].size() == 3);
  CHECK(sweep["runs"][2]["summary"]["sites"] == 121);
  folder.write("runs.csv", "initial.speed, lattice.sites\n0.1\n");
  const Ran bad = delf_program(folder, "sweep '" + scene + "' --sweep.settings=runs.csv --out out");
  CHECK(bad.code == 2);
  CHECK(contains(bad.err, "runs.csv:2: 1 values for 2 keys"));
}

TEST_CASE("finished runs are not repeated, others and those of other settings are") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  const std::string command = "sweep '" + scene + "' --sweep.keep=table --out out --initial.speed=";
  REQUIRE(delf_program(folder, command + "0.1,0.2").code == 0);
  REQUIRE(delf_program(folder, command + "0.1,0.2,0.3").code == 0);
  CHECK(sweep_of(folder)["runs_reused"] == 2);
  CHECK(sweep_of(folder)["runs"].size() == 3);
  REQUIRE(delf_program(folder, command + "0.1,0.2 --run.until=4").code == 0);
  CHECK(sweep_of(folder)["runs_reused"] == 0);
  REQUIRE(delf_program(folder, command + "0.1,0.2 --sweep.resume=off").code == 0);
  CHECK(sweep_of(folder)["runs_reused"] == 0);
  // a journal that was cut short in its last line
  const std::string journal = read(folder / "out/sweep.rows");
  folder.write("out/sweep.rows", journal.substr(0, journal.size() - 20));
  REQUIRE(delf_program(folder, command + "0.1,0.2").code == 0);
  CHECK(sweep_of(folder)["runs_reused"] == 1);
  REQUIRE(delf_program(folder, command + "0.1,0.2").code == 0);
  CHECK(sweep_of(folder)["runs_reused"] == 2);
}

TEST_CASE("a run that fails is a row with its status, and a sweep with such a row is not done") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  const std::string command = "sweep '" + scene + "' --lattice.stencil=triangle-vertex --sweep.keep=table --out out ";
  Ran ran = delf_program(folder, command + "--lattice.courant=0.5,3 --run.until=200");
  CHECK(ran.code == 3);
  CHECK(contains(ran.err, "1 of 2 runs did not end well"));
  Json runs = sweep_of(folder)["runs"];
  CHECK(runs[0]["status"] == "done");
  CHECK(runs[1]["status"] == "not-finite");
  CHECK(runs[1]["failure"].is_string());
  ran = delf_program(folder, command + "--lattice.courant=3,4 --run.until=200");
  CHECK(ran.code == 3);
  CHECK(contains(ran.err, "none of the runs ended well"));
  // what only the engine finds is a row too
  ran = delf_program(folder, "sweep '" + scene + "' --lattice.stencil=rectangle,hexagon --sweep.keep=table --out out");
  CHECK(ran.code == 2);
  CHECK(contains(ran.err, "1 of 2 runs could not begin"));
  runs = sweep_of(folder)["runs"];
  CHECK(runs[1]["status"] == "bad-input");
  CHECK(contains(runs[1]["failure"], "lattice.stencil"));
}

TEST_CASE("runs that warn are counted, and the first warning is told") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  const std::string command = "sweep '" + scene + "' --sweep.keep=table --out out --lattice.sites=";
  CHECK(contains(delf_program(folder, command + "11,101").out,
                 "warnings   of 1 runs, in sweep.json; the first: a pulse"));
  CHECK_FALSE(contains(delf_program(folder, command + "101,121").out, "warnings"));
}

TEST_CASE("a folder of results is held by one sweep at a time") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  // The second one begins when a run of the first is under way, which goes on until it is interrupted.
  const std::string command = "'" + program_path() + "' sweep '" + scene + "' --sweep.jobs=1 --out out ";
  const Ran ran = shell(folder, command +
                                    "--run.until=1e7,2e7 > first.txt 2>&1 & for i in $(seq 100); do sleep 0.05; "
                                    "ls out/runs > /dev/null 2>&1 && break; done; " +
                                    command + "--run.until=1,2; code=$?; kill -INT $!; wait $!; exit $code");
  CHECK(ran.code == 4);
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "out: another command writes to this folder"));
  // and it is free again
  CHECK(delf_program(folder, "sweep '" + scene + "' --run.until=1,2 --out out").code == 0);
}

TEST_CASE("a run of a sweep that the system ends is a failure of the sweep") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  // Files end at 40 blocks of 512 bytes: rows of the longer run do not fit.
  const Ran ran = shell(folder, "ulimit -f 40; '" + program_path() + "' sweep '" + scene +
                                    "' --sweep.keep=table --output.figures=off --output.checkpoint=0 "
                                    "--output.every=1 --run.until=0.4,200 --out out");
  CHECK(ran.code == 4);
  CHECK(contains(ran.err, "1 of 2 runs crashed or were failed by the system"));
}

TEST_CASE("Ctrl-C leaves whole rows, and the same command goes on from there") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  // two short runs, then long ones
  const std::string command =
      "sweep '" + scene + "' --run.until=1,2,1e7,2e7 --sweep.jobs=2 --sweep.keep=table --out out";
  const Ran ran =
      shell(folder, "'" + program_path() + "' " + command +
                        " & for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do sleep 0.05; test -f "
                        "out/sweep.rows && test $(grep -c finger out/sweep.rows) = 2 && break; done; "
                        "kill -INT $!; wait $!");
  CHECK(ran.code == 130);
  const Json sweep = sweep_of(folder);
  CHECK(sweep["status"] == "interrupted");
  CHECK(sweep["runs_asked"] == 4);
  CHECK(sweep["runs"].size() == 2);
  CHECK(lines(read(folder / "out/sweep.csv")).size() == 3);
  CHECK_FALSE(std::filesystem::exists(folder / "out/runs"));
}

TEST_CASE("a bisection finds where a number passes a level, and refuses ends on one side of it") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  // at t = 5 the kink has passed x = 16 if v > 0.2
  const std::string command =
      "sweep '" + scene + "' --sweep.keep=table --sweep.level=16 --out out --sweep.bisect=initial.speed=";
  Ran ran = delf_program(folder, command + "0:0.8 --sweep.accuracy=1e-3");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const Json found = sweep_of(folder)["threshold"];
  CHECK(found["value"].get<double>() == Approx(0.2).margin(2e-3));
  CHECK(found["high"].get<double>() - found["low"].get<double>() <= 1e-3);
  CHECK(found["at_low"].get<double>() <= 16);
  CHECK(found["at_high"].get<double>() > 16);
  ran = delf_program(folder, command + "0.3:0.8");
  CHECK(ran.code == 2);
  CHECK(contains(ran.err, "both on one side of 16"));
}

TEST_CASE("a sweep that cannot be met is refused in one line before any run") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  for (const auto& [keys, says] : std::vector<std::pair<std::string, std::string>>{
           {"", "sweep what?"},
           {"--initial.speed=0.1:0.5:0", "is no range"},
           {"--initial.speed=0.1:0.5:-0.1", "the step does not lead"},
           {"--initial.speed=0:1:1e-9", "more runs than a sweep takes"},
           {"--initial.speed=0.1,,0.2", "a value is missing"},
           {"--lattice.courant=0.1,-1", "lattice.courant"},
           {"--initial.speed=0.1,0.2 --lattice.sites=11,12,13 --sweep.zip=on", "give as many"},
           {"--initial.sped=0.1,0.2", "did you mean initial.speed"},
           {"--sweep.keep=nothing --initial.speed=0.1,0.2", "sweep.keep"},
           {"--sweep.bisect=initial.speed", "write KEY=a:b"},
           {"--sweep.bisect=lattice.sites=10:20", "no key with real values"}}) {
    const Ran ran = delf_program(folder, "sweep '" + scene + "' --out out " + keys);
    INFO(keys << "\n" << ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, says));
    CHECK_FALSE(std::filesystem::exists(folder / "out/runs"));
  }
}

TEST_CASE("a number that no run has ends a sweep, or a bisection, after its first rows, which are kept") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  for (const std::string keys : {"--initial.speed=0.1:0.5:0.1", "--sweep.bisect=initial.speed=0:0.8"}) {
    const Ran ran = delf_program(
        folder, "sweep '" + scene + "' --sweep.resume=off --sweep.jobs=1 --sweep.number=plce --out out " + keys);
    INFO(ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, "did you mean place"));
    CHECK(sweep_of(folder)["status"] == "bad-input");
    CHECK(sweep_of(folder)["runs"].size() == 1);
    CHECK(lines(read(folder / "out/sweep.csv")).size() == 2);
  }
}

TEST_CASE("equal settings are run once, and each has the row") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  const Ran ran =
      delf_program(folder, "sweep '" + scene + "' --initial.speed=0.3,0.3,0.2,0.3 --sweep.jobs=2 --out out");
  INFO(ran.err << ran.out);
  REQUIRE(ran.code == 0);
  const Json sweep = sweep_of(folder);
  REQUIRE(sweep["runs"].size() == 4);
  CHECK(sweep["runs_reused"] == 0);
  for (const std::size_t i : {0u, 1u, 3u}) {
    CHECK(sweep["runs"][i]["settings"]["initial.speed"] == "0.3");
    CHECK(sweep["runs"][i]["summary"]["measures"]["place"].get<double>() == Approx(16.5).margin(0.02));
  }
  CHECK(sweep["runs"][1]["summary"] == sweep["runs"][0]["summary"]);
  CHECK(sweep["runs"][2]["summary"]["measures"]["place"].get<double>() == Approx(16).margin(0.02));
  CHECK(lines(read(folder / "out/sweep.rows")).size() == 2);
}

TEST_CASE("a run whose formula is refused has the refusal as its failure") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink() + "wrong = speeed(1)\n");
  const Ran ran = delf_program(folder, "sweep '" + scene + "' --initial.speed=0.1,0.2 --sweep.keep=table --out out");
  CHECK(ran.code == 2);
  CHECK(contains(ran.err, "none of its runs could begin"));
  const Json run = sweep_of(folder)["runs"][0];
  CHECK(run["status"] == "bad-input");
  CHECK(contains(run["failure"].get<std::string>(), "measure.wrong"));
  CHECK(contains(run["failure"].get<std::string>(), "speeed"));
}

TEST_CASE("runs are shown side by side: by compare, and by a sweep over words") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", scene_with_kink());
  const auto table = [](const Ran& ran) {
    return contains(ran.out, "error_linf") && contains(ran.out, "energy_error_max");
  };
  const Ran words = delf_program(folder, "compare '" + scene + "' --lattice.stencil=triangle,rectangle --out words");
  INFO(words.err);
  REQUIRE(words.code == 0);
  CHECK(table(words));
  CHECK(table(delf_program(folder, "sweep '" + scene + "' --lattice.stencil=triangle,rectangle --out words")));
  const Ran numbers = delf_program(folder, "compare '" + scene + "' --lattice.sites=101,201 --out numbers");
  CHECK(table(numbers));
  CHECK_FALSE(table(delf_program(folder, "sweep '" + scene + "' --lattice.sites=101,201 --out swept")));
  if (has_gnuplot()) {
    CHECK(std::filesystem::exists(folder / "words/figures/sweep.svg"));
    const std::string figure = read(folder / "words/figures/sweep.svg");
    CHECK(contains(figure, "rectangle"));
    CHECK(contains(figure, "side by side"));
  }
  CHECK(contains(delf_program(folder, "compare '" + scene + "'").err, "compare what? Give a key several values"));
}
