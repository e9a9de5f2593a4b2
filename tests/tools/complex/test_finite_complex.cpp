// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>

#include "tests/catch.hpp"
#include "tests/schemes/complex/stencil_lists.hpp"
#include "tests/tools/program.hpp"
#include "tools/complex/stencil_text.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

nlohmann::json summary(const Folder& folder) { return nlohmann::json::parse(read(folder / "out/summary.json")); }

/// As a file has them.
std::string bent_cells(int sites, int rows, const std::string& fault = "") {
  StencilList list = bent_rows(sites, rows);
  const std::size_t middle = 2 * sites + 3;
  if (fault == "flipped") std::swap(list.stencils[3].sites[1], list.stencils[3].sites[3]);
  if (fault == "doubled") list.stencils.push_back(list.stencils[4]);
  if (fault == "moved") list.sites[middle].position[1] += 0.01;
  if (fault == "too much") list.sites[middle].role = SiteRole::initial;
  if (fault == "too little") list.sites[middle].role = SiteRole::final;
  return stencil_text(list);
}

}  // namespace

TEST_CASE("a finite complex of mixed shapes runs, is planned and verified, and its faults are named") {
  const Folder folder;
  folder.write("coarse.mesh", bent_cells(17, 11)), folder.write("fine.mesh", bent_cells(33, 21));
  folder.write("kink.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nspace = complex\nmesh = coarse.mesh\n"
               "[exact]\nphi = 4*atan(exp((x - 1.5 - 0.3*t)/sqrt(0.91)))\n[output]\nfigures = off\n");
  const auto error = [&](const std::string& mesh) {
    const Ran ran = delf_program(folder, "run kink.ini --out out --lattice.mesh=" + mesh);
    CAPTURE(ran.out, ran.err);
    REQUIRE(ran.code == 0);
    CHECK(summary(folder)["residual_max"] < 1e-13);
    CHECK(summary(folder)["energy_final"].is_null());
    return summary(folder)["error_l2"].get<double>();
  };
  const double fine = error("fine.mesh"), coarse = error("coarse.mesh");
  CHECK(std::log2(coarse / fine) == Approx(2).margin(0.2));
  CHECK(contains(delf_program(folder, "plan kink.ini").out, "39 levels, 135 unknowns in 65 blocks, the largest of 15"));
  CHECK(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
  CHECK(delf_program(folder, "verify kink.ini --out v").code == 0);
  CHECK(delf_program(folder, "verify kink.ini --fields out/fields.h5 --out v").code == 0);
  // Noether's theorem for turns of two fields, and for what is no turn
  folder.write("two.ini",
               "[theory]\nfields = u, v\ndensity = 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2) - 0.25*(u^2 + v^2 - 1)^2\n"
               "[lattice]\nspace = complex\nmesh = coarse.mesh\n[initial]\nu = 1 + 0.1*x + 0.2*t\nv = 0.3*x - t\n");
  const Ran turned = delf_program(folder, "verify two.ini --verify.generator=-v,u --out v");
  CAPTURE(turned.out, turned.err);
  CHECK(turned.code == 0);
  CHECK(contains(turned.out, "Noether, generator"));
  CHECK(delf_program(folder, "verify two.ini --verify.generator=-v,2*u --out v").code == 1);
  for (const char* fault : {"field", "variation", "sign"})
    CHECK(delf_program(folder, std::string("verify kink.ini --out v --verify.fault=") + fault).code == 1);

  for (const auto& [fault, command, part] :
       {std::tuple("flipped", "run", "bad.mesh:192: stencil 3 (rectangle) is listed the wrong way round"),
        std::tuple("doubled", "run", "is stencil 4 again (line 193)"),
        std::tuple("moved", "verify --fields out/fields.h5", "site 37 lies at x = "),
        std::tuple("too much", "plan", "more equations than unknowns at site"),
        std::tuple("too little", "plan", "no equation is left for the values of site")}) {
    folder.write("bad.mesh", bent_cells(17, 11, fault));
    const Ran ran = delf_program(folder, std::string(command) + " kink.ini --lattice.mesh=bad.mesh");
    CAPTURE(fault, ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, part));
  }
  folder.write("bad.mesh", "complex\nsite 0 0\nsite 1 2 begin\n");
  CHECK(contains(delf_program(folder, "run kink.ini --lattice.mesh=bad.mesh").err, "bad.mesh:3: \"begin\" is neither"));
  folder.write("bad.mesh", "complex\nstencil triangel 0 1 2\n");
  CHECK(contains(delf_program(folder, "run kink.ini --lattice.mesh=bad.mesh").err, "bad.mesh:2: \"triangel\" is no"));
  CHECK(contains(delf_program(folder, "run kink.ini --run.until=3").err, "where sites have times of their own"));
}

TEST_CASE(
    "a kink in a locally refined piece of spacetime converges with order 2, and has figures and cells for ParaView") {
  const Folder folder;
  const Ran run = delf_program(folder, "run refined-kink --output.format=svg --out out");
  CAPTURE(run.out, run.err);
  REQUIRE(run.code == 0);
  CHECK(summary(folder)["warnings"].empty());
  CHECK(summary(folder)["residual_max"] < 1e-13);
  CHECK(summary(folder)["energy_final"].is_null());  // columns of sites have steps of their own
  CHECK(std::filesystem::exists(folder / "out/figures/field.svg") ==
        std::filesystem::exists(folder / "out/figures/levels.svg"));
  CHECK(delf_program(folder, "verify refined-kink --out v").code == 0);

  // rectangles, and three triangles beside each at the edges of the middle third
  const std::string xdmf = read(folder / "out/fields.xdmf");
  CHECK(contains(xdmf, "TopologyType=\"Mixed\" NumberOfElements=\"3040\"><DataItem Dimensions=\"14960\""));
  CHECK(contains(xdmf, "GeometryType=\"XY\"><DataItem Dimensions=\"3009 2\""));
  int triangles = 0, rectangles = 0;
  for (const std::string& line : lines(xdmf)) triangles += line.starts_with("4 "), rectangles += line.starts_with("5 ");
  CHECK(triangles == 240);
  CHECK(rectangles == 2800);
  CHECK(4 * triangles + 5 * rectangles == 14960);

  const std::string levels =
      "convergence refined-kink --lattice.mesh=refined:18,5,36,20 --out c --convergence.levels=3 ";
  const Ran right = delf_program(folder, levels + "--convergence.order=2");
  CAPTURE(right.out);
  CHECK(right.code == 0);
  CHECK(contains(right.out, "those of all sites"));
  CHECK(delf_program(folder, levels + "--convergence.order=1.5").code == 1);
  CHECK(delf_program(folder, levels + "--convergence.order=2.5").code == 1);
}

TEST_CASE(
    "a beam on a complex of unequal six-tuples runs and is verified, faults are found, and other shapes refused") {
  const Folder folder;
  const double turn = 2 * std::acos(-1.0);
  StencilList list = beam_rows(16, 5, turn, 0.05, [&](int i) { return turn * i / 16 + 0.2 * std::sin(turn * i / 16); });
  folder.write("beam.mesh", stencil_text(list));
  list.stencils[3] = {"triangle", {2, 18, 3}};
  folder.write("other.mesh", stencil_text(list));
  folder.write("beam.ini",
               "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_xx^2 + 0.1*cos(phi)\n[lattice]\nspace = complex\n"
               "mesh = beam.mesh\n[initial]\nphi = cos(x - t)\n[output]\nfigures = off\n");
  const Ran ran = delf_program(folder, "run beam.ini --out out");
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  CHECK(summary(folder)["residual_max"].get<double>() < 1e-12);
  const Ran right = delf_program(folder, "verify beam.ini --out v");
  CAPTURE(right.out);
  CHECK(right.code == 0);
  for (const char* fault : {"field", "variation", "sign"})
    CHECK(delf_program(folder, std::string("verify beam.ini --out v --verify.fault=") + fault).code == 1);
  for (const char* command : {"run --out no", "plan", "verify --out no"}) {
    const Ran refused = delf_program(folder, std::string(command) + " beam.ini --lattice.mesh=other.mesh");
    CAPTURE(command, refused.err);
    CHECK(refused.code == 2);
    CHECK(lines(refused.err).size() == 1);
    CHECK(
        contains(refused.err, "line 86: stencil 3 (triangle) has no phi_xx, which the density reads; use a six-tuple"));
  }
}

TEST_CASE("threads share wide levels of a finite complex, and the plan says which") {
  const Folder folder;
  // rows of leapfrog on a circle, and of (5.10), where a row is one block
  const auto rows = [](const std::string& shape) {
    constexpr int sites = 2100, count = 4;
    StencilList list;
    list.circumference = 210;
    for (int j = 0; j < count; ++j)
      for (int i = 0; i < sites; ++i)
        list.sites.push_back({{0.04 * j, 0.1 * i, 0, 0},
                              j == 0           ? SiteRole::given
                              : j == 1         ? SiteRole::initial
                              : j == count - 1 ? SiteRole::final
                                               : SiteRole::free});
    for (int s = 0; s < sites * (count - 1); ++s) {
      const int next = s % sites == sites - 1 ? s + 1 - sites : s + 1;
      if (shape == "rectangle") list.stencils.push_back({shape, {s, s + sites, next + sites, next}});
      else list.stencils.push_back({shape, {s, s + sites, next + sites}});
    }
    return stencil_text(list);
  };
  folder.write("explicit.mesh", rows("triangle-vertex")), folder.write("implicit.mesh", rows("rectangle"));
  folder.write("pulse.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nspace = complex\nmesh = explicit.mesh\n"
               "[initial]\nphi = 3*exp(-(x - 30)^2)\n[output]\nfigures = off\nfields = off\n");
  const Ran plan = delf_program(folder, "plan pulse.ini --run.threads=2");
  CHECK(contains(plan.out, "2 levels, 4200 unknowns, each in a block of its own"));
  CHECK(contains(plan.out, "levels     2100 blocks a level, 2100 in the widest"));
  CHECK(contains(plan.out, "threads    2\n"));
  CHECK_FALSE(contains(delf_program(folder, "plan pulse.ini").out, "threads"));
  CHECK(contains(delf_program(folder, "plan pulse.ini --lattice.mesh=implicit.mesh --run.threads=2").out,
                 "threads    1 of 2: a level is shared by parts of 1024 unknowns or more"));
  const auto series = [&](const std::string& more) {
    REQUIRE(delf_program(folder, "run pulse.ini --out out " + more).code == 0);
    return read(folder / "out/series.csv");
  };
  const std::string one = series("--run.threads=1");
  CHECK(series("--run.threads=3") == one);
  CHECK(series("--initial.phi='3*exp(-(x - 30.01)^2)'") != one);
  CHECK(delf_program(folder, "run sphere --run.threads=2").code == 2);
  // the pulse moves apart: one slab of energy after each row but the first
  CHECK(lines(one).size() == 4);
  CHECK(summary(folder)["energy_error_max"].get<double>() < 1e-3);
  CHECK(contains(delf_program(folder, "convergence pulse.ini --out c").err, "is a finite complex of a file"));
  CHECK(contains(delf_program(folder, "convergence pulse.ini --lattice.mesh=refined:60,1,36,20 --out c").err,
                 "compared with a solution alone"));
  CHECK(contains(delf_program(folder, "plan pulse.ini --lattice.mesh=refined:60,1,35,20").err, "multiple of 3"));
}

TEST_CASE("stencils of a file that do not tile are refused or warned of, by line, and plan tells their area") {
  const Folder folder;
  std::string list = "complex\ncircle 4\n";
  for (const auto& [t, role] : {std::pair("0", "given"), {"1", "initial"}, {"2", "final"}})
    for (const char* x : {"0", "1", "2", "3"}) list += std::string("site ") + t + " " + x + " " + role + "\n";
  list +=
      "stencil rectangle 0 4 5 1\nstencil rectangle 1 5 6 2\nstencil rectangle 2 6 7 3\nstencil rectangle 3 7 4 0\n"
      "stencil rectangle 4 8 9 5\nstencil rectangle 5 9 10 6\nstencil rectangle 6 10 11 7\n";
  const std::string last = "stencil rectangle 7 11 8 4";
  folder.write("s.ini",
               "[theory]\nname = wave\n[lattice]\nspace = complex\nmesh = cx.txt\n[exact]\n"
               "phi = cos(pi*x/2)*cos(pi*t/2)\n[output]\nfigures = off\n");
  const auto run = [&](const std::string& end, const std::string& command = "run") {
    folder.write("cx.txt", list + end);
    return delf_program(folder, command + " s.ini" + (command == "run" ? " --out out" : ""));
  };
  const Ran right = run(last + "\n");
  CHECK(right.code == 0);
  CHECK(summary(folder)["warnings"].empty());
  CHECK(contains(run(last + "\n", "plan").out, "  cells      Euler characteristic 0, 2 boundary curves, area 8\n"));
  for (const auto& [end, words] : {std::pair(last + " share 7\n", "cx.txt:22: the stencils around site"),
                                   {last + "\nstencil triangle 0 4 5\n", "cx.txt:23: the stencils around site"}}) {
    const Ran wrong = run(end);
    CAPTURE(wrong.err);
    CHECK(wrong.code == 2);
    CHECK(lines(wrong.err).size() == 1);
    CHECK(contains(wrong.err, words));
    CHECK(run(end, "plan").code == 2);
  }
  const Ran gap = run("");
  CHECK(gap.code == 0);
  CHECK(summary(folder)["warnings"].size() == 2);
  CHECK(contains(gap.out, "stencils cover 0.75 of the surroundings of site 7 (t = 1, x = 3)"));
  CHECK(contains(run("", "plan").out, "stencils cover 0.75 of the surroundings of site 7 (t = 1, x = 3)"));
  // the same place of the circle, twice
  folder.write("cx.txt", "complex\ncircle 4\nsite 0 0\nsite 0 4\nsite 1 0\nstencil triangle 0 2 1\n");
  CHECK(contains(delf_program(folder, "run s.ini --out out").err,
                 "cx.txt:4: site 1 lies where site 0 does on the circle"));
}
