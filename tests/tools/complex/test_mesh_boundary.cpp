// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

nlohmann::json summary(const Folder& folder) { return nlohmann::json::parse(read(folder / "out/summary.json")); }

std::vector<double> last_row(const Folder& folder, const std::string& results) {
  const FieldsReader fields(folder / (results + "/fields.h5"));
  return fields.row(fields.frames() - 1);
}

/// φ_tt − φ_xx + φ³ = sin(t − x)³ has φ = sin(t − x), which comes in at the left and goes out at the right.
const std::string nonlinear =
    "[theory]\nname = text\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 - 0.25*phi^4 + sin(t - x)^3*phi\n"
    "[lattice]\nspace = complex\nmesh = graded:3,31,1.01\ncourant = 0.4\n"
    "[boundary]\nmesh = natural\nleft = sin(t)\nright.flux = -cos(t - x)\n"
    "[exact]\nphi = sin(t - x)\n[run]\nuntil = 2\n[output]\nfigures = off\n";
/// A chain of pendula at rest that is moved at its end.
const std::string at_rest =
    "[theory]\nname = sine-gordon\n[lattice]\nspace = complex\nmesh = quadrilaterals:10,1,50,5\ncourant = 0.3\n"
    "[boundary]\nmesh = natural\n[initial]\nphi = 0\n[run]\nuntil = 12\n[output]\nfigures = off\n";
const std::string static_wave =
    "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = quadrilaterals:2,1,16,8\ntime = none\n"
    "[boundary]\nleft = x^2 - y^2\nbottom = x^2 - y^2\nright.flux = 2*x\ntop.flux = -2*y\n[initial]\nphi = 0\n"
    "[output]\nfigures = off\n";

}  // namespace

TEST_CASE("a field that is driven on one side, and let out on another, has order 2 by every method") {
  const Folder folder;
  folder.write("s.ini", nonlinear);
  for (const char* method : {"", " --scheme.method=composition", " --scheme.method=cgvi --scheme.tableau=gauss2",
                             " --scheme.method=cgvi --scheme.tableau=stormer-verlet",
                             " --scheme.method=radau-iia --scheme.stages=2", " --lattice.time_steps=0.03,0.05"}) {
    CAPTURE(method);
    const bool varies = std::string(method).find("time_steps") != std::string::npos;
    const Ran run = delf_program(folder, "run s.ini --out out" + std::string(method));
    CAPTURE(run.out, run.err);
    REQUIRE(run.code == 0);
    CHECK(summary(folder)["error_linf"] < 0.004);
    CHECK(summary(folder)["warnings"].empty());
    if (varies) continue;
    const Ran orders = delf_program(
        folder, "convergence s.ini --convergence.levels=4 --convergence.order=2 --out c" + std::string(method));
    CAPTURE(orders.out);
    CHECK(orders.code == 0);
  }
  // waves that cross a rectangle, driven on three sides
  folder.write(
      "plane.ini",
      "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = quadrilaterals:2,1,16,8\ncourant = 0.4\n"
      "[boundary]\nleft = sin(0.6*x + 0.8*y - t)\nbottom = sin(0.6*x + 0.8*y - t)\ntop = sin(0.6*x + 0.8*y - t)\n"
      "right.flux = 0.6*cos(0.6*x + 0.8*y - t)\n[exact]\nphi = sin(0.6*x + 0.8*y - t)\n[run]\nuntil = 2\n");
  const Ran plane = delf_program(folder, "convergence plane.ini --convergence.levels=3 --convergence.order=2 --out c");
  CAPTURE(plane.out, plane.err);
  CHECK(plane.code == 0);
}

TEST_CASE("the energy less the work of a boundary is kept to the order of the method") {
  const Folder folder;
  folder.write("s.ini", at_rest);
  const auto error = [&](const std::string& keys, double h) {
    const Ran ran = delf_program(folder,
                                 "run s.ini --output.every=1 --lattice.mesh=quadrilaterals:6,0.4,15,2 --run.until=6 "
                                 "--lattice.time_step=" +
                                     std::to_string(h) + " --out out " + keys);
    CAPTURE(keys, ran.out, ran.err);
    REQUIRE(ran.code == 0);
    const auto json = summary(folder);
    CHECK(json["energy_final"] > 0.02);
    CHECK(contains(read(folder / "out/series.csv"), ",energy_less_work\n"));
    return json["energy_error_max"].get<double>();
  };
  const std::string driven = "--boundary.left='1.2*sin(0.9*t)^3' ", pushed = "--boundary.left.flux='0.8*sin(0.9*t)^3' ";
  for (const std::string& how : {driven, pushed, driven + "--boundary.right.flux='0.5*sin(t)^4' "})
    for (const auto& [method, order] : {std::pair{"", 2},
                                        {"--scheme.method=composition", 4},
                                        {"--scheme.method=cgvi --scheme.tableau=stormer-verlet", 2},
                                        {"--scheme.method=cgvi --scheme.tableau=gauss2", 4},
                                        {"--scheme.method=radau-iia --scheme.stages=2", 3}}) {
      CAPTURE(how, method);
      const double coarse = error(how + method, 0.2), fine = error(how + method, 0.1);
      CHECK(std::log2(coarse / fine) > order - 0.3);
      CHECK(std::log2(coarse / fine) < order + 0.6);
    }
}

TEST_CASE("a rectangle that is driven, or pushed, alike all along its side is the lattice of its columns") {
  const Folder folder;
  folder.write("mesh.ini", at_rest);
  folder.write(
      "lattice.ini",
      "[theory]\nname = sine-gordon\n[lattice]\nspace = interval\nlength = 10\nsites = 51\nstencil = "
      "triangle-vertex\ncourant = 0.3\n[boundary]\nright = natural\n[initial]\nphi = 0\nstart = centred\n[run]\n"
      "until = 12\n[output]\nfigures = off\n");
  for (const char* how : {"--boundary.left='1.2*sin(0.9*t)'", "--boundary.left.flux='0.8*sin(0.9*t)'"}) {
    CAPTURE(how);
    REQUIRE(delf_program(folder, std::string("run mesh.ini --out mesh ") + how).code == 0);
    const Ran lattice = delf_program(folder, std::string("run lattice.ini --out lattice ") + how);
    CAPTURE(lattice.err);
    REQUIRE(lattice.code == 0);
    const std::vector<double> row = last_row(folder, "lattice"), rows = last_row(folder, "mesh");
    double most = 0;
    for (std::size_t p = 0; p < rows.size(); ++p) most = std::max(most, std::abs(rows[p] - row[p % 51]));
    CHECK(most < 1e-12);
    CHECK(*std::ranges::max_element(row) > 0.2);
  }
}

TEST_CASE("a driven run goes on from its middle to the bit, is verified, and planted faults are found") {
  const Folder folder;
  folder.write("s.ini", at_rest);
  const std::string keys = " --boundary.left='1.2*sin(0.9*t)' --boundary.right.flux='0.2*t*y' --output.every=10 ";
  for (const char* method : {"", "--scheme.method=composition"}) {
    CAPTURE(method);
    REQUIRE(delf_program(folder, "run s.ini --out whole --run.until=6" + keys + method).code == 0);
    REQUIRE(delf_program(folder, "run s.ini --out half --run.until=3" + keys + method).code == 0);
    REQUIRE(delf_program(folder, "resume half --run.until=6").code == 0);
    CHECK(read(folder / "whole/series.csv") == read(folder / "half/series.csv"));
    REQUIRE(delf_program(folder, "run whole/scene.ini --out again").code == 0);
    CHECK(read(folder / "whole/series.csv") == read(folder / "again/series.csv"));
    const Ran verified = delf_program(folder, "verify s.ini --out v --run.until=2" + keys + method);
    CAPTURE(verified.out, verified.err);
    CHECK(verified.code == 0);
    CHECK(contains(verified.out, "time reversal, distance"));
    CHECK(delf_program(folder, "verify s.ini --out v --run.until=2 --verify.fault=field" + keys + method).code == 1);
  }
  const std::string plan = delf_program(folder, "plan s.ini" + keys).out;
  CHECK(contains(plan, "6 points are driven\n"));
  CHECK(contains(plan, "something flows in at 6 points\n"));
  const Ran limits = delf_program(folder, "stability s.ini --lattice.mesh=quadrilaterals:3,1,6,2 --out l" + keys);
  CAPTURE(limits.out);
  CHECK(limits.code == 0);
  CHECK(
      contains(delf_program(folder, "run s.ini --theory.name=wave --out out" + keys).out, "the ends give or take it"));
}

TEST_CASE("values and slopes on the parts of an elliptic problem's boundary are those of its formulas") {
  const Folder folder;
  folder.write("s.ini", static_wave);
  // x² − y² is its own bilinear interpolant's solution at the points of a uniform mesh
  REQUIRE(delf_program(folder, "run s.ini --out out").code == 0);
  const std::vector<double> row = last_row(folder, "out");
  double most = 0;
  for (std::size_t p = 0; p < row.size(); ++p) {
    const double x = 2.0 * static_cast<double>(p % 17) / 16, y = static_cast<double>(p / 17) / 8;
    most = std::max(most, std::abs(row[p] - (x * x - y * y)));
  }
  CHECK(most < 1e-12);
  CHECK(delf_program(folder, "verify s.ini --out v").code == 0);
  const Ran orders = delf_program(folder,
                                  "convergence s.ini --lattice.mesh=rectangle:2,1,8,4 --boundary.left='exp(x)*sin(y)' "
                                  "--boundary.bottom='exp(x)*sin(y)' --boundary.right.flux='exp(x)*sin(y)' "
                                  "--boundary.top.flux='exp(x)*cos(y)' --exact.phi='exp(x)*sin(y)' "
                                  "--convergence.levels=3 --convergence.order=2 --out c");
  CAPTURE(orders.out, orders.err);
  CHECK(orders.code == 0);
}

TEST_CASE("a torus of cells is the lattice of its columns, and its seam is drawn") {
  const Folder folder;
  const std::string run = "[run]\nsteps = 40\n[output]\nfigures = off\n";
  folder.write(
      "torus.ini",
      "[theory]\nname = sine-gordon\n[lattice]\nspace = complex\nmesh = quadrilaterals:6,1,24,4\ncourant = 0.4\n"
      "[boundary]\nleft = periodic:right\nbottom = periodic:top\n[initial]\nphi = 2*cos(pi*x/3)\n"
      "phi_t = sin(pi*x/3)\n" +
          run);
  folder.write(
      "circle.ini",
      "[theory]\nname = sine-gordon\n[lattice]\nspace = circle\nlength = 6\nsites = 24\nstencil = triangle-vertex\n"
      "courant = 0.4\n[initial]\nphi = 2*cos(pi*x/3)\nphi_t = sin(pi*x/3)\nstart = centred\n" +
          run);
  REQUIRE(delf_program(folder, "run torus.ini --out torus").code == 0);
  REQUIRE(delf_program(folder, "run circle.ini --out circle").code == 0);
  const std::vector<double> rows = last_row(folder, "torus"), row = last_row(folder, "circle");
  REQUIRE(rows.size() == 24 * 4);
  double most = 0;
  for (std::size_t p = 0; p < rows.size(); ++p) most = std::max(most, std::abs(rows[p] - row[p % 24]));
  CHECK(most < 1e-12);
  CHECK(contains(delf_program(folder, "plan torus.ini").out, "Euler characteristic 0, no boundary curves"));
  CHECK(delf_program(folder, "verify torus.ini --out v").code == 0);
  CHECK(delf_program(folder, "run torus/scene.ini --out again").code == 0);
  CHECK(read(folder / "torus/series.csv") == read(folder / "again/series.csv"));
  // 24 × 4 points and the copies at the right and at the top
  const std::string xdmf = read(folder / "torus/fields.xdmf");
  CHECK(contains(xdmf, "Dimensions=\"125 2\""));
  CHECK(contains(xdmf, "\n6 1\n"));
  CHECK(contains(xdmf, "5 22 23 "));
  const Ran frames =
      shell(folder, "h5dump -d /phi/1 -y torus/frames.h5 | tr -s ' \\n,' '\\n' | grep -cE '^-?[0-9.e-]+$'");
  if (frames.code == 0) CHECK(frames.out.starts_with("125"));
  // both keys may say so; the pair of one part alone makes a tube
  CHECK(contains(delf_program(folder, "plan torus.ini --boundary.right=periodic:left").out, "Euler characteristic 0"));
  CHECK(contains(delf_program(folder, "plan torus.ini --boundary.bottom=natural").out, "2 boundary curves"));
}

TEST_CASE("waves go round a torus of triangles with order 2, and an interval that is joined is a circle") {
  const Folder folder;
  folder.write(
      "torus.ini",
      "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = rectangle:2,1,16,8\ncourant = 0.4\n[boundary]\n"
      "left = periodic:right\nbottom = periodic:top\n[exact]\nphi = sin(pi*(x + 2*y - sqrt(5)*t))\n"
      "[run]\nuntil = 1\n[output]\nfigures = off\n");
  for (const char* mesh : {"rectangle:2,1,16,8", "quadrilaterals:2,1,16,8"}) {
    const Ran orders =
        delf_program(folder, std::string("convergence torus.ini --convergence.levels=3 --convergence.order=2 "
                                         "--out c --lattice.mesh=") +
                                 mesh);
    CAPTURE(orders.out, orders.err);
    CHECK(orders.code == 0);
  }
  const Ran circle = delf_program(folder,
                                  "convergence torus.ini --lattice.mesh=graded:2,33,1.02 --boundary.bottom=x "
                                  "--exact.phi='sin(pi*(x - t))' --convergence.levels=3 --out c");
  CHECK(circle.code == 2);  // an interval has no bottom
  folder.write("circle.ini",
               "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = graded:2,33,1.02\ncourant = 0.4\n[boundary]\n"
               "left = periodic:right\n[exact]\nphi = sin(pi*(x - t))\n[run]\nuntil = 1\n");
  const Ran around =
      delf_program(folder, "convergence circle.ini --convergence.levels=3 --convergence.order=2 --out c");
  CAPTURE(around.out, around.err);
  CHECK(around.code == 0);
}

TEST_CASE("conditions that a mesh's boundary cannot have are refused in one line") {
  const Folder folder;
  folder.write("rows.ini", at_rest);
  folder.write("still.ini", static_wave);
  const auto refused = [&](const std::string& line, const std::vector<std::string>& parts) {
    CAPTURE(line);
    check_refused(delf_program(folder, "run " + line + " --out none"), parts);
  };
  refused("rows.ini --boundary.left=held",
          {"--boundary.left = held: a part of a mesh is fixed, natural, periodic:PART, or "
           "moves by a formula of t, x, y and z"});
  refused("rows.ini --boundary.left='sin('", {"boundary.left"});
  refused("rows.ini --boundary.left='q*t'", {"boundary.left", "q"});
  refused("rows.ini --boundary.left='sin(t); cos(t)'", {"gives 2 formulas, and the fields are phi; give one for each"});
  refused("rows.ini --boundary.left=fixed --boundary.left.flux=t",
          {"is for a natural part, and boundary.left keeps the value"});
  refused("rows.ini --boundary.middle.flux=t", {"the mesh has no part of this name"});
  refused("rows.ini --boundary.mesh.flux=t", {"boundary.mesh is fixed or natural, and no part", "boundary.NAME.flux"});
  refused("rows.ini --run.until=1e-9", {"run.until", "is less than half a step"});
  refused("rows.ini --boundary.left='sin(t)' --boundary.part.left=fixed", {"is the part that boundary.left names too"});
  refused("rows.ini --boundary.left.flux=t --boundary.part.left.flux=t",
          {"is the part that boundary.left.flux names too"});
  refused("rows.ini --boundary.left='sin(t)' --lattice.time=cells",
          {"cells with steps of their own have boundaries that are fixed or natural"});
  refused("rows.ini --boundary.left.flux='sin(t)' --theory.fibre=S1",
          {"theory.fibre = S1 angles; use theory.fibre = R"});
  refused("still.ini --boundary.left='sin(t)'", {"reads t, and with lattice.time = none there is none"});
  refused("still.ini --boundary.right.flux='sin(t)'", {"reads t, and with lattice.time = none there is none"});
  refused("rows.ini --boundary.winding=fixed",
          {"is a key of lattices; a part of a mesh that has this name is boundary.part.winding"});
  refused("rows.ini --boundary.left=periodic:top", {"point 0 of left, at (0, 0), has no partner on top"});
  refused("rows.ini --boundary.left=periodic:right --boundary.right=fixed",
          {"both parts are one, and have no other condition; leave boundary.right out"});
  refused("rows.ini --boundary.left=periodic:right --boundary.right.flux=t", {"leave their flux out"});
  refused("rows.ini --boundary.left=periodic:right --initial.phi=x",
          {"initial.phi = x: jumps where the mesh is joined, from 0 at (0, 0, 0) to 10 at (10, 0, 0)"});
  refused("rows.ini --boundary.left=periodic:right --theory.name=sine-gordon-impurity",
          {"theory.density", "reads x, which jumps where the mesh is joined"});
  refused("rows.ini --boundary.left=periodic:right --lattice.mesh=quadrilaterals:10,1,2,5",
          {"take three cells at least from one part to the other"});
  for (const char* formula : {"-t", "mass", "pi"})  // names of numbers, and signs, are formulas
    CHECK(delf_program(folder, std::string("plan rows.ini --theory.mass=0.5 --boundary.left=") + formula).code == 0);
  const Ran breaks = delf_program(folder, "run rows.ini --out out --boundary.left='sin(t)*sqrt(3 - t)'");
  CHECK(breaks.code == 2);
  CHECK(contains(breaks.err, "boundary.left = sin(t)*sqrt(3 - t): has no finite value or rate at t = 3.06, (0, 0, 0)"));
  const Ran off = delf_program(folder, "run rows.ini --out out --boundary.left='1 + sin(t)'");
  CHECK(off.code == 0);
  CHECK(contains(off.err, "differs by 1 from what point 0 is driven to at t = 0; the driven value counts"));
}

TEST_CASE("parts with the names of other keys, or with a space in it, are named by boundary.part") {
  const Folder folder;
  folder.write("named.txt",
               "point 0 0\npoint 1 0\npoint 2 0\npoint 2 1\npoint 1 1\npoint 0 1\ncell 0 1 4 5\ncell 1 2 3 4\n"
               "side winding 5 0\nside mesh 2 3\nside part 0 1\nside a.flux 1 2\n");
  folder.write("s.ini",
               "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = named.txt\ntime_step = 0.1\n[boundary]\n"
               "mesh = natural\npart.winding = fixed\n[initial]\nphi = x\n[run]\nsteps = 3\n[output]\nfigures = off\n");
  CHECK(contains(delf_program(folder, "plan s.ini").out, "2 fixed, 4 natural"));
  CHECK(contains(delf_program(folder, "plan s.ini --boundary.part.mesh=fixed").out, "4 fixed, 2 natural"));
  CHECK(contains(delf_program(folder, "plan s.ini --boundary.part=fixed").out, "3 fixed, 3 natural"));
  CHECK(contains(delf_program(folder, "plan s.ini --boundary.a.flux=fixed").out, "4 fixed, 2 natural"));
  CHECK(delf_program(folder, "run s.ini --out out").code == 0);
  CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(read(folder / "out/series.csv") == read(folder / "again/series.csv"));
}

TEST_CASE("several constraints are kept on a mesh, by rows and at rest, each with its multiplier") {
  const Folder folder;
  // u² + v² = 1 in the plane w = 0 is the circle that u² + v² = 1 alone keeps
  const std::string space =
                        "[lattice]\nspace = complex\nmesh = quadrilaterals:3,1,12,4\ncourant = 0.4\n[boundary]\nmesh = "
                        "natural\nleft = fixed\n",
                    start =
                        "[initial]\nu = cos(0.3*x*x)\nv = sin(0.3*x*x)\nu_t = -x*sin(0.3*x*x)\nv_t = x*cos(0.3*x*x)\n",
                    run = "[run]\nsteps = 30\n[output]\nfigures = off\nevery = 5\n";
  folder.write("one.ini",
               "[theory]\nname = text\nfields = u, v\ndensity = 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2)\n"
               "constraint = u^2 + v^2 - 1\n" +
                   space + start + run);
  folder.write(
      "two.ini",
      "[theory]\nname = text\nfields = u, v, w\ndensity = 0.5*(u_t^2 + v_t^2 + w_t^2 - u_x^2 - v_x^2 - w_x^2)\n"
      "constraint = u^2 + v^2 + w^2 - 1; w\n" +
          space + start + "w = 0\n" + run);
  REQUIRE(delf_program(folder, "run one.ini --out one").code == 0);
  const Ran two = delf_program(folder, "run two.ini --out out");
  CAPTURE(two.out, two.err);
  REQUIRE(two.code == 0);
  CHECK(summary(folder)["constraint_max"] < 1e-12);
  const std::vector<double> of_one = last_row(folder, "one"), of_two = last_row(folder, "out");
  double most = 0;
  for (std::size_t p = 0; p < of_one.size() / 2; ++p)
    for (std::size_t a = 0; a < 2; ++a) most = std::max(most, std::abs(of_one[2 * p + a] - of_two[3 * p + a]));
  CHECK(most < 1e-11);
  const FieldsReader fields(folder / "out/fields.h5"), before(folder / "one/fields.h5");
  REQUIRE(fields.shape(Role::multiplier).components == 2);
  const std::vector<double> lambda = fields.values(Role::multiplier, 3), single = before.values(Role::multiplier, 3);
  for (std::size_t p = 0; p < single.size(); ++p) CHECK(lambda[2 * p] == Approx(single[p]).margin(1e-8));
  REQUIRE(delf_program(folder, "run two.ini --output.every=1 --out all").code == 0);
  for (const char* rows : {"", " --fields all/fields.h5"}) {
    const Ran verified = delf_program(folder, "verify two.ini --output.every=1 --out v" + std::string(rows));
    CAPTURE(verified.out, verified.err);
    CHECK(verified.code == 0);
  }
  CHECK(delf_program(folder, "verify two.ini --verify.fault=field --out v").code == 1);
  // at rest: the harmonic map of the circle, whose angle is harmonic
  folder.write(
      "rest.ini",
      "[theory]\nname = text\nfields = u, v, w\ndensity = 0.5*(u_t^2 + v_t^2 + w_t^2 - u_x^2 - v_x^2 - w_x^2)\n"
      "constraint = u^2 + v^2 + w^2 - 1; w\n[lattice]\nspace = complex\nmesh = quadrilaterals:3,1,12,4\n"
      "time = none\n[boundary]\nmesh = natural\nleft = 1; 0; 0\nright = cos(1.5); sin(1.5); 0\n"
      "[initial]\nu = cos(0.3*x)\nv = sin(0.3*x)\nw = 0\n[output]\nfigures = off\n");
  const Ran rest = delf_program(folder, "run rest.ini --out out");
  CAPTURE(rest.out, rest.err);
  REQUIRE(rest.code == 0);
  const std::vector<double> map = last_row(folder, "out");
  for (std::size_t p = 0; p < map.size() / 3; ++p)
    CHECK(std::atan2(map[3 * p + 1], map[3 * p]) == Approx(0.5 * 3.0 * static_cast<double>(p % 13) / 12).margin(1e-9));
}

TEST_CASE("formulas that break a constraint at the start are refused by their key, and later ones are warned of") {
  const Folder folder;
  const std::string theory =
      "[theory]\nname = text\nfields = u, v\ndensity = 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2)\n"
      "constraint = u^2 + v^2 - 1\n";
  const std::string end =
      "[boundary]\nright = natural\n[exact]\nu = cos(x - t)\nv = sin(x - t)\n"
      "[run]\nuntil = 0.5\n[output]\nfigures = off\n";
  folder.write("mesh.ini",
               theory + "[lattice]\nspace = complex\nmesh = quadrilaterals:2,1,8,4\ntime_step = 0.03\n" + end);
  folder.write(
      "line.ini",
      theory + "[lattice]\nspace = interval\nlength = 2\nsites = 21\ncourant = 0.5\nstencil = rectangle\n" + end);
  for (const std::string scene : {"mesh.ini", "line.ini"}) {
    CAPTURE(scene);
    const std::string run = "run " + scene + " --out out --boundary.left=";
    const std::string mesh = scene == "mesh.ini" ? " --boundary.mesh=natural" : "";
    REQUIRE(delf_program(folder, run + "'cos(t); -sin(t)'" + mesh).code == 0);
    CHECK_FALSE(contains(summary(folder)["warnings"].dump(), "off the constraint"));
    const Ran leaves = delf_program(folder, run + "'cos(t) + 0.2*t; -sin(t)'" + mesh);
    CAPTURE(leaves.out, leaves.err);
    CHECK(leaves.code == 0);
    CHECK(contains(summary(folder)["warnings"].dump(), "the boundary moves off the constraint"));
    check_refused(delf_program(folder, run + "'1.2*cos(t); -sin(t)'" + mesh),
                  {"boundary.left", "breaks the constraint", "give formulas that keep it"});
  }
  // a lattice with a constraint starts from a solution alone, and each rule says so
  folder.write("start.ini",
               theory +
                   "[lattice]\nspace = interval\nlength = 2\nsites = 21\ncourant = 0.5\nstencil = rectangle\n"
                   "[initial]\nu = 1\nv = 0\n[run]\nuntil = 0.5\n");
  for (const char* rule : {"", " --initial.start=exact"})
    check_refused(delf_program(folder, "run start.ini --out none" + std::string(rule)),
                  {"initial.start", "give a solution as exact.FIELD"});
}

TEST_CASE("asynchronous cells on the node of a standing wave, where all terms are rounding, verify") {
  const Folder folder;
  folder.write("node.ini",
               "[theory]\nname = text\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2\n"
               "[lattice]\nspace = complex\nmesh = rectangle:2,1,16,8\ncourant = 0.3\ntime = cells\n"
               "[boundary]\nmesh = natural\n[exact]\nphi = cos(pi*x)*cos(2*pi*y)*cos(pi*sqrt(5)*t)\n"
               "[run]\nuntil = 0.5\n[output]\nfigures = off\n");
  const Ran verified = delf_program(folder, "verify node.ini --out v");
  CAPTURE(verified.out, verified.err);
  CHECK(verified.code == 0);
  for (const char* fault : {"field", "sign"})
    CHECK(delf_program(folder, "verify node.ini --out v --verify.fault=" + std::string(fault)).code == 1);
}

TEST_CASE("limits on a mesh are found of a density that the scene gives as text") {
  const Folder folder;
  folder.write("text.ini",
               "[theory]\nname = text\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2\n"
               "[lattice]\nspace = complex\nmesh = quadrilaterals:3,1,6,2\ncourant = 0.3\n"
               "[initial]\nphi = 0\n[run]\nuntil = 1\n[output]\nfigures = off\n");
  const Ran limits = delf_program(folder, "stability text.ini --out l");
  CAPTURE(limits.out, limits.err);
  CHECK(limits.code == 0);
}
