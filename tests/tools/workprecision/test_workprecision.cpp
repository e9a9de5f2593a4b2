// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/scene/keys.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

// A folder with a scene: a breather on 64 sites for two time units, exact; its steps take microseconds.
struct WithScene : Folder {
  WithScene() {
    write("small.ini",
          "[theory]\nname = sine-gordon\n[lattice]\nlength = 40\nsites = 64\ncourant = 0.5\n"
          "[initial]\nstate = breather\n[run]\nuntil = 2\n[output]\nfigures = off\n");
  }
};

Json compared(const Folder& folder, const std::string& arguments, int code = 0) {
  std::filesystem::remove_all(folder / "out");
  const Ran ran = delf_program(folder, "workprecision " + arguments + " --workprecision.peers=off --out out");
  INFO(arguments << "\n" << ran.out << ran.err);
  CHECK(ran.code == code);
  REQUIRE(std::filesystem::exists(folder / "out/workprecision.json"));
  CHECK_FALSE(contains(ran.out, "nan"));
  return Json::parse(read(folder / "out/workprecision.json"));
}

const std::string two =
    " --workprecision.schemes=rectangle-symmetric,triangle-vertex --workprecision.sites=64,128 "
    "--workprecision.repeats=2 ";

}  // namespace

TEST_CASE("workprecision runs a ladder of two schemes, and writes every field of every run") {
  const WithScene folder;
  const Json json = compared(folder, "small.ini" + two);
  CHECK(json["status"] == "done");
  CHECK(json["reference"] == "the exact solution");
  REQUIRE(json["runs"].size() == 4);
  for (const Json& run : json["runs"]) {
    CAPTURE(run.dump());
    CHECK(run["peer"] == false);
    CHECK((run["sites"] == 64 || run["sites"] == 128));
    CHECK(std::abs(run["time_step"].get<double>() * run["steps"].get<double>() - 2) < 1e-14);  // the end is met exactly
    CHECK(run["repeats"] == 2);
    CHECK(run["seconds"] > 0);
    CHECK(run["seconds_min"] <= run["seconds"]);
    CHECK(run["seconds"] <= run["seconds_max"]);
    CHECK(run["seconds_setup"] > 0);
    CHECK(run["error_linf"] > 1e-6);
    CHECK(run["error_l2"] > 1e-6);
    CHECK(run["energy_error_max"] >= 0);
    CHECK(run["position_error"] < 1e-9);  // a breather at rest stays where it is
    CHECK(run["velocity_error"] < 1e-6);
  }
  CHECK(json["cheapest"].size() == 9);
  CHECK(json["left_out"].empty());
  const auto csv = lines(read(folder / "out/workprecision.csv"));
  REQUIRE(csv.size() == 5);
  CHECK(csv[0].starts_with("scheme,peer,sites,time_step,steps,error_linf,error_l2,energy_error_max,"));
  CHECK(csv[1].starts_with("rectangle-symmetric,0,"));
}

TEST_CASE("workprecision shows the observed order and the forces in a step, in tables that a paper can print") {
  const WithScene folder;
  const Json json = compared(folder,
                             "small.ini --workprecision.schemes=triangle-vertex,rectangle-symmetric,composition "
                             "--workprecision.sites=128,256 --workprecision.courants=0.5 --workprecision.repeats=1");
  const auto of = [&](const std::string& scheme) {
    return *std::ranges::find_if(json["schemes"], [&](const Json& line) { return line["scheme"] == scheme; });
  };
  CHECK(std::abs(of("triangle-vertex")["order"].get<double>() - 2) < 0.1);
  CHECK(std::abs(of("composition (4,4)")["order"].get<double>() - 4) < 0.3);
  CHECK(of("triangle-vertex")["forces_per_step"] == 1);
  CHECK(of("composition (2,4)")["forces_per_step"] == 1);
  CHECK(of("composition (4,4)")["forces_per_step"] == 6);
  CHECK(of("rectangle-symmetric")["forces_per_step"].get<double>() >= 1);
  CHECK(lines(read(folder / "out/workprecision.csv"))[0].ends_with(",forces_per_step"));
  const std::string markdown = read(folder / "out/workprecision.md"), latex = read(folder / "out/workprecision.tex");
  const std::size_t rows = json["schemes"].size();
  CHECK(lines(markdown).size() == rows + 4);  // what it is, a blank line, two lines of heads
  CHECK(contains(markdown, "| triangle-vertex | 2 | "));
  CHECK(contains(latex, "\\begin{tabular}{lrrrrrrrrrr}"));
  CHECK(contains(latex, "triangle-vertex & 2 & "));
  CHECK(lines(latex).size() == rows + 8);
}

TEST_CASE("errors of workprecision are those of a run, to the last bit") {
  const WithScene folder;
  const auto stencil = GENERATE(as<std::string>(), "rectangle-symmetric", "triangle-vertex", "hexagon");
  const Json json = compared(folder,
                             "small.ini --workprecision.repeats=2 --workprecision.sites=64 "
                             "--workprecision.courants=0.5 --workprecision.schemes=" +
                                 stencil);
  REQUIRE(json["runs"].size() == 1);
  const Json& run = json["runs"][0];
  const Ran ran = delf_program(folder, "run small.ini --lattice.stencil=" + stencil +
                                           " --lattice.time_step=" + run["time_step"].dump() +
                                           " --run.steps=" + run["steps"].dump() + " --output.every=1 --out run");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const Json summary = Json::parse(read(folder / "run/summary.json"));
  CHECK(run["error_linf"] == summary["error_linf"]);
  CHECK(run["error_l2"] == summary["error_l2"]);
  CHECK(run["energy_error_max"].get<double>() <= summary["energy_error_max"].get<double>() * (1 + 1e-12));
  CHECK(run["energy_error_max"].get<double>() > 0.3 * summary["energy_error_max"].get<double>());
}

TEST_CASE("a kink's position and velocity errors fall with the square of the step") {
  const Folder folder;
  const Json json = compared(folder,
                             "kink --run.until=4 --output.figures=off --workprecision.schemes=triangle-vertex "
                             "--workprecision.sites=256,512 --workprecision.repeats=1");
  REQUIRE(json["runs"].size() == 2);
  const auto of = [&](int sites, const char* name) {
    for (const Json& run : json["runs"])
      if (run["sites"] == sites) return run[name].get<double>();
    return std::nan("");
  };
  for (const char* name : {"position_error", "velocity_error"}) {
    CAPTURE(name, of(256, name), of(512, name));
    CHECK(of(256, name) > 1e-6);
    CHECK(std::abs(of(256, name) / of(512, name) - 4) < 0.6);
  }
}

TEST_CASE("a scheme that cannot be built or run is left out with its reason, and the others are there") {
  const WithScene folder;
  const Json json = compared(folder,
                             "small.ini --workprecision.schemes=triangle-vertex,midpoint,hexagon "
                             "--workprecision.sites=63 --workprecision.repeats=1");
  REQUIRE(json["runs"].size() == 1);
  CHECK(json["runs"][0]["scheme"] == "triangle-vertex");
  REQUIRE(json["left_out"].size() == 2);  // once each
  for (const Json& one : json["left_out"]) CHECK(one["reason"].get<std::string>().size() > 20);

  const Json unstable = compared(folder,
                                 "small.ini --run.until=400 --workprecision.schemes=triangle-vertex "
                                 "--workprecision.sites=64 --workprecision.courants=1.5",
                                 3);
  REQUIRE(unstable["left_out"].size() == 1);
  CHECK(contains(unstable["left_out"][0]["reason"].get<std::string>(), "finite"));
  CHECK(unstable["runs"].empty());
  const Ran none = delf_program(
      folder, "workprecision small.ini --workprecision.schemes=hexagon --workprecision.sites=63 --out out");
  CHECK(none.code == 3);
  CHECK(lines(none.err).size() == 1);
  CHECK(contains(none.err, "no run could be timed, for the reasons above"));
}

TEST_CASE("without an exact solution runs are compared with a finer one, and come nearer to it") {
  const Folder folder;
  const Json json = compared(folder,
                             "collision --run.until=4 --output.figures=off "
                             "--workprecision.schemes=triangle-vertex --workprecision.courants=0.5 "
                             "--workprecision.sites=64,128 --workprecision.repeats=1 --workprecision.budget=100");
  CHECK(json["reference"] != "the exact solution");
  CHECK(json["reference_error"] > 0);
  REQUIRE(json["runs"].size() == 2);
  // Runs are listed by how long they took, which hangs on what else the machine does.
  const std::size_t of_64 = json["runs"][0]["sites"] == 64 ? 0 : 1;
  const double coarse = json["runs"][of_64]["error_linf"], fine = json["runs"][1 - of_64]["error_linf"];
  CAPTURE(coarse, fine, json["reference"]);
  CHECK(json["runs"][of_64]["sites"] == 64);
  CHECK(json["runs"][1 - of_64]["sites"] == 128);
  CHECK(coarse > 2 * fine);
  CHECK(fine > 10 * json["reference_error"].get<double>());
  CHECK(json["runs"][0]["position_error"].is_null());
}

TEST_CASE("resolutions that workprecision chooses end at the requested accuracy") {
  const WithScene folder;
  const Json json = compared(folder,
                             "small.ini --workprecision.schemes=triangle-vertex --workprecision.repeats=1 "
                             "--workprecision.accuracies=1e-2,1e-4 --workprecision.budget=100");
  REQUIRE(json["cheapest"].size() == 2);
  REQUIRE_FALSE(json["runs"].empty());
  CHECK(json["cheapest"][1]["accuracy"] == 1e-4);
  CHECK(json["cheapest"][1]["engine"]["error_linf"] <= 1e-4);
  CHECK(json["cheapest"][1]["peer"].is_null());
  CHECK(json["cheapest"][1]["ratio"].is_null());
  const auto least = std::ranges::min(json["runs"], {}, [](const Json& r) { return r["error_linf"].get<double>(); });
  CHECK(least["error_linf"] > 5e-6);  // it stops there
  CHECK(json["tried"] >= json["runs"].size());
  CHECK(json["schemes"][0]["slope"].is_number());  // its value hangs on how long runs of microseconds happen to take
}

TEST_CASE("an interrupted comparison writes what it has, and ends with exit code 130") {
  const WithScene folder;
  const Ran ran =
      shell(folder, "'" + program_path() +
                    "' workprecision small.ini --run.until=50 --workprecision.budget=1e9 --out cut "
                    // the first run is over at once, however slow the machine, and the second never
                    "--workprecision.sites=32,400000 --workprecision.schemes=rectangle-symmetric & p=$!; sleep 2; "
                    "kill -INT $p; wait $p");
  INFO(ran.err);
  CHECK(ran.code == 130);
  CHECK(contains(ran.out, "not finished (interrupted)"));
  const Json json = Json::parse(read(folder / "cut/workprecision.json"));
  CHECK(json["status"] == "interrupted");
  REQUIRE_FALSE(json["runs"].empty());
  CHECK(json["runs"][0]["repeats"] == 0);  // each has run once, untimed
  CHECK(json["runs"][0]["seconds"] > 0);
}

TEST_CASE("the scene's own scheme is run at the scene's own resolution, and is in the tables", "[slow]") {
  const Folder folder;
  const Json json = compared(folder,
                             "soliton-bounce --run.until=4 --output.figures=off --workprecision.budget=8 "
                             "--workprecision.repeats=1 "
                             "--workprecision.schemes='r-adaptive,triangle-vertex,composition (2,4)'");
  const auto own = [](const Json& run) { return run["own"] == true; };
  CHECK(std::ranges::count_if(json["schemes"], own) == 1);
  const auto at = std::ranges::find_if(json["runs"], [](const Json& run) {
    return run["scheme"] == "r-adaptive" && run["sites"] == 36 && run["steps"] == 400;
  });
  REQUIRE(at != json["runs"].end());
  CHECK(own(*at));
  CHECK((*at)["error_linf"] < 0.1);
  CHECK(std::ranges::count(json["runs"], "r-adaptive", [](const Json& run) { return run["scheme"]; }) > 2);

  // a scheme without a name in the list has one from the scene
  const Json unnamed =
      compared(folder,
               "kink --run.until=1 --output.figures=off --workprecision.budget=1 "
               "--scheme.method=composition --scheme.splitting=blanes-moan-4 --workprecision.repeats=1 "
               "--workprecision.accuracies=1e-2 --workprecision.schemes='composition'");
  CHECK(std::ranges::count_if(unnamed["schemes"], own) == 1);
}

TEST_CASE("a scheme that fails at the first, coarse resolution is tried at finer ones") {
  const Folder folder;
  const auto scheme = GENERATE(as<std::string>(), "six-tuple", "nine-tuple");  // the scene's own, and another
  const Json json = compared(folder,
                             "kdv --run.until=2 --output.figures=off --workprecision.repeats=1 "
                             "--workprecision.budget=2 --workprecision.accuracies=1e-1,1e-2 "
                             "--workprecision.schemes=" +
                                 scheme);
  REQUIRE_FALSE(json["runs"].empty());
  CHECK(json["left_out"].empty());
  const auto least = std::ranges::min(json["runs"], {}, [](const Json& r) { return r["error_linf"].get<double>(); });
  CHECK(least["error_linf"] < 0.1);
}

TEST_CASE("the budget and Ctrl-C end workprecision within a run") {
  const WithScene folder;
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  auto from = Clock::now();
  // a run of hours
  const std::string endless =
      "small.ini --run.until=1e9 --workprecision.sites=64 --workprecision.schemes=rectangle-symmetric ";
  const Json never = compared(folder, endless + "--workprecision.budget=1", 3);
  // one that takes longer than it seems
  const Json stopped = compared(folder,
                                "small.ini --run.until=5e4 --workprecision.budget=1 --workprecision.sites=64 "
                                "--workprecision.schemes='spacetime (4,6) gauss'",
                                3);
  CHECK(seconds(from) < 10);
  CHECK(contains(never["left_out"][0]["reason"].get<std::string>(), "raise workprecision.budget"));
  REQUIRE(stopped["left_out"].size() == 1);
  CHECK(contains(stopped["left_out"][0]["reason"].get<std::string>(), "stopped after"));

  // in a run, and in the one that others would have been compared with
  for (const std::string& arguments :
       {endless, std::string("collision --run.until=1e8 --workprecision.schemes=rectangle-symmetric ")}) {
    from = Clock::now();
    const Ran cut = shell(folder, "'" + program_path() + "' workprecision " + arguments +
                                      "--workprecision.budget=1e9 --out cut & p=$!; sleep 1; kill -TERM $p; wait $p");
    INFO(cut.out << cut.err);
    CHECK(cut.code == 130);
    CHECK(seconds(from) < 10);
    CHECK(Json::parse(read(folder / "cut/workprecision.json"))["status"] == "interrupted");
  }
}

TEST_CASE("keys of workprecision that say nothing are refused in one line") {
  const WithScene folder;
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    const Ran ran = delf_program(folder, "workprecision " + arguments + " --out refused");
    INFO(arguments);
    check_refused(ran, {reason});
    CHECK_FALSE(std::filesystem::exists(folder / "refused"));
  };
  refused("small.ini --workprecision.schemes=triangle-vertx", "triangle-vertx is no scheme here; did you mean");
  refused("small.ini --workprecision.schemes=,", "names no scheme; write names separated by commas, or all");
  refused("small.ini --workprecision.sites=64,1", "1 is no number of sites");
  refused("small.ini --workprecision.sites=64,x", "\"x\" is no positive number");
  refused("small.ini --workprecision.courants=-1", "\"-1\" is no positive number");
  refused("small.ini --workprecision.budget=0", "must be above 0");
  refused("small.ini --run.until=0", "use more");
  refused("pendulum --workprecision.sites=3", "a point has no sites");
}

TEST_CASE("help workprecision lists every key of its section") {
  const Folder folder;
  const Ran ran = delf_program(folder, "help workprecision");
  CHECK(ran.code == 0);
  int keys = 0;
  for (const auto& key : delf::keys())
    if (key.key.starts_with("workprecision.")) {
      ++keys;
      CHECK(contains(ran.out, std::string(key.key)));
    }
  CHECK(keys == 7);
}

TEST_CASE("workprecision draws its figure, with a line for each scheme and its slope") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const WithScene folder;
  const Ran ran = delf_program(folder, "workprecision small.ini" + two + "--output.figures=on --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(read(folder / "out/figures/workprecision.png").starts_with("\x89PNG"));
  const std::string svg = read(folder / "out/figures/workprecision.svg");
  for (const char* part : {"</svg>", "rectangle-symmetric", "triangle-vertex", "lower envelope"})
    CHECK(contains(svg, part));

  const Ran without =
      delf_program(folder, "workprecision small.ini" + two + "--output.figures=on --out out", "PATH=/nowhere");
  CHECK(without.code == 0);
  CHECK(contains(without.err, "gnuplot"));
  CHECK_FALSE(std::filesystem::exists(folder / "out/figures/workprecision.svg"));
}

#ifdef DELF_HAS_PEERS
TEST_CASE("peers are in the same run as the engine, and the tables compare them") {
  const WithScene folder;
  const Ran ran = delf_program(folder,
                               "workprecision small.ini --workprecision.schemes=triangle-vertex,peers "
                               "--workprecision.sites=256 --workprecision.courants=0.1 "
                               "--workprecision.repeats=2 --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const Json json = Json::parse(read(folder / "out/workprecision.json"));
  for (const Json& line : json["schemes"]) CHECK(line["forces_per_step"] >= 1);
  const auto peers = std::ranges::count_if(json["runs"], [](const Json& run) { return run["peer"] == true; });
  CHECK(peers > 0);
  CHECK(peers + 1 == static_cast<std::ptrdiff_t>(json["runs"].size()));
  for (const Json& run : json["runs"]) {
    CAPTURE(run.dump());
    CHECK(run["error_linf"] < 0.05);  // the same solution
    CHECK(run["energy_error_max"] < 0.01);
  }
  CHECK(json["cheapest"][0]["ratio"] > 0);
  CHECK(contains(ran.out, "cheapest peer"));

  // names that hold commas select what they name, alone and in a list
  const Ran two_peers = delf_program(folder,
                                     "workprecision small.ini --workprecision.sites=64 --workprecision.courants=0.1 "
                                     "--workprecision.repeats=1 --out named --workprecision.schemes='leapfrog, Fourier "
                                     "split-step 6, mass in the flow,odeint fehlberg 8, differences 4'");
  INFO(two_peers.err);
  REQUIRE(two_peers.code == 0);
  std::vector<std::string> named;
  const Json of_named = Json::parse(read(folder / "named/workprecision.json"));
  for (const Json& run : of_named["runs"]) named.push_back(run["scheme"].get<std::string>());
  std::ranges::sort(named);
  CHECK(named == std::vector<std::string>{"Fourier split-step 6, mass in the flow", "odeint fehlberg 8, differences 4",
                                          "triangle-vertex"});

  // there is no peer for another equation
  const Ran other = delf_program(folder,
                                 "workprecision interval --run.until=1 --workprecision.repeats=1 --out other "
                                 "--workprecision.schemes=rectangle-symmetric,peers --workprecision.sites=65 "
                                 "--workprecision.budget=100 --output.figures=off");
  INFO(other.err);
  CHECK(other.code == 0);
  CHECK(Json::parse(read(folder / "other/workprecision.json"))["runs"].size() == 1);
}
#endif

TEST_CASE("the report explains names, and says a reason that schemes share once with their number") {
  const WithScene folder;
  const Ran ran = delf_program(folder,
                               "workprecision small.ini --workprecision.sites=16,32 --workprecision.peers=off "
                               "--workprecision.schemes='composition (2,4),midpoint,trapezoidal,vertex' --out out");
  INFO(ran.out << ran.err);
  CHECK(contains(ran.out, "composition (s,p): sub-steps of leapfrog"));
  CHECK_FALSE(contains(ran.out, "odeint NAME"));
  CHECK(contains(ran.out, "3 schemes: is for mechanics and couples no neighbours"));
  CHECK(contains(ran.out, "midpoint; trapezoidal; vertex"));
}
