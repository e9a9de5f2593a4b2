// SPDX-License-Identifier: MIT
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

Json convergence_of(const Folder& folder, const std::string& arguments, int code) {
  const Ran ran = delf_program(folder, "convergence " + arguments + " --output.figures=off --out out");
  INFO(ran.err << ran.out);
  REQUIRE(ran.code == code);
  return Json::parse(read(folder / "out/convergence.json"));
}

const std::string small = "breather --run.until=4 --convergence.levels=4 ";

}  // namespace

TEST_CASE("the table of a scene has its errors and their order, and another order is refused") {
  const Folder folder;
  const Json table = convergence_of(folder, small + "--lattice.sites=51 --convergence.order=2", 0);
  CHECK(table["error"] == "exact");
  REQUIRE(table["levels"].size() == 4);
  CHECK(table["levels"][0]["sites"] == 51);
  CHECK(table["levels"][3]["sites"] == 408);
  CHECK(table["order"].get<double>() == Approx(2).margin(0.1));
  CHECK(table["levels"][3]["error_linf"].get<double>() < table["levels"][2]["error_linf"].get<double>() / 3.5);
  CHECK(lines(read(folder / "out/convergence.csv")).size() == 5);
  CHECK(convergence_of(folder, small + "--lattice.sites=51 --convergence.order=3", 1)["passed"] == false);
  CHECK(convergence_of(folder, small + "--lattice.sites=51 --convergence.order=1", 1)["passed"] == false);
}

TEST_CASE("where errors are not the scheme's, the table says whose they are, and accuses no scheme") {
  const Folder folder;
  const std::string wave =
      "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2\n[run]\nuntil = 1\n[exact]\n"
      "phi = sin(x - sqrt(2)*t)\n[lattice]\nstencil = triangle-vertex\nlength = 6.283185307179586\nsites = 32\n"
      "courant = 0.5\n";
  folder.write("right.ini", wave);
  folder.write("moving.ini", wave + "space = interval\n");
  struct Case {
    const char *arguments, *verdict, *reason;
    int code;
  };
  for (const Case& c : std::vector<Case>{
           {"right.ini", "passed", "", 0},
           {"moving.ini", "not measured", "wall, which is fixed", 0},
           {"kink --lattice.length=10 --run.until=2", "not measured", "where the circle closes", 0},
           {"kink --lattice.length=20 --run.until=2", "not measured", "where the circle closes", 0},
           {"breather --lattice.space=interval --boundary.left=natural --boundary.right=natural --lattice.length=8 "
            "--run.until=2 --lattice.sites=41",
            "not measured", "a slope at a natural wall", 0},
           {"pendulum --run.until=2 --lattice.time_step=0.0005 --scheme.method=cgvi --scheme.tableau=gauss4", "", "",
            0},
           {"breather --lattice.stencil=triangle-vertex --lattice.courant=1.2 --lattice.sites=51 --run.until=8 "
            "--convergence.levels=3",
            "unstable", "beyond the linear limit", 3},
       }) {
    CAPTURE(c.arguments);
    const Json table = convergence_of(folder, c.arguments, c.code);
    if (*c.verdict) CHECK(table["verdict"] == c.verdict);
    if (*c.reason) CHECK(contains(table["reason"].get<std::string>(), c.reason));
    CHECK(table["passed"] == (c.code == 0));
  }
}

TEST_CASE("a field that gains around a circle by boundary.gain closes there") {
  const Folder folder;
  folder.write("gain.ini",
               "[theory]\nname = wave\n[lattice]\nstencil = triangle-vertex\nlength = 6.283185307179586\nsites = 32\n"
               "courant = 0.5\n[boundary]\ngain = 12.566370614359172\n[run]\nuntil = 1\n[exact]\nphi = 2*x + sin(x - t)\n");
  const Ran ran = delf_program(folder, "convergence gain.ini --output.figures=off --out out");
  INFO(ran.err << ran.out);
  CHECK(ran.code == 0);
  CHECK(contains(ran.out, "passed"));
  CHECK_FALSE(contains(ran.out, "where the circle closes"));
}

TEST_CASE("a composition of order four shows four") {
  const Folder folder;
  convergence_of(folder,
                 small +
                     "--lattice.sites=80 --scheme.method=composition --scheme.order=4 --lattice.space_order=4 "
                     "--convergence.order=4",
                 0);
}

TEST_CASE("a scheme is held to its own order, where its method declares one") {
  const Folder folder;
  const std::string point = "pendulum --run.until=4 --lattice.time_step=0.2 --convergence.levels=3 ";
  for (const auto& [arguments, order] : std::vector<std::pair<std::string, int>>{
           {small + "--lattice.sites=51", 2},
           {small + "--lattice.sites=51 --scheme.method=guo", 2},
           {point + "--scheme.method=cgvi", 4},
           {point + "--scheme.method=cgvi --scheme.tableau=lobatto3", 4},
           {point + "--scheme.method=radau-iia", 5},
           {small + "--lattice.sites=80 --scheme.method=composition --lattice.space_order=2", 2}}) {
    const Json table = convergence_of(folder, arguments, 0);
    INFO(arguments);
    CHECK(table["order_of_scheme"] == order);
    CHECK(table["order"].get<double>() == Approx(order).margin(0.2));
  }
  // symplectic Euler has none for all densities
  CHECK(convergence_of(folder, point + "--lattice.stencil=vertex", 0)["order_of_scheme"].is_null());
  // a solution with a corner has no second order, and an order that is asked for takes the place of the scheme's
  const std::string corner = folder.write(
      "corner.ini",
      "[theory]\nname = wave\n[lattice]\nstencil = triangle-vertex\nlength = 8\nsites = 64\ncourant = 0.5\n[initial]\n"
      "phi = sqrt(sin(pi*x/8)^2 + 1e-12)\nphi_t = 0\n[run]\nuntil = 3\n");
  CHECK(convergence_of(folder, "'" + corner + "'", 1)["passed"] == false);
  CHECK(convergence_of(folder, "'" + corner + "' --convergence.order=0.736 --convergence.agreement=0.1", 0)["passed"] ==
        true);
}

TEST_CASE("a processed kernel of order four shows four: its rows have the processor undone") {
  const Folder folder;
  // The kernel's own rows are of order one. The circle is long enough for the breather's tails.
  convergence_of(folder,
                 "breather --run.until=4 --convergence.levels=3 --lattice.length=80 --lattice.sites=240 "
                 "--lattice.courant=0.35 --scheme.method=processed --scheme.kernel=ti4 --lattice.space_order=10 "
                 "--convergence.order=4",
                 0);
}

TEST_CASE("without an exact solution the differences between lines have the order") {
  const Folder folder;
  const Json table =
      convergence_of(folder,
                     "phi4-collision --run.until=4 --lattice.sites=400 --initial.separation=6 --convergence.levels=4 "
                     "--convergence.order=2",
                     0);
  CHECK(table["error"] == "difference");
  CHECK(table["levels"][3]["error_linf"].is_null());
  CHECK(table["levels"][2]["error_linf"].is_number());
  CHECK(table["levels"][0]["measures"].contains("bounces"));
}

TEST_CASE("a finer level whose numerics fail is the end of the table, with exit code 3") {
  const Folder folder;
  // an explicit step beyond its limit: it takes some 200 steps to grow out of double precision
  const Ran ran = delf_program(folder,
                               "convergence breather --lattice.stencil=triangle-vertex --lattice.courant=1.5 "
                               "--lattice.sites=51 --convergence.levels=3 --out out");
  INFO(ran.err << ran.out);
  CHECK(ran.code == 3);
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "N = 204"));
  const Json table = Json::parse(read(folder / "out/convergence.json"));
  CHECK(table["status"] == "not-finite");
  CHECK(table["passed"] == false);
  CHECK(table["levels"].size() == 2);
}

TEST_CASE("no order comes of rounding, whatever the size of the field") {
  const Folder folder;
  const std::string wave =
      "wave-packet --theory.name=wave --initial.state=plane-wave --initial.wavenumber=2 --lattice.length=40 "
      "--lattice.sites=100 --lattice.stencil=triangle-vertex --run.until=4 --convergence.levels=3 ";
  for (const char* size : {"1e-9", "1e6"}) {
    const std::string command = wave + "--initial.amplitude=" + size;
    INFO(command);
    CHECK(convergence_of(folder, command, 0)["order"].get<double>() == Approx(2).margin(0.1));
    // exact but for rounding, which here is 1e-24 and 1e-9
    CHECK(convergence_of(folder, command + " --lattice.courant=1", 0)["order"].is_null());
  }
}

TEST_CASE("a convergence that cannot be measured is refused in one line") {
  const Folder folder;
  const Ran ran = delf_program(folder, "convergence breather --convergence.levels=1 --out out");
  CHECK(ran.code == 2);
  CHECK(contains(ran.err, "convergence.levels"));
  CHECK(lines(ran.err).size() == 1);
  check_refused(delf_program(folder, "convergence breather --run.until=0 --out out"),
                {"--run.until = 0: nothing is stepped, so nothing converges; use more"});
}

TEST_CASE("an interrupted convergence says so, and no order") {
  const Folder folder;
  const Ran ran =
      shell(folder, "'" + program_path() +
                        "' convergence kink --lattice.sites=2000 --run.until=1e5 --output.figures=off --out cut & "
                        "p=$!; sleep 0.8; kill -INT $p; wait $p");
  INFO(ran.err << ran.out);
  CHECK(ran.code == 130);
  CHECK(contains(ran.out, "not finished (interrupted): 0 of"));
  CHECK_FALSE(contains(ran.out, "above rounding"));
  CHECK(Json::parse(read(folder / "cut/convergence.json"))["status"] == "interrupted");
}

TEST_CASE("rows of a mesh that moves are compared at its sites") {
  const Folder folder;
  for (const char* scene :
       {"soliton-bounce --lattice.sites=24 --run.until=0.5", "phi4-moving-mesh --lattice.sites=41 --run.until=0.4"}) {
    const Json table = convergence_of(
        folder, std::string(scene) + " --convergence.levels=3 --convergence.order=2 --convergence.agreement=0.4", 0);
    CHECK(table["order"].get<double>() == Approx(2).margin(0.4));
  }
  const Ran refused =
      delf_program(folder, "run soliton-bounce --run.until=0.1 --output.estimate=on --output.figures=off");
  CHECK(contains(refused.out + refused.err, "sites move"));
}

// Tyranowski–Desbrun, section 5.3, at t = 50 with α = 2.5 and h = 0.01: 15 nodes between the walls
TEST_CASE("a bouncing soliton has the error of an independent program to 1 %, and breaks down when that does") {
  const Folder folder;
  struct Case {
    const char *strategy, *time;
    double error, until, break_time;
  };
  for (const Case& c : {Case{"multiplier", "trapezoid", 0.3380150906, 50, -1},
                        {"uniform", "lobatto2", 0.8245507883, 50, -1},
                        {"control", "gauss1", 1.305526414, 36, 35.98}}) {
    const Ran ran = delf_program(folder, std::string("run soliton-bounce --lattice.sites=17 --output.every=0 "
                                                     "--output.figures=off --output.fields=off --out bounce") +
                                             " --scheme.strategy=" + c.strategy + " --scheme.time=" + c.time +
                                             " --run.until=" + std::to_string(c.until));
    CAPTURE(c.strategy, c.time, ran.err);
    CHECK(ran.code == (c.break_time > 0 ? 3 : 0));
    const Json summary = Json::parse(read(folder / "bounce/summary.json"));
    CHECK(summary["error_linf"].get<double>() == Approx(c.error).epsilon(0.01));
    if (c.break_time > 0) CHECK(summary["break_time"].get<double>() == Approx(c.break_time).margin(0.02));
  }
}

TEST_CASE("errors against N are drawn with the slope of the order, on lattices, points, meshes and moving meshes") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  for (const std::string scene : {"breather --lattice.sites=51 --run.until=1", "pendulum --run.until=1",
                                  "sphere --lattice.mesh=icosahedron:1 --run.until=0.6",
                                  "soliton-bounce --lattice.sites=9 --lattice.time_step=0.05 --run.until=0.1"}) {
    CAPTURE(scene);
    const std::string command = "convergence " + scene + " --convergence.levels=3 --output.format=svg --out out";
    const Ran ran = delf_program(folder, command);
    CAPTURE(ran.out, ran.err);
    CHECK((ran.code == 0 || ran.code == 1));
    CHECK(contains(ran.out, "convergence.csv figures"));
    const std::string svg = read(folder / "out/figures/convergence.svg");
    CHECK(contains(svg, "order "));
    CHECK(contains(svg, "maximum norm"));
    // none is asked for: that of the earlier run goes
    CHECK_FALSE(contains(delf_program(folder, command + " --output.figures=off").out, " figures"));
    CHECK_FALSE(std::filesystem::exists(folder / "out/figures/convergence.svg"));
  }
  // without gnuplot the table is there, and one line says what is not
  const Ran without =
      delf_program(folder, "convergence pendulum --run.until=1 --convergence.levels=3 --out out", "PATH=/nowhere");
  CHECK(without.code == 0);
  CHECK(contains(without.err, "no figures: "));
}

TEST_CASE("a solution that jumps where the circle closes is named beside its errors, and one that is periodic is not") {
  const Folder folder;
  const auto printed = [&](double centre) {
    const std::string scene = folder.write(
        "pulse.ini",
        "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2\n[lattice]\nstencil = triangle-vertex\nlength = 40\n"
        "sites = 200\ncourant = 0.5\n[exact]\nphi = 1/cosh(x - " +
            std::to_string(centre) + " - t)\n[run]\nuntil = 1\n");
    const Ran ran =
        delf_program(folder, "convergence '" + scene + "' --convergence.levels=3 --output.figures=off --out out");
    INFO(ran.err);
    CHECK((ran.code == 0 || ran.code == 1));
    return ran.out;
  };
  CHECK(contains(printed(8), "the exact solution jumps where the circle closes"));
  CHECK_FALSE(contains(printed(20), "jumps"));
}

TEST_CASE("where finer steps of the same h/k fail, h/k^2 is named, and an order without a verdict says why") {
  const Folder folder;
  const std::string short_run = "nls --convergence.levels=3 --run.until=0.1 --output.figures=off --out out ";
  const Ran failed = delf_program(folder, "convergence " + short_run);
  CHECK(failed.code == 3);
  CHECK(contains(failed.err, "h/k^2 doubles from line to line"));
  const Ran done = delf_program(folder, "convergence " + short_run + "--lattice.time_step=0.002");
  CHECK(done.code == 0);
  CHECK(contains(done.out, "and the scheme declares none"));
}
