// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

Json sweep_of(const Folder& folder, const std::string& keys) {
  const Ran ran = delf_program(folder, "sweep phi4-collision --sweep.keep=table --out out " + keys);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  return Json::parse(read(folder / "out/sweep.json"));
}

}  // namespace

TEST_CASE("kinks of phi4 part after one bounce or two, or stay together, at the speeds where they are known to") {
  const Folder folder;
  const Json sweep = sweep_of(folder, "--initial.speed=0.18,0.198,0.21,0.226,0.234,0.3,0.5");
  const auto measure = [&](std::size_t run, const char* name) {
    return sweep["runs"][run]["summary"]["measures"][name];
  };
  for (const std::size_t captured : {0u, 2u, 4u}) CHECK(measure(captured, "bounces") > 2);
  for (const std::size_t window : {1u, 3u}) {
    CHECK(measure(window, "bounces") == 2);
    CHECK(measure(window, "apart") > 6);
  }
  for (const std::size_t free : {5u, 6u}) CHECK(measure(free, "bounces") == 1);
  CHECK(measure(5, "outgoing").get<double>() == Approx(0.1383).margin(0.005));
  CHECK(measure(6, "outgoing").get<double>() == Approx(0.390).margin(0.003));
}

TEST_CASE("the critical speed of phi4 is found by bisection", "[slow]") {
  const Folder folder;
  const Json found = sweep_of(
      folder,
      "--run.until=250 --sweep.bisect=initial.speed=0.255:0.265 --sweep.level=1.25 --sweep.accuracy=2e-4")["threshold"];
  // 0.2598, less an error of second order in k: 0.2585 at k = 0.1, 0.2595 at k = 0.05
  CHECK(found["value"].get<double>() == Approx(0.2585).margin(0.0003));
}

TEST_CASE("the shape mode of a kink of phi4 has the frequency sqrt(3)") {
  const Folder folder;
  const std::string scene =
      folder.write("shape.ini",
                   "[theory]\nname = phi4\nlambda = 2\n[lattice]\nstencil = rectangle-symmetric\nspace = interval\n"
                   "length = 40\nsites = 801\ncourant = 0.5\n[initial]\n"
                   "phi = tanh(x - 20) + 0.01*sinh(x - 20)/cosh(x - 20)^2\n[run]\nuntil = 100\n"
                   "[output]\nevery = 10\nfigures = off\nfields = off\n[measure]\nomega = frequency(21)\n");
  REQUIRE(delf_program(folder, "run '" + scene + "' --out out").code == 0);
  const double omega = Json::parse(read(folder / "out/summary.json"))["measures"]["omega"];
  CHECK(omega == Approx(std::numbers::sqrt3).epsilon(0.003));  // period 3.6276
}

TEST_CASE("a kink is reflected by a natural and by a fixed wall, and gains 2 ln(1/v)/gamma") {
  const Folder folder;
  for (const std::string wall : {"natural", "fixed"})
    for (const double v : {0.5, 0.7}) {
      const Ran ran = delf_program(folder, "run wall-reflection --boundary.right=" + wall +
                                               " --initial.speed=" + std::to_string(v) + " '--measure.gain=60 - " +
                                               std::to_string(v) + "*t - position(1)' --output.figures=off --out out");
      INFO(wall << " " << v << ran.err);
      REQUIRE(ran.code == 0);
      const double gain = Json::parse(read(folder / "out/summary.json"))["measures"]["gain"];
      const double theory = 2 * std::log(1 / v) * std::sqrt(1 - v * v);
      CHECK(gain == Approx(theory).margin(0.02));
    }
}

TEST_CASE("a slow kink is pinned by a coarse lattice, and moves on a fine one") {
  const Folder folder;
  const auto measures = [&](const std::string& keys) {
    REQUIRE(delf_program(folder, "run peierls-nabarro --output.figures=off --out out " + keys).code == 0);
    return Json::parse(read(folder / "out/summary.json"))["measures"];
  };
  const Json pinned = measures(""), free = measures("--lattice.sites=241");
  CHECK(pinned["place"].get<double>() == Approx(20.25).margin(0.75));  // within the cell that it began in
  CHECK(std::abs(pinned["speed"].get<double>()) < 0.01);
  CHECK(free["place"].get<double>() == Approx(40).margin(0.2));
  CHECK(free["speed"].get<double>() == Approx(0.2).margin(0.005));
}

TEST_CASE("an impurity captures a kink, reflects it at 0.255, and lets it pass from 0.2646 on", "[slow]") {
  const Folder folder;
  const Ran ran =
      delf_program(folder, "sweep impurity --initial.speed=0.24,0.25,0.255,0.26,0.27 --sweep.keep=table --out out");
  REQUIRE(ran.code == 0);
  const Json runs = Json::parse(read(folder / "out/sweep.json"))["runs"];
  const auto place = [&](std::size_t run) { return runs[run]["summary"]["measures"]["place"].get<double>(); };
  for (const std::size_t captured : {0u, 1u, 3u}) CHECK(place(captured) == Approx(60).margin(3));
  CHECK(place(2) < 55);
  CHECK(place(4) > 70);
  const Ran bisection = delf_program(folder,
                                     "sweep impurity --sweep.bisect=initial.speed=0.262:0.27 --sweep.level=68 "
                                     "--sweep.accuracy=2e-4 --run.until=300 --sweep.keep=table --out out");
  REQUIRE(bisection.code == 0);
  const double found = Json::parse(read(folder / "out/sweep.json"))["threshold"]["value"];
  CHECK(found == Approx(0.2646).margin(0.0004));
}
