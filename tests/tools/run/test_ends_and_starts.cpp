// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
using delf::FieldsReader;

namespace {

nlohmann::json summary_of(const Folder& folder, const std::string& scene, const std::string& out = "out",
                          const std::string& more = "") {
  folder.write("s.ini", scene);
  const Ran ran = delf_program(folder, "run s.ini --output.figures=off --out " + out + " " + more);
  INFO(scene << "\n" << ran.out << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / (out + "/summary.json")));
}
std::vector<double> row(const Folder& folder, const std::string& out, int from_the_end = 0) {
  const FieldsReader fields(folder / (out + "/fields.h5"));
  return fields.row(fields.frames() - 1 - from_the_end);
}
std::string refusal(const Folder& folder, const std::string& scene, const std::string& more = "") {
  folder.write("s.ini", scene);
  const Ran ran = delf_program(folder, "run s.ini --output.figures=off --out out " + more);
  CHECK(ran.code == 2);
  return ran.err;
}

}  // namespace

TEST_CASE("Zabusky and Kruskal's solitons come from data: u reaches from -0.72 to 2.26 at t = 3.6/pi") {
  const Folder folder;
  const auto summary =
      summary_of(folder,
                 "[theory]\n"
                 "density = 0.5*phi_x*phi_t + phi_x^3/6 - 0.5*d^2*phi_xx^2\nparameters = d = 0.022\n"
                 "[lattice]\nstencil = six-tuple\nspace = circle\nlength = 2\nsites = 255\ncourant = 0.2\n"
                 "[initial]\nphi = sin(pi*x)/pi\n[run]\nuntil = 3.6/pi\n[output]\nevery = 0\n");
  CHECK(summary["start"] == "values");
  CHECK(summary["solve"].get<std::string>().find("the mean of a row") != std::string::npos);
  const std::vector<double> phi = row(folder, "out");
  const std::size_t N = phi.size();
  double least = 0, most = 0, mean = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const double u = (phi[(i + 1) % N] - phi[i]) * static_cast<double>(N) / 2;
    least = std::min(least, u), most = std::max(most, u), mean += phi[i] / static_cast<double>(N);
  }
  CHECK(std::abs(least + 0.7227) < 0.03);
  CHECK(std::abs(most - 2.2623) < 0.05);
  CHECK(std::abs(mean) < 1e-12);
}

TEST_CASE("several constraints, separated by semicolons, have a multiplier each: a chain between two nails") {
  const Folder folder;
  const std::string chain =
      "[theory]\nfields = x1, y1, x2, y2, x3, y3\n"
      "density = 0.5*(x1_t^2 + y1_t^2 + x2_t^2 + y2_t^2 + x3_t^2 + y3_t^2) - 9.81*(y1 + y2 + y3)\n"
      "constraint = x1^2 + y1^2 - 1; (x2 - x1)^2 + (y2 - y1)^2 - 1; (x3 - x2)^2 + (y3 - y2)^2 - 1; (x3 - 2)^2 + y3^2 - 1\n"
      "[lattice]\nspace = point\ntime_step = 0.01\n[scheme]\nmethod = cgvi\ntableau = lobatto3\n"
      "[initial]\nx1 = 0\ny1 = -1\nx2 = 1\ny2 = -1\nx3 = 2\ny3 = -1\nx1_t = 0.5\nx2_t = 0.5\nx3_t = 0.5\n"
      "[run]\nuntil = 5\n";
  const auto summary = summary_of(folder, chain);
  CHECK(summary["constraint_max"] < 1e-10);
  CHECK(summary["energy_error_max"] < 1e-5);
  CHECK(FieldsReader(folder / "out/fields.h5").shape(delf::Role::multiplier).components ==
        8);  // at two points of a step
  std::string off = chain;
  off.replace(off.find("y3 = -1"), 7, "y3 = -2");
  CHECK(refusal(folder, off).find("breaks the constraint 3") != std::string::npos);
}

TEST_CASE("on a point a field may be called x, and nowhere else") {
  const Folder folder;
  const std::string theory =
                        "[theory]\nfields = x, y, z\ndensity = 0.5*(x_t^2 + y_t^2 + z_t^2) - 0.5*(x^2 + y^2) - z\n",
                    rest = "time_step = 0.01\n[initial]\nx = 1\ny = 0\nz = 0\ny_t = 1\n[run]\nsteps = 100\n";
  summary_of(folder, theory + "[scheme]\nmethod = cgvi\n[lattice]\nspace = point\n" + rest);
  const std::vector<double> last = row(folder, "out");
  CHECK(std::abs(last[0] - std::cos(1)) < 1e-4);
  CHECK(std::abs(last[2] + 0.5) < 1e-10);
  CHECK(refusal(folder, theory + "[lattice]\nspace = circle\nlength = 1\nsites = 8\n" + rest)
            .find("\"x\" is the place") != std::string::npos);
}

TEST_CASE("momenta on the command line take the place of rates in a scene, under a constraint too") {
  const Folder folder;
  const std::string pendulum =
      "[theory]\nname = spherical-pendulum\n[lattice]\nspace = point\ntime_step = 0.01\n[scheme]\nmethod = cgvi\n"
      "tableau = lobatto3\n[initial]\nstate = point\nq = 1, 0, 0\nv = 0, 1, 0\n[run]\nsteps = 50\n";
  summary_of(folder, pendulum, "by_v", "--initial.v=0,0.5,0.25");
  summary_of(folder, pendulum, "by_p", "--initial.p=0,0.5,0.25");
  CHECK(row(folder, "by_v") == row(folder, "by_p"));
  CHECK(refusal(folder, pendulum, "--initial.q=1,1,0").find("breaks the constraint") != std::string::npos);
  const std::string text =
      "[theory]\nfields = u, v\ndensity = u_t^2 + 0.5*v_t^2 - u^2 - v^2\n[lattice]\nspace = point\ntime_step = 0.01\n"
      "[scheme]\nmethod = cgvi\n[initial]\nu = 1\nv = 0\nu_t = 0\nv_t = 1\n[run]\nsteps = 50\n";
  summary_of(folder, text, "rates", "--initial.u_t=0.25 --initial.v_t=0.5");
  summary_of(folder, text, "momenta", "--initial.p=0.5,0.5");
  CHECK(row(folder, "rates") == row(folder, "momenta"));
}

TEST_CASE("momenta beside a state that has its own are refused, with what reads them") {
  const Folder folder;
  for (const std::string scene : {"kepler --initial.p=0,1.9", "pendulum --initial.p=0.3"}) {
    const Ran ran = delf_program(folder, "run " + scene + " --out out");
    CHECK(ran.code == 2);
    CHECK(ran.err.find("set initial.state = point and give initial.q too") != std::string::npos);
    CHECK(ran.err.find("initial.phi") == std::string::npos);
  }
  const Ran kink = delf_program(folder, "run kink --initial.p=0.4 --out out");
  CHECK(kink.code == 2);
  CHECK(kink.err.find("initial.state = kink does not read it; leave it out") != std::string::npos);
  CHECK(delf_program(folder, "run kepler --initial.state=point --initial.q=1,0 --initial.p=0,1.1 --run.until=1 "
                             "--output.figures=off --out out")
            .code == 0);
}

TEST_CASE("a negative time step runs backward from the last rows of a file") {
  const Folder folder;
  const std::string kink =
      "[theory]\nname = sine-gordon\n[lattice]\nstencil = rectangle\nspace = interval\nlength = 60\nsites = 301\n";
  summary_of(folder,
             kink +
                 "time_step = 0.1\n[initial]\nstate = kink\nspeed = 0.5\nposition = 24\n[run]\nsteps = 60\n"
                 "[output]\nevery = 1\n",
             "forth");
  summary_of(folder,
             kink +
                 "time_step = -0.1\n[initial]\nstate = file\nfile = forth/fields.h5\n[run]\nuntil = -6\n"
                 "[output]\nevery = 1\n",
             "back");
  const FieldsReader forth(folder / "forth/fields.h5"), back(folder / "back/fields.h5");
  REQUIRE(back.frames() == 61);
  const auto first = forth.row(0), returned = back.row(60);
  double gap = 0;
  for (std::size_t i = 0; i < first.size(); ++i) gap = std::max(gap, std::abs(first[i] - returned[i]));
  CHECK(gap < 1e-10);
  CHECK(std::abs(*back.time(60) + 6) < 1e-12);
  CHECK(
      refusal(folder, kink + "time_step = -0.1\n[initial]\nstate = kink\n[run]\nuntil = 6\n").find("run.until = -6") !=
      std::string::npos);
}

TEST_CASE("an end moves by a formula: series and summary have the energy less its work") {
  const Folder folder;
  const std::string scene =
      "[theory]\nname = sine-gordon\n[lattice]\nstencil = rectangle-symmetric\nspace = interval\nlength = 20\nsites = 201\n"
      "courant = 0.5\n[initial]\nphi = 0\n[run]\nuntil = 20\n";
  for (const std::string end : {"left = 1.2*sin(0.9*t)", "left.flux = 0.8*sin(0.9*t)"}) {
    INFO(end);
    const auto summary = summary_of(folder, scene + "[boundary]\n" + end + "\n");
    CHECK(summary["energy_final"] > 0.05);
    CHECK(summary["energy_error_max"] < 0.01);
    CHECK(read(folder / "out/series.csv").find("energy_less_work") != std::string::npos);
    CHECK(delf_program(folder, "verify s.ini --output.figures=off --out v").code == 0);
    CHECK(delf_program(folder, "plan s.ini").code == 0);
  }
  CHECK(refusal(folder, scene + "[boundary]\nleft = fixd\n").find("fixed") != std::string::npos);
  CHECK(refusal(folder, scene + "[boundary]\nleft = 2*sin(t\n").find("boundary.left") != std::string::npos);
  CHECK(refusal(folder, scene + "[boundary]\nleft = fixed\nleft.flux = t\n").find("natural") != std::string::npos);
}
