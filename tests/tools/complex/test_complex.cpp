// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

nlohmann::json summary(const Folder& folder) { return nlohmann::json::parse(read(folder / "out/summary.json")); }

const std::string square = "point 0 0\npoint 1 0\npoint 1 1\npoint 0 1\n";

}  // namespace

TEST_CASE("a wave on a mesh runs, is planned and verified through the program") {
  const Folder folder;
  const std::string scene = "sphere --lattice.mesh=icosahedron:2 --run.steps=40 --initial.phi=z";
  const Ran ran = delf_program(folder, "run " + scene + " --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const auto json = summary(folder);
  CHECK(json["status"] == "done");
  CHECK(json["sites"] == 162);
  CHECK(json["solve_kind"] == "explicit");
  CHECK(json["energy_error_max"] < 0.05);
  CHECK(json["residual_max"] < 1e-13);
  // figures of triangles in space, where there is gnuplot
  CHECK((contains(ran.err, "no figures") || std::filesystem::exists(folder / "out/figures/field.svg")));
  CHECK(contains(read(folder / "out/fields.xdmf"), "TopologyType=\"Triangle\" NumberOfElements=\"320\""));
  // again to the same bits, from the scene that is left
  CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
  CHECK(contains(delf_program(folder, "plan " + scene).out, "a sparse product and a division a row"));
  CHECK(delf_program(folder, "verify " + scene + " --out v").code == 0);
  for (const char* fault : {"field", "variation", "sign"})
    CHECK(delf_program(folder, "verify " + scene + " --out v --verify.fault=" + fault).code == 1);
}

TEST_CASE("rows of a mesh at short steps are right to rounding, and an edited value is still found") {
  const Folder folder;
  for (const char* h : {"0.003", "1e-4"}) {
    const std::string scene =
        std::string("sphere --lattice.mesh=icosahedron:2 --run.steps=20 --output.figures=off --lattice.time_step=") + h;
    CAPTURE(h);
    CHECK(delf_program(folder, "verify " + scene + " --out v").code == 0);
    CHECK(delf_program(folder, "verify " + scene + " --out v --verify.fault=field").code == 1);
  }
}

TEST_CASE("steps that the field chooses run, end by time, and run again and back to the same") {
  const Folder folder;
  const std::string scene = "sphere --lattice.mesh=icosahedron:1 --lattice.time_steps=reversible ";
  REQUIRE(delf_program(folder, "run " + scene + "--run.until=4 --output.figures=off --out out").code == 0);
  const auto json = summary(folder);
  CHECK(json["time"].get<double>() >= 4);
  CHECK(json["time"].get<double>() < 4 + json["time_step_max"].get<double>());
  CHECK(json["time_step_max"] > 1.3 * json["time_step_min"].get<double>());
  REQUIRE(delf_program(folder, "run out/scene.ini --output.figures=off --out again").code == 0);
  CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
  REQUIRE(delf_program(folder, "run " + scene + "--run.until=2 --output.figures=off --out short").code == 0);
  REQUIRE(delf_program(folder, "resume short --run.until=2.2").code == 0);  // fewer steps than a guess says are there
  REQUIRE(delf_program(folder, "resume short --run.until=4").code == 0);
  CHECK(nlohmann::json::parse(read(folder / "short/summary.json"))["time"] == json["time"]);
  const Ran verified = delf_program(folder, "verify " + scene + "--run.until=4 --out v");
  CAPTURE(verified.out, verified.err);
  CHECK(verified.code == 0);
  for (const char* part : {"time reversal", "form of the first step", "change of the energy", "not symplectic"})
    CHECK(contains(verified.out, part));
}

TEST_CASE("angles on a mesh: the same rows from any representatives, and what winds or jumps is refused") {
  const Folder folder;
  const std::string scene =
      "run sphere --lattice.mesh=icosahedron:2 --theory.fibre=S1 --run.steps=30 --output.figures=off --out ";
  // tan has the period of 4z/2 modulo pi: the same angles, between -pi and pi
  REQUIRE(delf_program(folder, scene + "one --initial.phi='4*z'").code == 0);
  const Ran other = delf_program(folder, scene + "two --initial.phi='2*atan(tan(2*z))'");
  CAPTURE(other.err);
  REQUIRE(other.code == 0);
  const auto energy = [&](const char* file) { return nlohmann::json::parse(read(folder / file))["energy_final"]; };
  CHECK(energy("two/summary.json").get<double>() == Approx(energy("one/summary.json").get<double>()).epsilon(1e-12));
  CHECK(delf_program(folder, scene + "three --initial.phi='40*z'").code == 3);                   // jumps at once
  CHECK(delf_program(folder, scene + "four --initial.phi=z --initial.phi_t='90*x'").code == 3);  // in a step
  CHECK(delf_program(folder, scene + "five --initial.phi=z --lattice.time=cells").code == 2);
  folder.write("ring.mesh",
               "point 1 1\npoint -1 1\npoint -1 -1\npoint 1 -1\npoint 2 2\npoint -2 2\npoint -2 -2\npoint 2 -2\n"
               "cell 0 4 5 1\ncell 1 5 6 2\ncell 2 6 7 3\ncell 3 7 4 0\n");
  CHECK(contains(delf_program(folder,
                              "run sphere --lattice.mesh=ring.mesh --boundary.mesh=natural --theory.fibre=S1 "
                              "--initial.phi='2*atan(y/(x + sqrt(x^2 + y^2)))' --out six")
                     .err,
                 "winds around a hole of the mesh"));
}

TEST_CASE("a run on a mesh that ends at half of its steps and goes on is the whole run, to the bit") {
  const Folder folder;
  const auto scene =
      GENERATE(as<std::string>(), "sphere --lattice.mesh=icosahedron:1",
               "sphere --lattice.mesh=icosahedron:1 --lattice.time_steps=0.02,0.05,0.03", "asynchronous");
  const std::string keys = " --output.every=3 --output.figures=off --run.steps=";
  REQUIRE(delf_program(folder, "run " + scene + keys + "41 --out whole").code == 0);
  REQUIRE(delf_program(folder, "run " + scene + keys + "20 --out out").code == 0);
  const Ran finished = delf_program(folder, "resume out");
  CHECK(finished.code == 2);
  CHECK(contains(finished.err, "the run is finished, at row 20"));
  CHECK(read(folder / "out/series.csv") != read(folder / "whole/series.csv"));
  const Ran resumed = delf_program(folder, "resume out --run.steps=41");
  CAPTURE(resumed.err);
  REQUIRE(resumed.code == 0);
  CHECK(read(folder / "out/series.csv") == read(folder / "whole/series.csv"));
  CHECK(read(folder / "out/fields.h5") == read(folder / "whole/fields.h5"));
}

TEST_CASE("a mesh that has changed is not gone on with, and what is solved at once has no checkpoint") {
  const Folder folder;
  folder.write("square.txt", square + "cell 0 1 2\ncell 0 2 3\n");
  REQUIRE(
      delf_program(folder, "run sphere --lattice.mesh=square.txt --boundary.mesh=natural --run.steps=4 --output.figures=off --out out").code ==
      0);
  folder.write("square.txt", "point 0 0\npoint 1 0\npoint 1 1.1\npoint 0 1\ncell 0 1 2\ncell 0 2 3\n");
  const Ran moved = delf_program(folder, "resume out --run.steps=9");
  CHECK(moved.code == 2);
  CHECK(contains(moved.err, "is another mesh than the run began with"));
  REQUIRE(delf_program(folder, "run static-kink --output.figures=off --out still").code == 0);
  const Ran still = delf_program(folder, "resume still");
  CHECK(still.code == 2);
  CHECK(contains(still.err, "there is no checkpoint to resume from"));
}

TEST_CASE("a sweep of scenes on a mesh is tabulated, and bad values are refused before it begins") {
  const Folder folder;
  const std::string scene =
      "sphere --lattice.mesh=icosahedron:1 --run.until=2 --sweep.number=energy_error_max --out out";
  const Ran ran = delf_program(folder, "sweep " + scene + " --lattice.courant=0.1,0.2");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const auto json = nlohmann::json::parse(read(folder / "out/sweep.json"));
  CHECK(json["number"] == "energy_error_max");
  std::vector<double> errors;
  for (const char* courant : {"0.1", "0.2"})
    errors.push_back(nlohmann::json::parse(
        read(folder / ("out/runs/lattice.courant=" + std::string(courant)) / "summary.json"))["energy_error_max"]);
  CHECK(errors[0] < errors[1]);
  CHECK(lines(read(folder / "out/sweep.csv")).size() == 3);
  CHECK(delf_program(folder, "sweep " + scene + " --lattice.courant=0.1,-1").code == 2);
}

TEST_CASE("a static kink has the energies of Peierls and Nabarro, between sites and on one") {
  const Folder folder;
  REQUIRE(delf_program(folder, "run static-kink --output.figures=off --out out").code == 0);
  CHECK(summary(folder)["energy_final"].get<double>() == Approx(7.866565).margin(1e-6));
  REQUIRE(
      delf_program(folder, "run static-kink --initial.phi='4*atan(exp(x-20))' --lattice.mesh=graded:40,41,1 --out out")
          .code == 0);
  CHECK(summary(folder)["energy_final"].get<double>() == Approx(7.891929).margin(1e-6));
  CHECK(summary(folder)["warnings"].empty());
}

TEST_CASE("Newton's method says where a kink on a fine lattice may stand anywhere, and fails without a solution") {
  const Folder folder;
  const Ran fine =
      delf_program(folder, "run static-kink --lattice.mesh=graded:39,155,1 --output.figures=off --out out");
  CAPTURE(fine.err);
  REQUIRE(fine.code == 0);
  CHECK(summary(folder)["residual_max"].get<double>() < 1e-12);
  CHECK(summary(folder)["iterations_max"].get<int>() < 40);
  CHECK(summary(folder)["energy_final"].get<double>() == Approx(7.992844).margin(1e-6));
  CHECK(contains(summary(folder)["warnings"].dump(), "hardly change in one direction"));
  // Bratu's phi_xx = -exp(phi), 0 at both ends, has solutions up to a length of sqrt(3.5138) = 1.8745
  folder.write("bratu.ini",
               "[theory]\nname = text\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 + exp(phi)\n[lattice]\nspace = complex\n"
               "mesh = graded:1,41,1\ntime = none\n[boundary]\nmesh = fixed\n[initial]\nphi = 0\n"
               "[output]\nfigures = off\n");
  REQUIRE(delf_program(folder, "run bratu.ini --lattice.mesh=graded:1.8,41,1 --out out").code == 0);
  CHECK(summary(folder)["warnings"].empty());
  const Ran none = delf_program(folder, "run bratu.ini --lattice.mesh=graded:2,41,1 --out out");
  CHECK(none.code == 3);
  CHECK_FALSE(contains(none.err, "0.000000"));
}

TEST_CASE("elliptic problems on a mesh converge with order 2, sine-Gordon and harmonic maps to the sphere") {
  const Folder folder;
  const std::string head = "[lattice]\nspace = complex\ntime = none\nmesh = rectangle:2,1,16,8\n";
  // φ = 4 atan(exp((3x + 4y)/5 − 1)) solves Laplace φ = sin φ; it is data on the boundary, and Newton's method begins at 0.
  // z ↦ z² is conformal, so a harmonic map into the sphere in stereographic coordinates
  const std::string kink = folder.write(
      "kink.ini", "[theory]\nname = sine-gordon\n" + head + "[exact]\nphi = 4*atan(exp(0.6*x + 0.8*y - 1))\n");
  const std::string map = folder.write(
      "map.ini", "[theory]\nfields = u, v\ndensity = 0.5*u_t^2 + 0.5*v_t^2 - 2*(u_x^2 + v_x^2)/(1 + u^2 + v^2)^2\n" +
                     head + "[exact]\nu = x^2 - y^2\nv = 2*x*y\n");
  // the image of the small rectangle lies within a hemisphere, where such maps are unique
  for (const auto& [scene, coarse, fine] : {std::tuple(kink, "rectangle:2,1,16,8", "rectangle:2,1,32,16"),
                                            std::tuple(map, "rectangle:0.8,0.4,16,8", "rectangle:0.8,0.4,32,16")}) {
    const auto error = [&, file = scene](const char* mesh) {
      const Ran ran = delf_program(folder, "run " + file + " --output.figures=off --out out --lattice.mesh=" + mesh);
      CAPTURE(file, ran.err);
      REQUIRE(ran.code == 0);
      CHECK(summary(folder)["iterations_max"] < 12);
      return summary(folder)["error_l2"].get<double>();
    };
    CHECK(std::log2(error(coarse) / error(fine)) == Approx(2).margin(0.2));
    CHECK(delf_program(folder, "verify " + scene + " --out v --lattice.mesh=" + coarse).code == 0);
  }
}

TEST_CASE("rows of a mesh are verified from a file, and a moved point or an edited value is named") {
  const Folder folder;
  const std::string bare = "--lattice.courant=0.5 --run.steps=12 --output.every=1 --lattice.time=rows";
  REQUIRE(delf_program(folder,
                       "run asynchronous --output.figures=off " + bare + " --lattice.mesh=graded:24,41,1.05 --out out")
              .code == 0);
  const auto verify = [&](const std::string& arguments) {
    return delf_program(folder, "verify asynchronous " + bare + " --fields out/fields.h5 --out v " + arguments);
  };
  const Ran right = verify("--lattice.mesh=graded:24,41,1.05");
  CAPTURE(right.out, right.err);
  CHECK(right.code == 0);
  CHECK(contains(right.out, "rows of out/fields.h5"));
  const Ran edited = verify("--lattice.mesh=graded:24,41,1.05 --verify.fault=field");
  CHECK(edited.code == 1);
  CHECK(contains(edited.out, "the values around site"));
  const Ran moved = verify("--lattice.mesh=graded:24,41,1.06"), other = verify("--lattice.mesh=graded:24,31,1.05");
  CHECK(moved.code == 2);
  CHECK(contains(moved.err, "point 1 lies at x = "));
  CHECK(other.code == 2);
  CHECK(contains(other.err, "has 41 sites"));
  CHECK(delf_program(folder, "verify asynchronous --fields v/verify.json").code == 2);
}

TEST_CASE("waves on spheres and graded intervals converge with order 2, and a missed order fails") {
  const Folder folder;
  // z = cos θ is the first harmonic: z cos(√2 t) solves the wave equation on the sphere
  const std::string sphere =
      "sphere --theory.name=wave --lattice.mesh=icosahedron:2 --exact.phi='z*cos(sqrt(2)*t)' "
      "--run.until=1 --convergence.levels=3 --out out ";
  const Ran right = delf_program(folder, "convergence " + sphere + "--convergence.order=2");
  CAPTURE(right.out, right.err);
  CHECK(right.code == 0);
  const auto json = nlohmann::json::parse(read(folder / "out/convergence.json"));
  CHECK(json["levels"].size() == 3);
  CHECK(json["levels"][2]["sites"] == 2562);
  CHECK(delf_program(folder, "convergence " + sphere + "--convergence.order=3").code == 1);
  // a graded mesh, and a sphere without a solution: differences at the points of the coarser mesh
  for (const char* scene : {"asynchronous --lattice.time=rows --lattice.mesh=graded:24,41,1.02 --run.until=2",
                            "sphere --lattice.mesh=icosahedron:2 --initial.phi=z --run.until=1"}) {
    const Ran ran = delf_program(
        folder, std::string("convergence ") + scene + " --convergence.levels=3 --convergence.order=2 --out out");
    CAPTURE(ran.out, ran.err);
    CHECK(ran.code == 0);
  }
}

TEST_CASE("nonsense on a mesh is no success") {
  const Folder folder;
  const Ran huge = delf_program(folder, "run sphere --initial.phi='1e308*x' --lattice.mesh=icosahedron:1 --out out");
  CHECK(huge.code == 3);
  CHECK(summary(folder)["status"] == "not-finite");
  REQUIRE(
      delf_program(folder, "run asynchronous --output.figures=off --lattice.courant=2 --run.until=3 --out out").code ==
      0);
  CHECK(contains(summary(folder)["warnings"].dump(), "the energy of the last row is"));
  CHECK(summary(folder)["residual_max"].is_null());
  REQUIRE(delf_program(folder, "run asynchronous --run.until=3 --output.format=svg --out out").code == 0);
  CHECK(summary(folder)["warnings"].empty());
  const bool drawn = std::filesystem::exists(folder / "out/figures/field.svg");
  CHECK(std::filesystem::exists(folder / "out/figures/updates.svg") == drawn);
  CHECK_FALSE(std::filesystem::exists(folder / "out/figures/field.png"));
}

TEST_CASE("a scene on a mesh with an error is refused in one line") {
  const Folder folder;
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    const Ran ran = delf_program(folder, arguments);
    CAPTURE(arguments, ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, part));
  };
  folder.write("bad.mesh", square + "cell 0 1 2\ncell 0 3 2\n");
  refused("run sphere --lattice.mesh=bad.mesh", "bad.mesh:6: cell 1 is listed clockwise");
  refused("run sphere --lattice.mesh=icosahedron:99", "99 must be a whole number from 0 to 9");
  refused("run sphere --lattice.sites=10", "not applicable to lattice.space = complex");
  refused("run sphere '--theory.density=0.5*phi_t^2 - phi_x^4'", "is not quadratic in phi_x");
  refused("workprecision sphere", "works with run, resume, plan, verify, sweep, convergence and stability");
  refused("convergence sphere --lattice.time_steps=0.1,0.2", "are not refined");
  refused("run sphere --lattice.time_steps=0.1,-1", "steps must be above 0");
  refused("run sphere --lattice.step_control=2", "has no effect without lattice.time_steps = reversible");
  refused("convergence sphere --lattice.time_steps=reversible", "reversible steps end at times of their own");
  refused("run sphere --lattice.time_steps=reversible '--theory.density=0.5*phi_t^2 + phi_t^4 - phi_x^2'",
          "need a density quadratic in phi_t");
  refused("run sphere --initial.speed=0.3", "has no effect on a mesh");
  refused("run sphere --exact.u=x", "--exact.u: unknown key; the fields of the theory have exact.phi");
  const std::string rest = "phi3 = 0\nphi1 = 1\n[run]\nsteps = 2\n";
  folder.write("map.ini",
               "[theory]\nname = wave-map\n[lattice]\nspace = complex\nmesh = icosahedron:1\ncourant = 0.3\n"
               "[initial]\nphi2 = 0\n" +
                   rest);
  folder.write("short.ini",
               "[theory]\nname = wave-map\n[lattice]\nspace = complex\nmesh = icosahedron:1\n"
               "courant = 0.3\n[initial]\n" +
                   rest);
  refused("run map.ini --exact.u=1", "unknown key; the fields of the theory have exact.phi1, exact.phi2, exact.phi3");
  refused("run map.ini --exact.phi1=1", "must be given for all of the fields phi1, phi2, phi3 or for none of them");
  refused("run short.ini",
          "initial.phi2: must be given on a mesh, as a formula of x, y and z; or exact.phi2 as one of t too (the "
          "fields are "
          "phi1, phi2, phi3)");
  refused("run sphere --initial.phi=x*t", "reads t");
  refused("run static-kink --run.until=3", "has no effect with lattice.time = none");
  refused("plan sphere --latex", "is for lattices");
}

TEST_CASE("a bisection on a mesh finds the step at which the energy is off by so much") {
  const Folder folder;
  const Ran ran =
      delf_program(folder,
                   "sweep sphere --lattice.mesh=icosahedron:1 --run.until=3 --output.figures=off "
                   "--output.fields=off --sweep.keep=table --sweep.number=energy_error_max "
                   "--sweep.level=0.05 --sweep.bisect=lattice.courant=0.1:0.5 --sweep.accuracy=0.02 --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  const auto found = nlohmann::json::parse(read(folder / "out/sweep.json"))["threshold"];
  CHECK(found["key"] == "lattice.courant");
  CHECK(found["high"].get<double>() - found["low"].get<double>() <= 0.02);
  CHECK(found["at_low"].get<double>() <= 0.05);
  CHECK(found["at_high"].get<double>() > 0.05);
  CHECK(delf_program(folder,
                     "sweep sphere --lattice.mesh=icosahedron:1 --run.until=3 --sweep.number=energy_error_max "
                     "--sweep.level=9 --sweep.bisect=lattice.courant=0.1:0.5 --out other")
            .code == 2);
}

TEST_CASE("what leaves values of a mesh or a complex free, or makes them grow, is no silent result") {
  const Folder folder;
  // a natural boundary leaves a constant
  const Ran singular = delf_program(
      folder,
      "run static-kink --theory.name=wave --boundary.mesh=natural --initial.phi=x --out out --output.figures=off");
  CHECK(singular.code == 3);
  CHECK(contains(singular.err, "leave some of its values free"));
  const Ran grown =
      delf_program(folder, "run refined-kink --lattice.mesh=refined:18,4,300,9 --out out --output.figures=off");
  CHECK(grown.code == 0);
  CHECK(contains(grown.out, "the field grows to"));
  CHECK_FALSE(contains(delf_program(folder, "run refined-kink --out out --output.figures=off").out, "grows to"));
  // a start that nothing reads
  CHECK(contains(delf_program(folder, "run asynchronous --initial.phi=0 --run.steps=1 --out out").err,
                 "no effect, as exact.phi gives the start too"));
  const Ran missing = delf_program(folder, "verify sphere --fields nowhere.h5");
  CHECK(missing.code == 2);
  CHECK(contains(missing.err, "--fields nowhere.h5: no such file"));
  folder.write("text.h5", "no rows");
  const Ran text = delf_program(folder, "verify sphere --fields text.h5");
  CHECK(text.code == 2);
  CHECK(contains(text.err, "--fields: text.h5: is not an HDF5 file"));
}

TEST_CASE("densities that read t and x run on meshes and are verified") {
  const Folder folder;
  folder.write("impurity.ini",
               "[theory]\nname = sine-gordon-impurity\n[lattice]\nspace = complex\n"
               "mesh = icosahedron:0\ntime_step = 0.1\n[initial]\nphi = x*z\n[run]\nsteps = 6\n");
  for (const std::string density : {"",
                                    " --theory.name=text '--theory.density=0.5*(2 + sin(x + t))*phi_t^2 - 0.5*(1 + "
                                    "0.2*cos(x - t))*phi_x^2 - phi^4'"}) {
    const Ran run = delf_program(folder, "run impurity.ini --output.figures=off --out out" + density),
              verified = delf_program(folder, "verify impurity.ini --output.figures=off" + density);
    INFO(density << "\n" << run.err << verified.out << verified.err);
    CHECK(run.code == 0);
    CHECK(verified.code == 0);
  }
  check_refused(
      delf_program(folder,
                   "run impurity.ini --theory.name=text '--theory.density=0.5*phi_t^2 - 0.5*phi_x^2 - x*phi*phi_x'"),
      {"theory.name", "quadratic in phi_x"});
}

TEST_CASE("an elliptic problem whose solution is 0 is solved, from whatever start") {
  const Folder folder;
  folder.write("s.ini",
               "[theory]\nname = klein-gordon\n[lattice]\nspace = complex\nmesh = graded:10,11,1\ntime = none\n"
               "[initial]\nphi = sin(pi*x/10)\n[output]\nfigures = off\n");
  // the last one has data of 1.2e-16 at one end, and of 0 at the other
  for (const std::string keys : {"--initial.phi='x*(10-x)'", "--initial.phi='1e6*x*(10-x)*(x-3)'", ""}) {
    const Ran ran = delf_program(folder, "run s.ini --out out " + keys);
    CAPTURE(keys, ran.err);
    CHECK(ran.code == 0);
    const auto summary = nlohmann::json::parse(read(folder / "out/summary.json"));
    CHECK(summary["status"] == "done");
    CHECK(summary["residual_max"].get<double>() < 1e-14);
  }
}
