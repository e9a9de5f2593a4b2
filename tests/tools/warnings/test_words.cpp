// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;

namespace {

/// A run of a scene without figures: its report and summary.
struct Reported {
  std::string report, err;
  int code;
  nlohmann::json summary;

  explicit Reported(const std::string& scene, const std::string& more = "") {
    const Folder folder;
    const Ran ran =
        delf_program(folder, "run '" + folder.write("scene.ini", scene) + "' --output.figures=off --out out " + more);
    report = ran.out, err = ran.err, code = ran.code;
    if (std::filesystem::exists(folder / "out/summary.json"))
      summary = nlohmann::json::parse(read(folder / "out/summary.json"));
  }
  bool warns(const std::string& words) const {
    return std::ranges::any_of(summary["warnings"],
                               [&](const auto& w) { return contains(w.template get<std::string>(), words); });
  }
};

std::string lattice(const std::string& space, const std::string& length, int sites) {
  return "[lattice]\nstencil = triangle-vertex\nspace = " + space + "\nlength = " + length +
         "\nsites = " + std::to_string(sites) + "\ncourant = 0.5\n";
}

/// q_tt + 0.2 q_t + q = 0, as a density that reads t.
const std::string friction =
    "[theory]\nfields = q\ndensity = exp(0.2*t)*(0.5*q_t^2 - 0.5*q^2)\n[lattice]\nspace = point\nstencil = midpoint\n"
    "time_step = 0.01\n[exact]\nq = exp(-0.1*t)*(cos(sqrt(0.99)*t) + 0.1/sqrt(0.99)*sin(sqrt(0.99)*t))\n[run]\nuntil = "
    "20\n";

}  // namespace

TEST_CASE("the energy of a density that reads t is compared less its work") {
  const Reported point(friction);
  REQUIRE(point.code == 0);
  CHECK(point.summary["warnings"].empty());
  CHECK(contains(point.report, "the density reads t, and its work is"));
  const double E0 = point.summary["energy_initial"], E = point.summary["energy_final"],
               W = point.summary["energy_work"];
  CHECK(std::abs(E - E0) > 0.04);
  CHECK(std::abs(E - W - E0) < 1e-3);

  const Reported sparse(friction, "--output.every=0");
  CHECK(contains(sparse.report, "the density reads t, whose work more records would tell"));
  CHECK(sparse.summary["energy_work"].is_null());
  CHECK(sparse.summary["warnings"].empty());

  const Reported circle("[theory]\ndensity = exp(g*t)*(0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2)\nparameters = g = 0.4\n" +
                        lattice("circle", "2*pi", 33) +
                        "[exact]\nphi = exp(-g*t/2)*cos(sqrt(2 - g^2/4)*t)*cos(x)\n[run]\nuntil = 3\n");
  CHECK(circle.summary["warnings"].empty());
  // others do no work
  CHECK(Reported(small_scene()).summary["energy_work"].is_null());
}

TEST_CASE("a sum that fixed walls take is not said to be conserved") {
  const std::string wave = "[theory]\nname = wave\n" + lattice("interval", "1", 65) +
                           "[initial]\nphi = 0\nphi_t = sin(pi*x)\n[run]\nuntil = 1\n";
  const Reported fixed(wave);
  CHECK(contains(fixed.report, "at walls   translation = -0.63"));
  CHECK_FALSE(contains(fixed.report, "conserved  translation"));
  CHECK(fixed.summary["conserved"][0]["at_walls"] == true);
  const Reported natural(wave, "--boundary.left=natural --boundary.right=natural");
  CHECK(contains(natural.report, "conserved  translation"));
  CHECK(natural.summary["conserved"][0]["at_walls"] == false);
  // nor is what flows in at an end
  const Reported flux(wave, "'--boundary.left.flux=sin(t)' --boundary.right=natural");
  CHECK(contains(flux.report, "at walls   translation = "));
  CHECK(contains(flux.report, "; the ends give or take it"));
  CHECK(contains(flux.report, "conserved  energy_less_work = "));
  // energies are of no symmetry, whose sums a stencil of three rows has not
  const Reported rows(wave, "--lattice.stencil=nine-tuple '--boundary.left=0.1*sin(t)'");
  CHECK(rows.code == 0);
  CHECK_FALSE(contains(rows.report, "at walls"));

  const std::string mesh =
      "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = rectangle:2,1,8,4\ncourant = 0.3\n"
      "[initial]\nphi = sin(pi*x/4)*sin(pi*y/2)\nphi_t = 0\n[run]\nuntil = 1\n";
  CHECK(contains(Reported(mesh).report, "at walls   translation = "));
  CHECK(contains(Reported(mesh, "--boundary.mesh=natural").report, "conserved  translation = "));
}

TEST_CASE("driven ends and a density that reads t work together, and the energy less both works is kept") {
  const Reported both("[theory]\ndensity = exp(0.3*t)*(0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2)\n" +
                      lattice("interval", "3", 97) +
                      "[initial]\nphi = sin(pi*x/3)\n[boundary]\nleft = 0.4*sin(2*t)\n[run]\nuntil = 4\n");
  REQUIRE(both.code == 0);
  const auto& kept = both.summary["conserved"].back();
  CHECK(kept["name"] == "energy_less_work");
  CHECK(kept["at_walls"] == false);
  CHECK(kept["error_max"] < 0.01);
  CHECK(std::abs(both.summary["energy_work"].get<double>()) > 0.1);
}

TEST_CASE("a solution that a driven end does not follow is named, and no finer steps are advised") {
  const Reported off("[theory]\nname = wave\n" + lattice("interval", "1", 65) +
                     "[exact]\nphi = 0.01*sin(t - x)\n[boundary]\nleft = sin(t)\nright = 0.01*sin(t - 1)\n"
                     "[run]\nuntil = 1\n");
  CHECK(off.warns("does not move with the left end, which is driven"));
  CHECK_FALSE(off.warns("raise lattice.sites"));
}

TEST_CASE("a front that a driven end sends into a field at rest is not said to be off in phase") {
  const std::string chain =
      "[theory]\nname = sine-gordon\n[lattice]\nspace = interval\nlength = 40\nsites = 161\n"
      "courant = 0.5\n[boundary]\nleft = sin(0.9*t)\n[initial]\nphi = ";
  const Reported at_rest(chain + "0\n[run]\nuntil = 200\n");
  REQUIRE(at_rest.code == 0);
  CHECK_FALSE(at_rest.warns("phase is off"));
  // waves that the step does not resolve are off beside a driven end too, and said to be where they end with the run
  const std::string stiff = "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 - 50*phi^2\n" +
                            lattice("interval", "3", 25) +
                            "[boundary]\nleft = 0.1*sin(t)\n[initial]\nphi = sin(pi*x/3)\n[run]\nuntil = ";
  CHECK(Reported(stiff + "40\n").warns("phase is off"));
  CHECK(Reported(stiff + "8\n").warns("phase is off"));
}

TEST_CASE("a wall that the solution moves, and a constraint without a start, are answered by a remedy that works") {
  const std::string wave = "[theory]\nname = wave\n" + lattice("interval", "1", 65) +
                           "[exact]\nphi = sin(2*pi*(t - x))\n[run]\nuntil = 0.25\n";
  CHECK(Reported(wave).warns("give boundary.left and boundary.right as formulas of t"));
  const Reported driven(wave, "'--boundary.left=sin(2*pi*t)' '--boundary.right=sin(2*pi*(t - 1))'");
  CHECK(driven.summary["warnings"].empty());
  CHECK(driven.summary["error_linf"] < 0.01);

  const std::string pendulum =
      "[theory]\nfields = x, y\ndensity = 0.5*x_t^2 + 0.5*y_t^2 - y\nconstraint = x^2 + y^2 - 1\n[lattice]\nspace = point\n"
      "time_step = 0.01\n[initial]\nx = 1\ny = 0\n[run]\nuntil = 1\n";
  const Reported refused(pendulum, "--lattice.stencil=midpoint");
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "scheme.method = cgvi with scheme.tableau = stormer-verlet"));
  CHECK(Reported(pendulum, "--scheme.method=cgvi --scheme.tableau=stormer-verlet").code == 0);
}

TEST_CASE("the report names the observer and the row of the energy, and a better energy of the scheme's own") {
  const Reported wave("[theory]\nname = wave\n" + lattice("interval", "1", 65) +
                      "[initial]\nphi = 0\nphi_t = sin(pi*x)\n[run]\nuntil = 1\n");
  CHECK(contains(wave.report, " of row 128, by jets of the symmetric rectangle; relative error"));
  CHECK(contains(wave.report, ", and of the scheme's own, energy_own, "));
  CHECK_FALSE(contains(Reported(small_scene()).report, "energy_own, "));  // it has none
}

TEST_CASE("more sites are advised only where they help") {
  const Folder folder;
  const Ran seam = delf_program(folder, "run kink --lattice.length=3 --run.until=2 --output.figures=off --out out");
  CHECK(contains(seam.out, "more sites do not help"));
  CHECK_FALSE(contains(seam.out, "raise lattice.sites"));
  const Ran coarse =
      delf_program(folder, "run kink --initial.speed=0.95 --lattice.sites=41 --output.figures=off --out out");
  CHECK(contains(coarse.out, "raise lattice.sites"));
  // a wall that holds what the solution moves is the cause, and is named alone
  const Reported wall("[theory]\nname = wave\n" + lattice("interval", "1", 65) +
                      "[exact]\nphi = sin(2*pi*(t - x)) + sin(2*pi*(t + x))*0.5\n[run]\nuntil = 0.25\n");
  CHECK(wall.warns("moves at the left wall"));
  CHECK_FALSE(wall.warns("the energy of"));
}

TEST_CASE("a formula without a value is named with its place") {
  const Reported found("[theory]\ndensity = x^2*(0.5*phi_t^2 - 0.5*phi_x^2)\n" + lattice("interval", "3*pi", 151) +
                       "[boundary]\nleft = natural\n[exact]\nphi = sin(x)/x*cos(t)\n[run]\nuntil = 6\n");
  CHECK(found.code == 2);
  CHECK(contains(found.err, "exact.phi = sin(x)/x*cos(t): has no finite value at t = 0, x = 0 (site 0)"));
}

TEST_CASE("a density without inertia in a direction is named when its first step cannot be solved") {
  const std::string rigid =
      "[theory]\nfields = e0, e1\nparameters = c = 0\ndensity = let w = e0*e1_t - e1*e0_t; let r = e0*e0_t + e1*e1_t; "
      "0.5*w^2 + c*r^2\nconstraint = e0^2 + e1^2 - 1\n[lattice]\nspace = point\ntime_step = 0.05\n[scheme]\nmethod = "
      "cgvi\ntableau = lobatto3\n[initial]\ne0 = 1\ne1 = 0\ne0_t = 0\ne1_t = 0.5\n[run]\nuntil = 1\n";
  const Reported found(rigid);
  CHECK(found.code == 3);
  CHECK(contains(found.err, "the density has no inertia along (e0, e1) = (1, 0)"));
  CHECK_FALSE(contains(Reported(rigid, "--theory.c=1").err, "inertia"));
}

TEST_CASE("a run without a step, times beyond its end and an empty section are said") {
  const Reported none(small_scene(), "--run.until=1e-4");
  CHECK(none.code == 2);
  CHECK(contains(none.err, "--run.until = 1e-4: is less than half a step"));
  CHECK(Reported(small_scene(), "--run.steps=0").code == 0);
  const Folder folder;
  const Ran times = delf_program(folder, "run kink --output.times=0,1000 --output.figures=on --run.until=1 --out out");
  CHECK(contains(times.err, "--output.times = 0,1000: warning: the run ends at t = "));
  const std::string section = "run pendulum --output.figures=off --out out --output.section=";
  CHECK(
      contains(delf_program(folder, section + "'q = 5, p > 10'").out, "no row crosses output.section = q = 5, p > 10"));
  CHECK_FALSE(contains(delf_program(folder, section + "'q = 0'").out, "no row crosses"));
  check_refused(delf_program(folder, section + "'q1 = 0'"), {"write one like q = 0, p > 0"});
}

TEST_CASE("rows of a file have no finer ones, which convergence says with a remedy") {
  const Folder folder;
  check_refused(delf_program(folder, "convergence r-adaptive --out out"),
                {"initial.file", "finer ones are asked for", "delf list states"});
}

TEST_CASE("kinks of a density in text are counted halfway between its vacua") {
  // from 0 to 1: its tail passes 0 by rounding
  const Reported found(
      "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2*(1 - phi^2)^2\nparameters = v = 0.49, x0 = 20\n" +
      lattice("interval", "40", 401) +
      "[exact]\nphi = let s = (x - x0 - v*t)/sqrt(1 - v^2); (1 + exp(-2*s))^-0.5\n[run]\nuntil = 20\n[measure]\nplace = "
      "position(1)\nnumber = kinks\nat_zero = position(1, 0.25)\n");
  // phi = 1/2 at exp(-2 s) = 3
  const double place = 20 + 0.49 * 20 - 0.5 * std::log(3.0) * std::sqrt(1 - 0.49 * 0.49);
  CHECK(found.summary["measures"]["place"].get<double>() == Approx(place).margin(0.01));
  CHECK(found.summary["measures"]["number"] == 1);
  CHECK(found.summary["measures"]["at_zero"].get<double>() < place - 0.3);
}
