// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;

namespace {

const std::string wave = "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2\n";
std::string on(const std::string& space, const std::string& more = "") {
  return "[lattice]\nstencil = rectangle-symmetric\nspace = " + space +
         "\nlength = 10\nsites = 41\ncourant = 0.5\n[run]\nuntil = 3\n" + "[output]\nfigures = off\n" + more;
}

std::vector<std::string> warnings(const Folder& folder, const std::string& arguments) {
  const Ran ran = delf_program(folder, "run " + arguments + " --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / "out/summary.json"))["warnings"];
}

bool any_contains(const std::vector<std::string>& all, const std::string& part) {
  for (const std::string& one : all)
    if (contains(one, part)) return true;
  return false;
}

}  // namespace

TEST_CASE("an exact solution that is none is refused, with the point") {
  const Folder folder;
  folder.write("wave.ini", wave + on("circle"));
  const std::string refused = "does not solve the field equation of phi at t = ";
  for (const char* command : {"run", "plan", "convergence"})
    check_refused(delf_program(folder, std::string(command) + " wave.ini --exact.phi='cos(2*pi*x/10)*cos(t)'"),
                  {"command line: --exact.phi = cos(2*pi*x/10)*cos(t): " + refused,
                   "or give a start that is no solution as initial.phi"});
  // of a compiled theory, and of second order
  folder.write("sine-gordon.ini", "[theory]\nname = sine-gordon\n" + on("interval"));
  check_refused(delf_program(folder, "plan sine-gordon.ini --exact.phi='4*atan(exp(x - 5 - t/2))'"), {refused});
  folder.write("beam.ini", "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_xx^2\n" + on("circle"));
  check_refused(
      delf_program(folder, "plan beam.ini --lattice.stencil=nine-tuple --exact.phi='cos(2*pi*x/10)*cos(2*pi*t/10)'"),
      {refused});
}

TEST_CASE("an exact solution is not refused for its tails, where it is rounding, or for what it does at walls") {
  const Folder folder;
  const auto passes = [&](const std::string& arguments) {
    const Ran ran = delf_program(folder, "plan " + arguments);
    INFO(arguments << "\n" << ran.err);
    CHECK(ran.code == 0);
  };
  folder.write("sine-gordon.ini", "[theory]\nname = sine-gordon\n" + on("interval"));
  folder.write("text.ini", "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1\n" + on("interval"));
  folder.write("wave.ini", wave + on("circle"));
  folder.write("phi4.ini", "[theory]\nname = phi4\n" + on("interval"));
  folder.write("beam.ini", "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_xx^2\n" + on("circle"));
  for (const char* scene : {"sine-gordon.ini", "text.ini"}) {
    const std::string kink = std::string(scene) + " --exact.phi='4*atan(exp((x - L/2 - 0.5*t)/sqrt(0.75)))'";
    passes(kink);
    passes(kink + " --lattice.length=1000 --lattice.sites=4001");      // nearly all points are vacuum
    passes(kink + " --lattice.length=100000 --lattice.sites=400001");  // exp overflows
    passes(std::string(scene) + " --exact.phi=2*pi");
    // two kinks far apart, whose tails add
    passes(std::string(scene) + " --lattice.length=60 --exact.phi='4*atan(exp(x - 15)) + 4*atan(exp(x - 45))'");
  }
  passes("phi4.ini --lattice.length=60 --exact.phi='tanh((x - 30)/sqrt(2))'");
  passes("wave.ini --exact.phi='cos(2*pi*x/10)*cos(2*pi*t/10)'");
  passes("wave.ini --exact.phi='1e-8*cos(2*pi*(x - t)/10)'");
  passes("beam.ini --lattice.stencil=nine-tuple --exact.phi='cos(2*pi*x/10)*cos((2*pi/10)^2*t)'");
  // a scheme of another equation has other solutions
  passes("wave.ini --scheme.method=damped --theory.name=wave --exact.phi='cos(2*pi*x/10)*cos(t)'");
}

TEST_CASE("a run says where its exact solution has no value, closes on no circle, or moves a fixed wall") {
  const Folder folder;
  folder.write("wave.ini", wave + on("circle"));
  // a pulse on the line leaves through the seam
  CHECK(any_contains(warnings(folder, "wave.ini --exact.phi='exp(-(x-t-5)^2)'"),
                     "the exact solution jumps where the circle closes"));
  CHECK_FALSE(any_contains(warnings(folder, "wave.ini --exact.phi='cos(2*pi*(x-t)/10)'"), "the exact solution"));
  folder.write("walls.ini", wave + on("interval"));
  CHECK(any_contains(warnings(folder, "walls.ini --exact.phi='sqrt(12 - x - t)'"),
                     "the exact solution phi has no value at t = "));
  const std::string moving = "walls.ini --exact.phi='sin(2*pi*(t - x)/10) + 0.5*sin(2*pi*(t + x)/10)'";
  CHECK(any_contains(warnings(folder, moving), "the exact solution moves at the left wall, which is fixed"));
  CHECK_FALSE(
      any_contains(warnings(folder, "walls.ini --exact.phi='sin(2*pi*x/10)*cos(2*pi*t/10)'"), "the exact solution"));
}

TEST_CASE("a formula that does not close around the circle is refused, and boundary.gain closes it") {
  const Folder folder;
  folder.write("path.ini",
               "[theory]\ndensity = 0.5*(phi_x*phi_t^2 + phi_tx^2/phi_x)\n[initial]\nphi = x\nphi_t = 0.6 + "
               "0.3*cos(2*pi*x/L)\n" +
                   on("circle"));
  const std::string scene = "path.ini --lattice.stencil=six-tuple --lattice.sites=80 --lattice.courant=0.25";
  check_refused(delf_program(folder, "run " + scene),
                {"initial.phi: gains 10 around the circle", "boundary.gain = 10"});
  const Ran closed = delf_program(folder, "run " + scene + " --boundary.gain=10 --output.every=1 --out out");
  INFO(closed.err);
  REQUIRE(closed.code == 0);
  const auto summary = nlohmann::json::parse(read(folder / "out/summary.json"));
  CHECK(summary["winding"] == 0);
  CHECK(summary["boundary_gain"] == 10);
  CHECK(summary["charge_final"].get<double>() == Approx(10 / (2 * std::acos(-1.0))));
  // a gain of 2 pi is what a winding is, to the bit
  const std::string shipped = "run camassa-holm --run.steps=20 --output.figures=off ";
  REQUIRE(delf_program(folder, shipped + "--out winding").code == 0);
  REQUIRE(delf_program(folder, shipped + "--boundary.winding=0 --boundary.gain=2*pi --out gain").code == 0);
  CHECK(read(folder / "winding/series.csv") == read(folder / "gain/series.csv"));
  folder.write("line.ini", wave + "[initial]\nphi = x + 0.3*sin(2*pi*x/L)\n" + on("circle"));
  const Ran line = delf_program(folder, "run line.ini --boundary.gain=10 --out line");
  REQUIRE(line.code == 0);
  const auto wound = nlohmann::json::parse(read(folder / "line/summary.json"));
  // E = ½ ∫ φ_x² = ½ (1 + ½ (0.6 π/10)²) 10, by differences of order 2
  CHECK(wound["energy_initial"].get<double>() == Approx(5 * (1 + 0.5 * 0.0355305758)).epsilon(1e-3));
  CHECK(wound["energy_error_max"].get<double>() < 1e-12);
  // what is recorded starts again, and is verified
  CHECK(delf_program(folder, "run line/scene.ini --out again").code == 0);
  CHECK(delf_program(folder, "verify line.ini --boundary.gain=10").code == 0);
  CHECK(delf_program(folder, "run line.ini --boundary.gain=10 --output.every=1 --out all").code == 0);
  CHECK(delf_program(folder, "verify line.ini --boundary.gain=10 --fields all/fields.h5").code == 0);
  check_refused(delf_program(folder, "run kink --lattice.space=circle --boundary.gain=1"),
                {"boundary.gain = 1: the state kink gains nothing"});
  check_refused(delf_program(folder, "run line.ini --theory.fibre=S1 --boundary.gain=10"),
                {"boundary.gain", "use boundary.winding"});
}
